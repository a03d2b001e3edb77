//! Blending with the last output, against flicker, see shaders/steady.wgsl.

use super::prelude::*;

/// The plan names the image that holds the filtered colour.
pub(crate) static PASS: Pass = Pass {
    name: "steady",
    source: include_str!("../../shaders/steady.wgsl"),
    grid: Pixels,
    features: &[],
    bindings: &[&[
        now("guide", Image::Guide).at_many_taps(),
        chosen("color").at_many_taps(),
        now("reprojected", Image::Reprojected),
        out("output_out", Image::Output),
    ]],
    traces: false,
};
