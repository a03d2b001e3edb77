//! Variance of each pixel's luminance, from its neighbours where the history is short, see shaders/variance.wgsl.

use super::prelude::*;

pub(crate) static PASS: Pass = Pass {
    name: "variance",
    source: include_str!("../../shaders/variance.wgsl"),
    grid: Pixels,
    features: &[&[
        knows(Feedback),
        knows(VarianceOfMean),
        knows(MissingSamples),
        knows(RepeatedNoise),
        knows(SpecularSignal),
        knows(Clamp).with(SpecularSignal),
        knows(Clamp).with(MixedGloss),
    ]],
    bindings: &[&[
        now("guide", Image::Guide).of_surfaces(),
        now("history", Image::History),
        now("feedback", Image::Feedback).with(Feedback),
        now("reflection", Image::Reflection).with(SpecularSignal),
        out("guide_out", Image::Guide).with(SpecularSignal),
        out("color_out", Image::Color(0)),
    ]],
    traces: false,
};
