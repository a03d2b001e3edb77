//! The images that passes hand to each other.

use wgpu::TextureFormat;

/// An image that passes hand to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Image {
    /// Triangle number, u32.
    Visibility,
    /// Packed normal, depth.
    Guide,
    /// Motion and previous depth.
    Motion,
    /// Instance number.
    Object,
    /// The guide of the surfaces that rays meet first, where [`Image::Guide`] is of those that are seen through glass.
    FirstGuide,
    /// The motion of these surfaces.
    FirstMotion,
    /// The objects of these surfaces.
    FirstObject,
    /// The albedo of what is seen through glass, and light that comes from there without a reflection.
    Seen,
    /// This frame's demodulated radiance.
    Radiance,
    /// The albedo that radiance was divided by.
    Albedo,
    /// Emission towards the camera.
    Emission,
    /// Accumulated colour, variance, history length.
    History,
    /// The history's colour, if it comes from the spatial filter.
    Feedback,
    /// Colour and deviation between spatial iterations; two take turns.
    Color(u8),
    /// Records of the strata.
    Samples,
    /// The path of each stratum that the host is to repeat.
    Repeats,
    /// The distance by which that path's surface has moved since.
    Shifts,
    /// Demodulated radiance now, of the host's pair for the stratum.
    HostPairNow,
    /// Demodulated radiance before, of the same pair.
    HostPairBefore,
    /// Radiances now of the gradient's pairs, and their products; two take turns while they are filtered.
    PairMomentsNow(u8),
    /// Radiances before of the gradient's pairs; two take turns.
    PairMomentsBefore(u8),
    /// Means of new samples and the variance of their difference from the histories, at each level of the pyramid.
    MeansNow(u8),
    /// Means of the histories at each level.
    MeansBefore(u8),
    /// Numerator and denominator of λ on the stratum's surface, and on any surface, as bits of f32; two take turns.
    Gradient(u8),
    /// The factor on the history, as bits of f32.
    Ratio,
    /// Sum over frames, and their number.
    Sum,
    /// Sum of the paths' radiances so far, and the number of their rays, if several dispatches trace them; two take turns.
    Paths(u8),
    /// α and λ.
    Weights,
    /// The last output at the surface's former place, and its weight.
    Reprojected,
    /// The filtered colour with the last one blended in.
    Output,
    /// The sample of each stratum that is farthest above its level, and the light of the stratum's other pixels.
    Candidates,
    /// Number of strata in a row that have such a sample, by the sample's ratio to its level.
    CandidateCounts,
    /// Light that the pixels of a row show.
    CandidateSums,
    /// Greatest ratio of a sample to its level in each stratum, that level if there is no history, and the stratum's candidate.
    OutlierLimit,
    /// Facts on each stratum's candidate and on the light around it, for the next frame.
    OutlierMemory,
    /// The same of specular light, and the sum of the inverse distances of what is reflected.
    SpecularPaths(u8),
    /// Roughness, the distance from the surface to what it reflects, of each path, and the number of the object.
    Gloss,
    /// Motion of the reflection, roughness, and the smoothed distance from the surface to what it reflects.
    Reflection,
    /// Evidence of each stratum for the reflection's former place against the surface's.
    Agreement,
    /// The specular signal's twin of an image of the diffuse one.
    Specular(Twin),
}

/// Declares the twins, each with the name of its image.
macro_rules! twins {
    ($($name:ident $(($n:ident: $ty:ty))?,)+) => {
        /// An image of which each signal has its own: the specular signal's twin of the [`Image`] of the same name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Twin {
            $(
                #[doc = concat!("The twin of [`Image::", stringify!($name), "`].")]
                $name $(($ty))?,
            )+
        }

        impl Twin {
            /// The diffuse signal's image.
            pub fn image(self) -> Image {
                match self {
                    $(Self::$name $(($n))? => Image::$name $(($n))?,)+
                }
            }
        }

        impl Image {
            /// The specular signal's image: the twin, or the image itself if both signals share it.
            pub(crate) fn specular(self) -> Self {
                match self {
                    $(Self::$name $(($n))? => Self::Specular(Twin::$name $(($n))?),)+
                    shared => shared,
                }
            }
        }
    };
}

twins! {
    Guide,
    Radiance,
    Albedo,
    History,
    Feedback,
    Color(turn: u8),
    Samples,
    HostPairNow,
    HostPairBefore,
    PairMomentsNow(turn: u8),
    PairMomentsBefore(turn: u8),
    MeansNow(level: u8),
    MeansBefore(level: u8),
    Gradient(turn: u8),
    Ratio,
    Weights,
    Reprojected,
    Output,
    Candidates,
    CandidateCounts,
    CandidateSums,
    OutlierLimit,
    OutlierMemory,
}

/// The texels of an image, or the invocations of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Grid {
    /// One per pixel.
    Pixels,
    /// One per stratum of 3×3 pixels.
    Strata,
}

const MEANS_NOW: [&str; 6] = ["means now 0", "means now 1", "means now 2", "means now 3", "means now 4", "means now 5"];
const MEANS_BEFORE: [&str; 6] =
    ["means before 0", "means before 1", "means before 2", "means before 3", "means before 4", "means before 5"];

