//! Glass as panes that light goes straight through.
//!
//! The path tracer does not refract. An opaque pane would hide what it protects: a lamp behind glass would light nothing. A pane
//! that covers a part of what lies behind it sends as much light on as thin clear glass does, straight and without a tint.

use crate::scene::description::{Alpha, Material};

/// Makes a material that transmits one that covers.
///
/// With transmission t, base colour c and reflectance F₀ the part τ = t·(1 − F₀)·c̄ goes through, where c̄ is the mean of c and of its
/// texture, whose own mean is `texture`. The rest
/// 1 − τ is the opacity. Where a ray meets the surface, it is more often diffuse or specular by 1/(1 − τ), so that on average it
/// reflects (1 − t)·(1 − F₀)·c and F₀.
pub(crate) fn thin_pane(material: Material, transmission: f32, texture: f32) -> Material {
    let [r, g, b, opacity] = material.base_color;
    let reflectance = material.specular.iter().sum::<f32>() / 3.0;
    let through = transmission * (1.0 - reflectance) * texture * (r + g + b) / 3.0;
    let covered = 1.0 - through;
    // A pane that reflects nothing and lets everything through is not there.
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
