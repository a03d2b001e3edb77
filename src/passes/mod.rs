//! The passes, one file each, with the shader of the same name in shaders/.
//!
//! A pass says which of the plan's features its shader knows and which images stand behind its bindings. Group 0 holds those;
//! group 1 holds the scene, bound by name.

pub(crate) mod atrous;
pub(crate) mod gradient;
pub(crate) mod gradient_filter;
pub(crate) mod gradient_means;
pub(crate) mod gradient_means_filter;
pub(crate) mod gradient_of_means;
pub(crate) mod gradient_pairs;
pub(crate) mod gradient_pairs_filter;
pub(crate) mod gradient_sample;
pub(crate) mod ingest_pairs;
pub(crate) mod ingest_radiance;
pub(crate) mod ingest_surface;
pub(crate) mod outlier_candidates;
pub(crate) mod outlier_counts;
pub(crate) mod outlier_limit;
pub(crate) mod reshade;
pub(crate) mod resolve;
pub(crate) mod steady;
pub(crate) mod temporal;
#[cfg(feature = "path-tracer")]
pub(crate) mod trace;
pub(crate) mod variance;
pub(crate) mod view;
#[cfg(feature = "path-tracer")]
pub(crate) mod visibility;

use crate::plan::{Feature, Features, Image, Slot};

/// A compute shader of the pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Pass {
    /// Primary rays: triangle, normal, depth and motion of each pixel.
    #[cfg(feature = "path-tracer")]
    Visibility,
    /// A host's depth, normals and motion.
    IngestSurface,
    /// Choice of the gradient's sample in each stratum.
    GradientSample,
    /// What a host needs to repeat the path of that sample.
    Reshade,
    /// Paths: demodulated radiance, albedo, emission.
    #[cfg(feature = "path-tracer")]
    Trace,
    /// A host's radiance, demodulated.
    IngestRadiance,
    /// A host's pairs for the gradient.
    IngestPairs,
    /// Samples that may be outliers.
    OutlierCandidates,
    /// How many there are in a row of strata.
    OutlierCounts,
    /// How far above its level a sample is believed.
    OutlierLimit,
    /// Radiances of the gradient's paths, now and before.
    GradientPairs,
    /// Their filter.
    GradientPairsFilter,
    /// Gradient and history ratio of each stratum.
    Gradient,
    /// The gradient's filter.
    GradientFilter,
    /// Means of new samples and of their histories, for a gradient without repeated paths.
    GradientMeans,
    /// Their filter.
    GradientMeansFilter,
    /// Gradient and history ratio of each stratum, from these means.
    GradientOfMeans,
    /// Reprojection and blending.
    Temporal,
    /// Variance of short histories.
    Variance,
    /// One spatial iteration.
    Atrous,
    /// The last output blended in.
    Steady,
    /// The picture put together.
    Resolve,
    /// An intermediate shown.
    View,
}

impl Pass {
    /// The shader's file name without its ending.
    pub fn name(self) -> &'static str {
        match self {
            #[cfg(feature = "path-tracer")]
            Self::Visibility => "visibility",
            Self::IngestSurface => "ingest_surface",
            Self::GradientSample => "gradient_sample",
            Self::Reshade => "reshade",
            #[cfg(feature = "path-tracer")]
            Self::Trace => "trace",
            Self::IngestRadiance => "ingest_radiance",
            Self::IngestPairs => "ingest_pairs",
            Self::OutlierCandidates => "outlier_candidates",
            Self::OutlierCounts => "outlier_counts",
            Self::OutlierLimit => "outlier_limit",
            Self::GradientPairs => "gradient_pairs",
            Self::GradientPairsFilter => "gradient_pairs_filter",
            Self::Gradient => "gradient",
            Self::GradientFilter => "gradient_filter",
            Self::GradientMeans => "gradient_means",
            Self::GradientMeansFilter => "gradient_means_filter",
            Self::GradientOfMeans => "gradient_of_means",
            Self::Temporal => "temporal",
            Self::Variance => "variance",
            Self::Atrous => "atrous",
            Self::Steady => "steady",
            Self::Resolve => "resolve",
            Self::View => "view",
        }
    }

    /// Whether it follows rays through a scene.
    pub(crate) fn traces(self) -> bool {
        #[cfg(feature = "path-tracer")]
        return matches!(self, Self::Visibility | Self::Trace);
        #[cfg(not(feature = "path-tracer"))]
        false
    }

    pub(crate) fn source(self) -> &'static str {
        match self {
            #[cfg(feature = "path-tracer")]
            Self::Visibility => include_str!("../../shaders/visibility.wgsl"),
            Self::IngestSurface => include_str!("../../shaders/ingest_surface.wgsl"),
            Self::GradientSample => include_str!("../../shaders/gradient_sample.wgsl"),
            Self::Reshade => include_str!("../../shaders/reshade.wgsl"),
            #[cfg(feature = "path-tracer")]
            Self::Trace => include_str!("../../shaders/trace.wgsl"),
            Self::IngestRadiance => include_str!("../../shaders/ingest_radiance.wgsl"),
            Self::IngestPairs => include_str!("../../shaders/ingest_pairs.wgsl"),
            Self::OutlierCandidates => include_str!("../../shaders/outlier_candidates.wgsl"),
            Self::OutlierCounts => include_str!("../../shaders/outlier_counts.wgsl"),
            Self::OutlierLimit => include_str!("../../shaders/outlier_limit.wgsl"),
            Self::GradientPairs => include_str!("../../shaders/gradient_pairs.wgsl"),
            Self::GradientPairsFilter => include_str!("../../shaders/gradient_pairs_filter.wgsl"),
            Self::Gradient => include_str!("../../shaders/gradient.wgsl"),
            Self::GradientFilter => include_str!("../../shaders/gradient_filter.wgsl"),
            Self::GradientMeans => include_str!("../../shaders/gradient_means.wgsl"),
            Self::GradientMeansFilter => include_str!("../../shaders/gradient_means_filter.wgsl"),
            Self::GradientOfMeans => include_str!("../../shaders/gradient_of_means.wgsl"),
            Self::Temporal => include_str!("../../shaders/temporal.wgsl"),
            Self::Variance => include_str!("../../shaders/variance.wgsl"),
            Self::Atrous => include_str!("../../shaders/atrous.wgsl"),
            Self::Steady => include_str!("../../shaders/steady.wgsl"),
            Self::Resolve => include_str!("../../shaders/resolve.wgsl"),
            Self::View => include_str!("../../shaders/view.wgsl"),
        }
    }
}

