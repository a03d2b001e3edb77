//! Radiances of the repeated paths, see shaders/gradient_pairs.wgsl.

use super::Pass;
use crate::plan::{Features, Grid, Image, Slot, Step};

pub(crate) fn step(_: Features) -> Step {
    Step {
        pass: Pass::GradientPairs,
        features: Features::default(),
        grid: Grid::Strata,
        iteration: 0,
        bindings: vec![
            ("samples", Slot::Now(Image::Samples)),
            ("radiance", Slot::Now(Image::Radiance)),
            ("radiance_previous", Slot::Before(Image::Radiance)),
            ("now_out", Slot::Now(Image::PairsNow(0))),
            ("before_out", Slot::Now(Image::PairsBefore(0))),
            ("product_out", Slot::Now(Image::PairsProduct(0))),
        ],
    }
}
