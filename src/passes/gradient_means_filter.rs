//! The next coarser level of the means' pyramid, see shaders/gradient_means_filter.wgsl.

use super::prelude::*;

pub(crate) static PASS: Pass = Pass {
    name: "gradient_means_filter",
    source: include_str!("../../shaders/gradient_means_filter.wgsl"),
    grid: Strata,
    features: &[],
    bindings: &[&[
        now("samples", Image::Samples).at_many_taps(),
        level("now", Image::MeansNow).at_many_taps(),
        level("before", Image::MeansBefore),
        next_level_out("now_out", Image::MeansNow),
        next_level_out("before_out", Image::MeansBefore),
    ]],
    traces: false,
};
