//! The choice of each stratum's path to repeat, see shaders/gradient_sample.wgsl.

use super::prelude::*;

pub(crate) static PASS: Pass = Pass {
    name: "gradient_sample",
    source: include_str!("../../shaders/gradient_sample.wgsl"),
    grid: Strata,
    features: &[&[knows(Objects)]],
    bindings: &[&[
        now("guide", Image::Guide),
        before("guide_previous", Image::Guide),
        now("motion", Image::Motion),
        now("object", Image::Object).with(Objects),
        before("object_previous", Image::Object).with(Objects),
        before("samples_previous", Image::Samples),
        out("samples_out", Image::Samples),
    ]],
    traces: false,
};
