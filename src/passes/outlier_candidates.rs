//! Samples that may be outliers, see shaders/outlier_candidates.wgsl.

use super::{Pass, bindings, modulation, sample_and_history};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

const FEATURES: &[Feature] = &[
    Feature::Still,
    Feature::InPlace,
    Feature::HostMotion,
    Feature::HostLight,
    Feature::MissingSamples,
    Feature::Steady,
];

pub(crate) fn step(given: Features) -> Step {
    let mut features = given.and(Features::of(FEATURES));
    if features.has(Feature::Still) {
        features = features.without(Feature::HostMotion);
    }
    let features = modulation(given, features);
    let mut all = sample_and_history(features);
    all.extend(bindings(
        features,
        [
            ("samples", Slot::Now(Image::Samples), &[Feature::InPlace]),
            ("candidates_previous", Slot::Before(Image::Candidates), &[]),
            ("limit_previous", Slot::Before(Image::OutlierLimit), &[]),
            ("candidates_out", Slot::Now(Image::Candidates), &[]),
        ],
    ));
    Step { pass: Pass::OutlierCandidates, features, grid: Grid::Strata, iteration: 0, bindings: all }
}
