//! Means of new samples and of their histories, see shaders/gradient_means.wgsl.

use super::{Pass, modulation, reprojection};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

const FEATURES: &[Feature] = &[
    Feature::Objects,
    Feature::Feedback,
    Feature::HostMotion,
    Feature::HostLight,
    Feature::MissingSamples,
    Feature::Outliers,
];

pub(crate) fn step(given: Features) -> Step {
    let features = modulation(given, given.and(Features::of(FEATURES)));
    let mut bindings = reprojection(features);
    if features.has(Feature::Outliers) {
        bindings.push(("limit", Slot::Now(Image::OutlierLimit)));
    }
    bindings.extend([
        ("samples_out", Slot::Now(Image::Samples)),
        ("now_out", Slot::Now(Image::MeansNow(0))),
        ("before_out", Slot::Now(Image::MeansBefore(0))),
    ]);
    Step { pass: Pass::GradientMeans, features, grid: Grid::Strata, iteration: 0, bindings }
}
