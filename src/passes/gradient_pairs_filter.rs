//! One iteration of the pairs' filter, see shaders/gradient_pairs_filter.wgsl.

use super::Pass;
use crate::plan::{Features, Grid, Image, Slot, Step};

pub(crate) fn step(_: Features, iteration: u32) -> Step {
    let from = (iteration % 2) as u8;
    let to = 1 - from;
    Step {
        pass: Pass::GradientPairsFilter,
        features: Features::default(),
        grid: Grid::Strata,
        iteration,
        bindings: vec![
            ("samples", Slot::Now(Image::Samples)),
            ("now", Slot::Now(Image::PairsNow(from))),
            ("before", Slot::Now(Image::PairsBefore(from))),
            ("now_out", Slot::Now(Image::PairsNow(to))),
            ("before_out", Slot::Now(Image::PairsBefore(to))),
        ],
    }
}
