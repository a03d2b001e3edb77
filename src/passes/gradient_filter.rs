//! One iteration of the gradient's filter, see shaders/gradient_filter.wgsl.

use super::prelude::*;

pub(crate) static PASS: Pass = Pass {
    name: "gradient_filter",
    source: include_str!("../../shaders/gradient_filter.wgsl"),
    grid: Strata,
    features: &[&[knows(AcrossSurfaces)]],
    bindings: &[&[
        now("samples", Image::Samples).at_many_taps(),
        turn("gradient", Image::Gradient).at_many_taps(),
        next_turn_out("gradient_out", Image::Gradient),
    ]],
    traces: false,
};
