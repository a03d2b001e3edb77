//! A host's depth, normals and motion taken in, see shaders/ingest_surface.wgsl.

use super::prelude::*;

pub(crate) static PASS: Pass = Pass {
    name: "ingest_surface",
    source: include_str!("../../shaders/ingest_surface.wgsl"),
    grid: Pixels,
    features: &[&[
        knows(OctahedralNormals),
        knows(MappedNormals),
        knows(PackedNormals),
        knows(PreviousDepth).unless(HostMotion),
        knows(HostMotion),
        knows(Objects),
        knows(FloatObjects),
        knows(Diagnostics),
    ]],
    bindings: &[&[
        host("depth", HostView::Depth),
        host("normal", HostView::Normal),
        host("motion", HostView::Motion).unless(HostMotion),
        host("previous_depth", HostView::PreviousDepth).with(PreviousDepth),
        host("instance", HostView::Instance).with(Objects),
        out("guide_out", Image::Guide),
        out("motion_out", Image::Motion).unless(HostMotion),
        out("object_out", Image::Object).with(Objects),
    ]],
    traces: false,
};
