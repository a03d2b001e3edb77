//! Radiances of the gradient's paths, see shaders/gradient_pairs.wgsl.

use super::{Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

/// Where the radiances of a path are, now and before: in the images of two frames, or in those of the host's pairs.
pub(crate) fn sources(features: Features) -> [Slot; 2] {
    if features.has(Feature::Pairs) {
        [Slot::Now(Image::PairNow), Slot::Now(Image::PairBefore)]
    } else {
        [Slot::Now(Image::Radiance), Slot::Before(Image::Radiance)]
    }
}

/// What finds a stratum's two radiances and tells whether they are believed, see shaders/shared/pair_taps.wgsl.
pub(crate) fn taps(features: Features) -> Vec<(&'static str, Slot)> {
    let [now, before] = sources(features);
    bindings(
        features,
        [
            ("samples", Slot::Now(Image::Samples), &[]),
            ("radiance", now, &[]),
            ("radiance_previous", before, &[]),
            ("limit", Slot::Now(Image::OutlierLimit), &[Feature::Outliers]),
            ("history_previous", Slot::Before(Image::History), &[Feature::Outliers]),
        ],
    )
}

pub(crate) fn step(features: Features) -> Step {
    let features = features.and(Features::of(&[Feature::Pairs, Feature::Outliers]));
    let mut bindings = taps(features);
    bindings.push(("now_out", Slot::Now(Image::PairsNow(0))));
    bindings.push(("before_out", Slot::Now(Image::PairsBefore(0))));
    Step { pass: Pass::GradientPairs, features, grid: Grid::Strata, iteration: 0, bindings }
}
