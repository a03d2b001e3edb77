//! The intermediate images that can be looked at.

/// An intermediate image of the last frame, for [`Denoiser::show`](crate::Denoiser::show).
///
/// In an `rgba32float` or `rgba16float` target each shows its numbers, as listed, with alpha 1; in an `rgba8unorm` one a
/// picture (sRGB-encoded).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum View {
    /// The filtered image: linear radiance. Picture: tone-mapped.
    Denoised = 0,
    /// The samples as traced: linear radiance. Picture: tone-mapped.
    Noisy = 1,
    /// What radiance was divided by before filtering, 10⁻³…1; 0 (a host's: 1) where nothing was hit.
    Albedo = 2,
    /// World-space normal, −1…1; 0 where nothing was hit.
    Normal = 3,
    /// Linear depth; 0 where nothing was hit. Picture: brighter is farther, grey at [`ViewOptions::range`].
    Depth = 4,
    /// Number of the triangle: low 16 bits in red, high 16 in green; blue is 0 where nothing was hit. Picture: one colour each.
    TriangleId = 5,
    /// Previous − current position in pixels in red and green, in steps of 1/256 (−10⁶: nowhere), the point's previous depth in
    /// blue. Picture: grey is none.
    Motion = 6,
    /// λ of each stratum before interpolation, 0…1.
    Gradient = 7,
    /// λ of each pixel, 0…1, a host's own too; 0 where there was no history to shorten. Needs
    /// [`DenoiserDescriptor::views`](crate::DenoiserDescriptor::views).
    Lambda = 8,
    /// Weight of the new sample, 0…1, as it was blended: 1 where there was no history, λ where the sample repeats a path, 0 where there
    /// is none. Needs [`DenoiserDescriptor::views`](crate::DenoiserDescriptor::views).
    Alpha = 9,
    /// History length in frames; beyond 32 counted at random, right on average. Picture: white at [`ViewOptions::range`].
    HistoryLength = 10,
    /// Variance of a sample's demodulated luminance. Picture: logarithmic in its root.
    Variance = 11,
    /// 1 where the filtered image is not finite.
    NonFinite = 12,
    /// Rays that the pixel cost in this frame, shadow rays and the primary one included; exact to 2048. Picture: white at
    /// [`ViewOptions::range`].
    Rays = 13,
    /// The host's motion less the motion that depth and both cameras imply for a point at rest: pixels in red and green, the
    /// difference of the previous depths in blue. Zero to 1/512 pixel but for objects that move; if the whole image changes with the camera, a
    /// sign, a unit or a matrix is wrong. Picture: grey is none.
    MotionError = 14,
    /// Linear radiance that the visible surface or the sky emits towards the eye. Picture: tone-mapped.
    Emission = 15,
    /// Number of the object that was hit, or of nothing: low 16 bits in red, high 16 in green. Picture: one colour each.
    Object = 16,
    /// What the gradient's paths reflect now, times the albedo, in the pixels where they are; −1 elsewhere. Picture: tone-mapped.
    PairNow = 17,
    /// What they reflected in the last frame, likewise.
    PairBefore = 18,
    /// Mean of the frames so far, in [`Mode::Reference`](crate::Mode::Reference): linear radiance. Picture: tone-mapped.
    Mean = 19,
    /// 1 where the pixel's sample is far brighter than its surroundings and is not believed, or not wholly, see
    /// [`FilterSettings::outlier_limit`](crate::FilterSettings::outlier_limit); 0 elsewhere. Needs
    /// [`DenoiserDescriptor::views`](crate::DenoiserDescriptor::views).
    Outliers = 20,
}

impl View {
    /// Every view, in order.
    pub const ALL: [Self; 21] = [
        Self::Denoised,
        Self::Noisy,
        Self::Albedo,
        Self::Normal,
        Self::Depth,
        Self::TriangleId,
        Self::Motion,
        Self::Gradient,
        Self::Lambda,
        Self::Alpha,
        Self::HistoryLength,
        Self::Variance,
        Self::NonFinite,
        Self::Rays,
        Self::MotionError,
        Self::Emission,
        Self::Object,
        Self::PairNow,
        Self::PairBefore,
        Self::Mean,
        Self::Outliers,
    ];

    /// The name in lower case with hyphens: `history-length`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Denoised => "denoised",
            Self::Noisy => "noisy",
            Self::Albedo => "albedo",
            Self::Normal => "normal",
            Self::Depth => "depth",
            Self::TriangleId => "triangle-id",
            Self::Motion => "motion",
            Self::Gradient => "gradient",
            Self::Lambda => "lambda",
            Self::Alpha => "alpha",
            Self::HistoryLength => "history-length",
            Self::Variance => "variance",
            Self::NonFinite => "non-finite",
            Self::Rays => "rays",
            Self::MotionError => "motion-error",
            Self::Emission => "emission",
            Self::Object => "object",
            Self::PairNow => "pair-now",
            Self::PairBefore => "pair-before",
            Self::Mean => "mean",
            Self::Outliers => "outliers",
        }
    }

    /// What [`ViewOptions::range`] is customarily set to for a picture of this view.
    pub fn default_range(self) -> f32 {
        match self {
            Self::Motion => 8.0,
            Self::MotionError => 2.0,
            Self::HistoryLength => 64.0,
            Self::Rays => 16.0,
            _ => 4.0,
        }
    }
}

/// How a [`View`] becomes a picture. Ignored where the target holds numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewOptions {
    /// Factor on radiance before tone mapping, and on the variance's root.
    pub exposure: f32,
    /// Depth, pixels of motion or frames of history that are shown grey, full or white.
    pub range: f32,
}

impl Default for ViewOptions {
    fn default() -> Self {
        Self { exposure: 1.0, range: 4.0 }
    }
}
