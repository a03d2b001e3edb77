//! Glass as panes through which light goes straight.
//!
//! The path tracer does not refract. If a pane were opaque, a lamp behind glass would light nothing. A pane with an opacity lets as much
//! light through as thin clear glass does, straight and without a tint.

use crate::scene::description::{Alpha, Material};

/// Turns transmission into opacity.
///
/// With transmission t, base colour c and reflectance F₀, the part τ = t·(1 − F₀)·c̄ goes through. Here c̄ is the mean of c times the mean
/// of its texture, which is `texture`. The opacity is the rest, 1 − τ. A ray meets the surface with this probability only, so the
/// reflection of a surface that it meets is scaled by 1/(1 − τ). On average it is (1 − t)·(1 − F₀)·c and F₀.
pub(crate) fn thin_pane(material: Material, transmission: f32, texture: f32) -> Material {
    let [r, g, b, opacity] = material.base_color;
    let reflectance = material.specular.iter().sum::<f32>() / 3.0;
    let through = transmission * (1.0 - reflectance) * texture * (r + g + b) / 3.0;
    let covered = 1.0 - through;
    // A pane that reflects nothing and lets everything through is invisible.
    let scale = if covered > 0.0 { 1.0 / covered } else { 0.0 };
    let diffuse = (1.0 - transmission) * (1.0 - reflectance) * scale;
    let [r, g, b] = [r, g, b].map(|channel| (channel * diffuse).min(1.0));
    let opacity = if material.alpha == Alpha::Blend { opacity * covered } else { covered };
    Material {
        base_color: [r, g, b, opacity],
        specular: material.specular.map(|channel| (channel * scale).min(1.0)),
        alpha: Alpha::Blend,
        ..material
    }
}
