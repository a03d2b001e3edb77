//! One spatial iteration, see shaders/atrous.wgsl.

use super::prelude::*;

/// The first iteration smooths the variance and feeds the history. A small kernel has only the nearest taps.
pub(crate) static PASS: Pass = Pass {
    name: "atrous",
    source: include_str!("../../shaders/atrous.wgsl"),
    grid: Pixels,
    features: &[&[
        knows(FirstIteration),
        knows(Feedback).with(FirstIteration),
        knows(ClassicStops),
        knows(SmallKernel),
        knows(FullKernel).unless(SmallKernel),
        knows(LocalLinearFit),
        knows(RidgeByNoise),
        knows(SpecularSignal),
    ]],
    bindings: &[&[
        now("guide", Image::Guide).at_many_taps(),
        now("reflection", Image::Reflection).with(SpecularSignal),
        turn("color", Image::Color).at_many_taps(),
        next_turn_out("color_out", Image::Color),
        out("feedback_out", Image::Feedback).with(Feedback),
    ]],
    traces: false,
};
