//! A host's pairs for the gradient, see shaders/ingest_pairs.wgsl.

use super::{Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

const FEATURES: &[Feature] =
    &[Feature::LuminancePairs, Feature::StratumPairs, Feature::Albedo, Feature::Modulated, Feature::Diagnostics];

pub(crate) fn step(features: Features) -> Step {
    let features = features.and(Features::of(FEATURES));
    Step {
        pass: Pass::IngestPairs,
        features,
        grid: Grid::Strata,
        iteration: 0,
        bindings: bindings(
            features,
            [
                ("guide", Slot::Now(Image::Guide), &[]),
                ("current", Slot::Host, &[]),
                ("previous", Slot::Host, &[]),
                ("albedo", Slot::Now(Image::Albedo), &[Feature::Albedo, Feature::Modulated]),
                ("samples_out", Slot::Now(Image::Samples), &[]),
                ("pair_now_out", Slot::Now(Image::PairNow), &[]),
                ("pair_before_out", Slot::Now(Image::PairBefore), &[]),
            ],
        ),
    }
}
