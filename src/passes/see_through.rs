//! The surfaces that are seen through clear glass, see shaders/see_through.wgsl.

use super::prelude::*;

/// It follows rays, but its surfaces are those of `trace`, so it knows the same of both.
pub(crate) static PASS: Pass = Pass {
    name: "see_through",
    source: include_str!("../../shaders/see_through.wgsl"),
    grid: Pixels,
    features: &[
        shared::GEOMETRY,
        &[knows(Specular), knows(Transmission), knows(Clearcoat), knows(EnvironmentLight), knows(Gloss)],
    ],
    bindings: &[&[
        now("visibility", Image::Visibility),
        now("first_guide", Image::Guide).of_first(),
        now("first_motion", Image::Motion).of_first(),
        out("guide_out", Image::Guide),
        out("motion_out", Image::Motion),
        out("seen_out", Image::Seen),
        now("first_object", Image::Object).of_first().with(Instanced),
        out("object_out", Image::Object).with(Instanced),
    ]],
    traces: true,
};
