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
    /// Greatest ratio of a sample to its level in each stratum, and that level if there is no history.
    OutlierLimit,
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
    /// Format of the texture.
    pub fn format(self) -> TextureFormat {
        match self {
            Self::Visibility | Self::Object => TextureFormat::R32Uint,
            Self::Guide
            | Self::Motion
            | Self::Radiance
            | Self::Emission
            | Self::History
            | Self::Feedback
            | Self::Color(_)
            | Self::Reprojected
            | Self::Output
            | Self::HostPairNow
            | Self::HostPairBefore => TextureFormat::Rg32Uint,
            Self::Samples
            | Self::Repeats
            | Self::Shifts
            | Self::PairMomentsNow(_)
            | Self::PairMomentsBefore(_)
            | Self::MeansNow(_)
            | Self::MeansBefore(_)
            | Self::Gradient(_)
            | Self::Ratio
            | Self::Candidates
            | Self::CandidateCounts
            | Self::CandidateSums
            | Self::OutlierLimit => TextureFormat::Rgba32Uint,
            Self::Albedo => TextureFormat::Rgba16Float,
            Self::Sum | Self::Paths(_) => TextureFormat::Rgba32Float,
            Self::Weights => TextureFormat::Rg32Float,
        }
    }

    /// Size of the image.
    pub fn grid(self) -> Grid {
        match self {
            Self::Samples
            | Self::Repeats
            | Self::Shifts
            | Self::HostPairNow
            | Self::HostPairBefore
            | Self::PairMomentsNow(_)
            | Self::PairMomentsBefore(_)
            | Self::MeansNow(_)
            | Self::MeansBefore(_)
            | Self::Gradient(_)
            | Self::Ratio
            | Self::Candidates
            | Self::CandidateCounts
            | Self::CandidateSums
            | Self::OutlierLimit => Grid::Strata,
            _ => Grid::Pixels,
        }
    }

    /// Name of the image, with its number if it takes turns or has levels.
    pub fn name(self) -> &'static str {
        match self {
            Self::Visibility => "visibility",
            Self::Guide => "guide",
            Self::Motion => "motion",
            Self::Object => "object",
            Self::Radiance => "radiance",
            Self::Albedo => "albedo",
            Self::Emission => "emission",
            Self::History => "history",
            Self::Feedback => "feedback",
            Self::Color(0) => "color 0",
            Self::Color(_) => "color 1",
            Self::Samples => "samples",
            Self::Repeats => "repeats",
            Self::Shifts => "shifts",
            Self::HostPairNow => "host pair now",
            Self::HostPairBefore => "host pair before",
            Self::PairMomentsNow(0) => "pair moments now 0",
            Self::PairMomentsNow(_) => "pair moments now 1",
            Self::PairMomentsBefore(0) => "pair moments before 0",
            Self::PairMomentsBefore(_) => "pair moments before 1",
            Self::MeansNow(level) => MEANS_NOW[usize::from(level) % MEANS_NOW.len()],
            Self::MeansBefore(level) => MEANS_BEFORE[usize::from(level) % MEANS_BEFORE.len()],
            Self::Gradient(0) => "gradient 0",
            Self::Gradient(_) => "gradient 1",
            Self::Ratio => "ratio",
            Self::Sum => "sum",
            Self::Paths(0) => "paths 0",
            Self::Paths(_) => "paths 1",
            Self::Weights => "weights",
            Self::Reprojected => "reprojected",
            Self::Output => "output",
            Self::Candidates => "candidates",
            Self::CandidateCounts => "candidate counts",
            Self::CandidateSums => "candidate sums",
            Self::OutlierLimit => "outlier limit",
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
