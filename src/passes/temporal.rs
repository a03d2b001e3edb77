//! Reprojection and blending, see shaders/temporal.wgsl.

use super::{Pass, bindings, modulation};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

const FEATURES: &[Feature] = &[
    Feature::Objects,
    Feature::Still,
    Feature::Gradient,
    Feature::AcrossSurfaces,
    Feature::InPlace,
    Feature::HistoryRatio,
    Feature::ExternalLambda,
    Feature::Confidence,
    Feature::BlendByLambda,
    Feature::Feedback,
    Feature::HostMotion,
    Feature::HostLight,
    Feature::MissingSamples,
    Feature::Steady,
    Feature::KeepWeights,
];

/// What finds the surface in the last frame.
const REPROJECTION: [&str; 4] = ["guide_previous", "motion", "object", "object_previous"];

/// `gradient` is where the filtered gradient is, if there is one.
pub(crate) fn step(given: Features, gradient: Option<Image>) -> Step {
    let mut features = given.and(Features::of(FEATURES));
    if features.has(Feature::Still) {
        features = features.without(Feature::Objects).without(Feature::HostMotion);
    }
    let features = modulation(given, features);
    // A host's own image, or its copy.
    let source = |direct, image| if features.has(direct) { Slot::Host } else { Slot::Now(image) };
    let gradient = gradient.unwrap_or(Image::Gradient(0));
    let mut bindings = bindings(
        features,
        [
            ("guide", Slot::Now(Image::Guide), &[]),
            ("guide_previous", Slot::Before(Image::Guide), &[]),
            ("motion", source(Feature::HostMotion, Image::Motion), &[]),
            ("previous_depth", Slot::Host, &[Feature::PreviousDepth]),
            ("object", Slot::Now(Image::Object), &[Feature::Objects]),
            ("object_previous", Slot::Before(Image::Object), &[Feature::Objects]),
            ("radiance", source(Feature::HostLight, Image::Radiance), &[]),
            ("albedo", Slot::Host, &[Feature::Albedo]),
            ("emission", Slot::Host, &[Feature::DirectEmission]),
            ("history_previous", Slot::Before(Image::History), &[]),
            ("feedback_previous", Slot::Before(Image::Feedback), &[Feature::Feedback]),
            ("feedback_out", Slot::Now(Image::Feedback), &[Feature::Feedback]),
            ("samples", Slot::Now(Image::Samples), &[Feature::Gradient]),
            ("gradient", Slot::Now(gradient), &[Feature::Gradient]),
            ("ratio", Slot::Now(Image::Ratio), &[Feature::HistoryRatio]),
            ("external_lambda", Slot::Host, &[Feature::ExternalLambda]),
            ("output_previous", Slot::Before(Image::Output), &[Feature::Steady]),
            ("reprojected_out", Slot::Now(Image::Reprojected), &[Feature::Steady]),
            ("history_out", Slot::Now(Image::History), &[]),
            ("weights_out", Slot::Now(Image::Weights), &[Feature::KeepWeights]),
        ],
    );
    bindings.retain(|(name, _)| !(features.has(Feature::Still) && REPROJECTION.contains(name)));
    Step { pass: Pass::Temporal, features, grid: Grid::Pixels, iteration: 0, bindings }
}
