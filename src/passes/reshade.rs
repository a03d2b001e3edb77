//! The surfaces whose paths a host has to repeat, see shaders/reshade.wgsl.

use super::prelude::*;

pub(crate) static PASS: Pass = Pass {
    name: "reshade",
    source: include_str!("../../shaders/reshade.wgsl"),
    grid: Strata,
    features: &[&[knows(PreviousDepth)]],
    bindings: &[&[
        now("samples", Image::Samples),
        before("guide_previous", Image::Guide),
        host("motion", HostView::Motion),
        host("previous_depth", HostView::PreviousDepth).with(PreviousDepth),
        out("repeats_out", Image::Repeats),
        out("shifts_out", Image::Shifts),
    ]],
    traces: false,
};
