//! Primary rays: triangle, normal, depth and motion of each pixel, see shaders/visibility.wgsl.

use super::prelude::*;

/// Images matter only if they cut holes.
pub(crate) static PASS: Pass = Pass {
    name: "visibility",
    source: include_str!("../../shaders/visibility.wgsl"),
    grid: Pixels,
    features: &[&[
        knows(Instanced),
        knows(Deforming),
        knows(Textures).with(AlphaMask),
        knows(FoldedImages).with(AlphaMask),
        knows(ShadingNormals),
        knows(VertexColors),
        knows(AlphaMask),
        knows(AlphaBlend),
        knows(FewTriangles),
        knows(Objects),
    ]],
    bindings: &[&[
        out("visibility_out", Image::Visibility),
        out("guide_out", Image::Guide).of_first(),
        out("motion_out", Image::Motion).of_first(),
        out("object_out", Image::Object).of_first().with(Objects),
    ]],
    traces: true,
};
