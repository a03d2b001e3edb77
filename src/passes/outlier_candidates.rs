//! Samples that may be outliers, see shaders/outlier_candidates.wgsl.

use super::{Pass, bindings, modulation, source};
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
    let mut all = bindings(
        features,
        [
            ("guide", Slot::Now(Image::Guide), &[]),
            ("radiance", source(features, Feature::HostLight, Image::Radiance), &[]),
            ("albedo", Slot::Host, &[Feature::Albedo]),
            ("emission", Slot::Host, &[Feature::DirectEmission]),
            ("history_previous", Slot::Before(Image::History), &[]),
            ("output_previous", Slot::Before(Image::Output), &[Feature::Steady]),
            ("samples", Slot::Now(Image::Samples), &[Feature::InPlace]),
            ("candidates_previous", Slot::Before(Image::Candidates), &[]),
            ("limit_previous", Slot::Before(Image::OutlierLimit), &[]),
            ("candidates_out", Slot::Now(Image::Candidates), &[]),
        ],
    );
    if !features.has(Feature::Still) {
        all.push(("motion", source(features, Feature::HostMotion, Image::Motion)));
        if features.has(Feature::PreviousDepth) {
            all.push(("previous_depth", Slot::Host));
        }
    }
    Step { pass: Pass::OutlierCandidates, features, grid: Grid::Strata, iteration: 0, bindings: all }
}
