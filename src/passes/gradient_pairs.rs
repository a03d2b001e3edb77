//! Radiances of the gradient's paths, see shaders/gradient_pairs.wgsl.

use super::Pass;
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

/// Where the radiances of a path are, now and before: in the images of two frames, or in those of the host's pairs.
pub(crate) fn sources(features: Features) -> [Slot; 2] {
    if features.has(Feature::Pairs) {
        [Slot::Now(Image::PairNow), Slot::Now(Image::PairBefore)]
    } else {
        [Slot::Now(Image::Radiance), Slot::Before(Image::Radiance)]
    }
}

pub(crate) fn step(features: Features) -> Step {
    let features = features.and(Features::of(&[Feature::Pairs]));
    let [now, before] = sources(features);
    Step {
        pass: Pass::GradientPairs,
        features,
        grid: Grid::Strata,
        iteration: 0,
        bindings: vec![
            ("samples", Slot::Now(Image::Samples)),
            ("radiance", now),
            ("radiance_previous", before),
            ("now_out", Slot::Now(Image::PairsNow(0))),
            ("before_out", Slot::Now(Image::PairsBefore(0))),
        ],
    }
}
