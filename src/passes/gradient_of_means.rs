//! Gradient and history ratio from means, see shaders/gradient_of_means.wgsl.

use super::prelude::*;

/// The coarsest level that is stored. This pass makes one more: its mean is over as many samples as there are in 2100 strata.
pub(crate) const STORED: u8 = 4;

pub(crate) static PASS: Pass = Pass {
    name: "gradient_of_means",
    source: include_str!("../../shaders/gradient_of_means.wgsl"),
    grid: Strata,
    features: &[&[knows(HistoryRatio)]],
    bindings: &[&[
        now("samples", Image::Samples).at_many_taps(),
        level("now", Image::MeansNow).at_many_taps(),
        level("before", Image::MeansBefore),
        now("now_fine", Image::MeansNow(STORED - 1)),
        now("before_fine", Image::MeansBefore(STORED - 1)),
        out("ratio_out", Image::Ratio).with(HistoryRatio),
        out("gradient_out", Image::Gradient(0)),
    ]],
    traces: false,
};
