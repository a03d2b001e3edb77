//! The intermediate images that can be shown.

use crate::listed::listed;

listed! {
    /// An intermediate image of the last frame, for [`Denoiser::show`](crate::Denoiser::show).
    ///
    /// An `rgba32float` or `rgba16float` target receives the numbers in the list, with alpha 1; an `rgba8unorm` target receives a
    /// picture (sRGB-encoded).
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
    #[non_exhaustive]
    pub enum View {
        /// The filtered image: linear radiance. Picture: tone-mapped.
        Denoised = "denoised",
        /// The samples as traced: linear radiance. Picture: tone-mapped.
        Noisy = "noisy",
        /// The albedo that radiance was divided by before filtering, 10⁻³…1. Where nothing was hit it is 0 in a traced frame, 1 in a host's.
        Albedo = "albedo",
        /// World-space normal, −1…1; 0 where nothing was hit.
        Normal = "normal",
        /// Linear depth; 0 where nothing was hit. Picture: brighter is farther, grey at [`ViewOptions::range`].
        Depth = "depth",
        /// Number of the triangle: low 16 bits in red, high 16 in green; blue is 0 where nothing was hit. Picture: one colour each.
        TriangleId = "triangle-id",
        /// Previous − current position in pixels in red and green, in steps of 1/256 (−10⁶ if the point was nowhere), and the point's
        /// previous depth in blue. Picture: grey is no motion.
        Motion = "motion",
        /// λ of each stratum before interpolation, 0…1.
        Gradient = "gradient",
        /// λ of each pixel, 0…1, also if it is a host's; 0 where there was no history to shorten. Needs
        /// [`DenoiserDescriptor::views`](crate::DenoiserDescriptor::views).
        Lambda = "lambda",
        /// Blending weight of the new sample, 0…1: 1 where there was no history, λ where the sample repeats a path, 0 where there is no
        /// sample. Needs [`DenoiserDescriptor::views`](crate::DenoiserDescriptor::views).
        Alpha = "alpha",
        /// History length in frames. Lengths beyond 32 are rounded at random; their mean is right. Picture: white at
        /// [`ViewOptions::range`].
        HistoryLength = "history-length",
        /// Variance of a sample's demodulated luminance. Picture: logarithmic in its root.
        Variance = "variance",
        /// 1 where the filtered image is not finite.
        NonFinite = "non-finite",
        /// Number of rays for the pixel in this frame, with shadow rays and the primary one; exact up to 2048. Picture: white at
        /// [`ViewOptions::range`].
        Rays = "rays",
        /// The host's motion less the motion that depth and both cameras imply for a point at rest: pixels in red and green, the
        /// difference of the previous depths in blue. It is within 1/512 pixel of zero except on objects that move. If the whole image
        /// changes with the camera, a sign, a unit or a matrix is wrong. Picture: grey is no difference.
        MotionError = "motion-error",
        /// Linear radiance that the visible surface or the sky emits towards the eye. Picture: tone-mapped.
        Emission = "emission",
        /// Number of the object that was hit, or of nothing: low 16 bits in red, high 16 in green. Picture: one colour each.
        Object = "object",
        /// Radiance that the gradient's paths reflect now, times the albedo, in the pixels of these paths; −1 elsewhere. Picture:
        /// tone-mapped.
        PairNow = "pair-now",
        /// Radiance that the same paths reflected in the last frame, in the same form.
        PairBefore = "pair-before",
        /// Mean of the frames so far, in [`Mode::Reference`](crate::Mode::Reference): linear radiance. Picture: tone-mapped.
        Mean = "mean",
        /// 1 where the pixel's sample is far brighter than its surroundings and has less than its full weight, see
        /// [`FilterSettings::outlier_limit`](crate::FilterSettings::outlier_limit); 0 elsewhere. Needs
        /// [`DenoiserDescriptor::views`](crate::DenoiserDescriptor::views).
        Outliers = "outliers",
        /// Diffuse light as traced, without emission: linear radiance. It and the views below exist if specular light is a signal of
        /// its own, see [`FilterSettings::gloss`](crate::FilterSettings::gloss). Picture: tone-mapped.
        DiffuseNoisy = "diffuse-noisy",
        /// Specular light as traced, in the same form.
        SpecularNoisy = "specular-noisy",
        /// Specular light after the filter, in the same form.
        Specular = "specular",
        /// The specular reflectance that specular light was divided by before filtering, 0.02…1; 0 where nothing shines.
        SpecularAlbedo = "specular-albedo",
        /// Perceptual roughness of the visible surface, 0…1, in steps of 1/254; 1 where nothing shines. The width of the GGX lobe is its
        /// square.
        Roughness = "roughness",
        /// Distance from the surface to what it reflects, in the scene's unit: in red smoothed over the surface, in green as the pixel's
        /// path found it. 0 where nothing shines, and in green also where the path found none. Picture: red, brighter is farther, grey at
        /// [`ViewOptions::range`].
        HitDistance = "hit-distance",
        /// Previous − current position of the reflection in pixels in red and green, in steps of 1/256, and the smoothed distance of
        /// [`View::HitDistance`] in blue; 0 where nothing shines. Picture: grey is no motion.
        ReflectionMotion = "reflection-motion",
        /// Weight of the history at the reflection's former place, 0…1, against that at the surface's, if both exist; 0 where nothing
        /// shines. Needs [`DenoiserDescriptor::views`](crate::DenoiserDescriptor::views).
        Agreement = "agreement",
        /// [`View::HistoryLength`] of specular light; 0 where nothing shines.
        SpecularHistoryLength = "specular-history-length",
        /// Specular radiance that the gradient's paths reflect now, in the form of [`View::PairNow`].
        SpecularPairNow = "specular-pair-now",
        /// Specular radiance that the same paths reflected in the last frame.
        SpecularPairBefore = "specular-pair-before",
    }
}

impl View {
    /// A [`ViewOptions::range`] that suits most pictures of this view.
    pub fn default_range(self) -> f32 {
        match self {
            Self::Motion | Self::ReflectionMotion => 8.0,
            Self::MotionError => 2.0,
            Self::HistoryLength | Self::SpecularHistoryLength => 64.0,
            Self::Rays => 16.0,
            _ => 4.0,
        }
    }
}

/// The options of a picture of a [`View`]. A target that holds numbers ignores them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewOptions {
    /// Factor on radiance before tone mapping, and on the variance's root.
    pub exposure: f32,
    /// The depth or distance that is shown grey, the motion in pixels that is shown in full colour, or the history length that is shown white.
    pub range: f32,
}

impl Default for ViewOptions {
    fn default() -> Self {
        Self { exposure: 1.0, range: 4.0 }
    }
}