/// What a shader that follows rays through the scene can have compiled in.
#[cfg(feature = "path-tracer")]
const GEOMETRY: &[Feature] = &[
    Feature::Instanced,
    Feature::Textures,
    Feature::FoldedImages,
    Feature::ShadingNormals,
    Feature::VertexColors,
    Feature::AlphaMask,
    Feature::AlphaBlend,
    Feature::FewTriangles,
];

/// What the shader takes out of a host's radiance as it reads it.
const MODULATION: [Feature; 3] = [Feature::Modulated, Feature::Albedo, Feature::DirectEmission];

/// The features of a pass that reads the motion and the light of `given`, with those that a host's own images need where they are read.
fn modulation(given: Features, mut features: Features) -> Features {
    if features.has(Feature::HostMotion) {
        features = features.or(given.and(Features::of(&[Feature::PreviousDepth])));
    }
    if features.has(Feature::HostLight) && given.has(Feature::Modulated) {
        features = features.or(given.and(Features::of(&MODULATION)));
    }
    features
}

/// A host's own image, or its copy.
fn source(features: Features, direct: Feature, image: Image) -> Slot {
    if features.has(direct) { Slot::Host } else { Slot::Now(image) }
}

/// What a pixel's sample is, where its surface was, and what the last frame left.
fn sample_and_history(features: Features) -> Vec<(&'static str, Slot)> {
    let mut found = bindings(
        features,
        [
            ("guide", Slot::Now(Image::Guide), &[]),
            ("radiance", source(features, Feature::HostLight, Image::Radiance), &[]),
            ("albedo", Slot::Host, &[Feature::Albedo]),
            ("emission", Slot::Host, &[Feature::DirectEmission]),
            ("history_previous", Slot::Before(Image::History), &[]),
            ("feedback_previous", Slot::Before(Image::Feedback), &[Feature::Feedback]),
            ("output_previous", Slot::Before(Image::Output), &[Feature::Steady]),
        ],
    );
    if !features.has(Feature::Still) {
        found.extend(bindings(
            features,
            [
                ("motion", source(features, Feature::HostMotion, Image::Motion), &[]),
                ("previous_depth", Slot::Host, &[Feature::PreviousDepth]),
            ],
        ));
    }
    found
}

/// The same, and what tells whether that is the same surface.
fn reprojection(features: Features) -> Vec<(&'static str, Slot)> {
    let mut found = sample_and_history(features);
    if !features.has(Feature::Still) {
        found.extend(bindings(
            features,
            [
                ("guide_previous", Slot::Before(Image::Guide), &[]),
                ("object", Slot::Now(Image::Object), &[Feature::Objects]),
                ("object_previous", Slot::Before(Image::Object), &[Feature::Objects]),
            ],
        ));
    }
    found
}

/// The bindings of a list whose features are all present.
fn bindings<const N: usize>(
    features: Features,
    all: [(&'static str, Slot, &[Feature]); N],
) -> Vec<(&'static str, Slot)> {
    all.into_iter()
        .filter(|(_, _, needed)| needed.iter().all(|&f| features.has(f)))
        .map(|(name, slot, _)| (name, slot))
        .collect()
}