impl Image {
    /// Name of the image, with its signal if that is the specular one, and its number if it takes turns or has levels.
    pub fn name(self) -> String {
        match self {
            Self::Specular(twin) => format!("specular {}", twin.image().name()),
            _ => self.row().0.into(),
        }
    }

    /// The image of the surfaces that rays meet first, which shine with their reflections.
    pub(super) fn first(self) -> Self {
        match self {
            Self::Guide => Self::FirstGuide,
            Self::Motion => Self::FirstMotion,
            Self::Object => Self::FirstObject,
            other => other,
        }
    }

    /// Format of the texture.
    pub fn format(self) -> TextureFormat {
        self.row().1
    }

    /// Size of the image.
    pub fn grid(self) -> Grid {
        self.row().2
    }

    fn row(self) -> (&'static str, TextureFormat, Grid) {
        use Grid::{Pixels, Strata};
        use TextureFormat::{R32Uint, Rg32Float, Rg32Uint, Rgba16Float, Rgba32Float, Rgba32Uint};
        match self {
            Self::Visibility => ("visibility", R32Uint, Pixels),
            Self::Guide => ("guide", Rg32Uint, Pixels),
            Self::Motion => ("motion", Rg32Uint, Pixels),
            Self::Object => ("object", R32Uint, Pixels),
            Self::FirstGuide => ("first guide", Rg32Uint, Pixels),
            Self::FirstMotion => ("first motion", Rg32Uint, Pixels),
            Self::FirstObject => ("first object", R32Uint, Pixels),
            Self::Seen => ("seen", Rgba32Uint, Pixels),
            Self::Radiance => ("radiance", Rg32Uint, Pixels),
            Self::Albedo => ("albedo", Rgba16Float, Pixels),
            Self::Emission => ("emission", Rg32Uint, Pixels),
            Self::History => ("history", Rg32Uint, Pixels),
            Self::Feedback => ("feedback", Rg32Uint, Pixels),
            Self::Color(0) => ("color 0", Rg32Uint, Pixels),
            Self::Color(_) => ("color 1", Rg32Uint, Pixels),
            Self::Samples => ("samples", Rgba32Uint, Strata),
            Self::Repeats => ("repeats", Rgba32Uint, Strata),
            Self::Shifts => ("shifts", Rgba32Uint, Strata),
            Self::HostPairNow => ("host pair now", Rg32Uint, Strata),
            Self::HostPairBefore => ("host pair before", Rg32Uint, Strata),
            Self::PairMomentsNow(0) => ("pair moments now 0", Rgba32Uint, Strata),
            Self::PairMomentsNow(_) => ("pair moments now 1", Rgba32Uint, Strata),
            Self::PairMomentsBefore(0) => ("pair moments before 0", Rgba32Uint, Strata),
            Self::PairMomentsBefore(_) => ("pair moments before 1", Rgba32Uint, Strata),
            Self::MeansNow(level) => (MEANS_NOW[usize::from(level) % MEANS_NOW.len()], Rgba32Uint, Strata),
            Self::MeansBefore(level) => (MEANS_BEFORE[usize::from(level) % MEANS_BEFORE.len()], Rgba32Uint, Strata),
            Self::Gradient(0) => ("gradient 0", Rgba32Uint, Strata),
            Self::Gradient(_) => ("gradient 1", Rgba32Uint, Strata),
            Self::Ratio => ("ratio", Rgba32Uint, Strata),
            Self::Sum => ("sum", Rgba32Float, Pixels),
            Self::Paths(0) => ("paths 0", Rgba32Float, Pixels),
            Self::Paths(_) => ("paths 1", Rgba32Float, Pixels),
            Self::SpecularPaths(0) => ("specular paths 0", Rgba32Float, Pixels),
            Self::SpecularPaths(_) => ("specular paths 1", Rgba32Float, Pixels),
            Self::Weights => ("weights", Rg32Float, Pixels),
            Self::Reprojected => ("reprojected", Rg32Uint, Pixels),
            Self::Output => ("output", Rg32Uint, Pixels),
            Self::Candidates => ("candidates", Rgba32Uint, Strata),
            Self::CandidateCounts => ("candidate counts", Rgba32Uint, Strata),
            Self::CandidateSums => ("candidate sums", Rgba32Uint, Strata),
            Self::OutlierLimit => ("outlier limit", Rg32Uint, Strata),
            Self::OutlierMemory => ("outlier memory", Rgba32Uint, Strata),
            Self::Gloss => ("gloss", Rg32Uint, Pixels),
            Self::Reflection => ("reflection", Rg32Uint, Pixels),
            Self::Agreement => ("agreement", Rg32Uint, Strata),
            // The path tracer keeps the distance of what is reflected beside it.
            Self::Specular(Twin::Radiance) => ("specular radiance", Rgba32Uint, Pixels),
            Self::Specular(twin) => twin.image().row(),
        }
    }
}

impl Grid {
    /// Pixels or strata in each direction, for a picture of this size.
    pub fn extent(self, size: [u32; 2]) -> [u32; 2] {
        match self {
            Self::Pixels => size,
            Self::Strata => size.map(|side| side.div_ceil(3)),
        }
    }
}
