//! Reprojection and blending, see shaders/temporal.wgsl.

use super::{Pass, bindings, modulation, reprojection};
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
    Feature::Outliers,
    Feature::KeepWeights,
];

/// `gradient` is where the filtered gradient is, if there is one.
pub(crate) fn step(given: Features, gradient: Option<Image>) -> Step {
    let mut features = given.and(Features::of(FEATURES));
    if features.has(Feature::Still) {
        features = features.without(Feature::Objects).without(Feature::HostMotion);
    }
    let mut features = modulation(given, features);
    if features.has(Feature::Outliers) {
        features = features.or(given.and(Features::of(&[Feature::Diagnostics])));
    }
    let gradient = gradient.unwrap_or(Image::Gradient(0));
    let mut all = reprojection(features);
    all.extend(bindings(
        features,
        [
            ("feedback_out", Slot::Now(Image::Feedback), &[Feature::Feedback]),
            ("samples", Slot::Now(Image::Samples), &[Feature::Gradient]),
            ("candidates", Slot::Now(Image::Candidates), &[Feature::Outliers]),
            ("limit", Slot::Now(Image::OutlierLimit), &[Feature::Outliers]),
            ("gradient", Slot::Now(gradient), &[Feature::Gradient]),
            ("ratio", Slot::Now(Image::Ratio), &[Feature::HistoryRatio]),
            ("external_lambda", Slot::Host, &[Feature::ExternalLambda]),
            ("reprojected_out", Slot::Now(Image::Reprojected), &[Feature::Steady]),
            ("history_out", Slot::Now(Image::History), &[]),
            ("weights_out", Slot::Now(Image::Weights), &[Feature::KeepWeights]),
        ],
    ));
    Step { pass: Pass::Temporal, features, grid: Grid::Pixels, iteration: 0, bindings: all }
}
