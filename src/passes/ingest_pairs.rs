//! A host's pairs for the gradient, see shaders/ingest_pairs.wgsl.

use super::{Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

const FEATURES: &[Feature] =
    &[Feature::LuminancePairs, Feature::StratumPairs, Feature::Albedo, Feature::Modulated, Feature::Diagnostics];

/// Where the albedo is read, if pairs are divided by it.
const DIVIDED: [Feature; 2] = [Feature::Albedo, Feature::Modulated];

pub(crate) fn step(features: Features) -> Step {
    let mut known = Features::of(FEATURES);
    if DIVIDED.iter().all(|&feature| features.has(feature)) {
        known = known.with(Feature::HostLight);
    }
    let features = features.and(known);
    let albedo = if features.has(Feature::HostLight) { Slot::Host } else { Slot::Now(Image::Albedo) };
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
                ("albedo", albedo, &DIVIDED),
                ("samples_out", Slot::Now(Image::Samples), &[]),
                ("pair_now_out", Slot::Now(Image::PairNow), &[]),
                ("pair_before_out", Slot::Now(Image::PairBefore), &[]),
            ],
        ),
    }
}
