//! Roughness and specular reflectance of the visible surfaces, see shaders/gloss_surface.wgsl.

use super::prelude::*;

/// Its surfaces are those of `trace`, so it knows the same of them.
pub(crate) static PASS: Pass = Pass {
    name: "gloss_surface",
    source: include_str!("../../shaders/gloss_surface.wgsl"),
    grid: Pixels,
    features: &[&[
        knows(Instanced),
        knows(Textures),
        knows(FoldedImages),
        knows(ShadingNormals),
        knows(NormalMaps),
        knows(VertexColors),
        knows(Specular),
        knows(Transmission),
        knows(Clearcoat),
        knows(Gloss),
        knows(Objects),
    ]],
    bindings: &[&[
        now("visibility", Image::Visibility),
        now("specular_radiance", Image::Radiance).of_specular(),
        out("specular_albedo_out", Image::Albedo).of_specular(),
        now("object", Image::Object).of_first().with(Objects),
        out("gloss_out", Image::Gloss),
    ]],
    traces: false,
};
