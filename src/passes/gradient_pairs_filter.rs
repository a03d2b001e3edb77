//! One iteration of the pairs' filter, see shaders/gradient_pairs_filter.wgsl.

use super::prelude::*;

pub(crate) static PASS: Pass = Pass {
    name: "gradient_pairs_filter",
    source: include_str!("../../shaders/gradient_pairs_filter.wgsl"),
    grid: Strata,
    features: &[],
    bindings: &[&[
        now("samples", Image::Samples).at_many_taps(),
        turn("now", Image::PairMomentsNow).at_many_taps(),
        turn("before", Image::PairMomentsBefore),
        next_turn_out("now_out", Image::PairMomentsNow),
        next_turn_out("before_out", Image::PairMomentsBefore),
    ]],
    traces: false,
};
