//! A host's roughness, specular reflectance, and distances of reflected things taken in, see shaders/ingest_gloss.wgsl.

use super::prelude::*;

/// The albedo matters only where one radiance holds diffuse and specular light.
pub(crate) static PASS: Pass = Pass {
    name: "ingest_gloss",
    source: include_str!("../../shaders/ingest_gloss.wgsl"),
    grid: Pixels,
    features: &[&[
        knows(Roughness),
        knows(RoughnessInAlpha),
        knows(HitDistance),
        knows(Reflectance),
        knows(MixedGloss),
        knows(Albedo).with(MixedGloss).with(Reflectance),
        knows(Objects).unless(MixedGloss),
    ]],
    bindings: &[&[
        now("guide", Image::Guide),
        host("roughness", HostView::Roughness).with(Roughness),
        host("hit_distance", HostView::HitDistance).with(HitDistance),
        host("reflectance", HostView::Reflectance).with(Reflectance),
        host("albedo", HostView::Albedo).with(Albedo),
        now("object", Image::Object).with(Objects),
        out("gloss_out", Image::Gloss),
    ]],
    traces: false,
};
