//! Gradient and history ratio from means, see shaders/gradient_of_means.wgsl.

use super::prelude::*;

/// The coarsest level of the pyramid: its mean is over as many samples as there are in 2100 strata.
pub(crate) const COARSEST: u8 = 5;

pub(crate) static PASS: Pass = Pass {
    name: "gradient_of_means",
    source: include_str!("../../shaders/gradient_of_means.wgsl"),
    grid: Strata,
    features: &[&[knows(HistoryRatio)]],
    bindings: &[&[
        now("samples", Image::Samples),
        now("now_coarse", Image::MeansNow(COARSEST)),
        now("before_coarse", Image::MeansBefore(COARSEST)),
        now("now_middle", Image::MeansNow(COARSEST - 1)),
        now("before_middle", Image::MeansBefore(COARSEST - 1)),
        now("now_fine", Image::MeansNow(COARSEST - 2)),
        now("before_fine", Image::MeansBefore(COARSEST - 2)),
        out("ratio_out", Image::Ratio).with(HistoryRatio),
        out("gradient_out", Image::Gradient(0)),
    ]],
    traces: false,
};
