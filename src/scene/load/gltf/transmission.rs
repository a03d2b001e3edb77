//! Glass (KHR_materials_transmission), drawn as thin panes.

use gltf::json::Material as MaterialSource;

use super::image::Images;
use crate::scene::description::{Alpha, Image, Material, Texture};
use crate::scene::load::common::pane::thin_pane;
use crate::scene::load::common::report::Report;
use crate::scene::load::common::srgb::linear_from_srgb;

/// Turns a material that transmits into a thin pane. A texture counts with its mean, because a pane transmits the same everywhere.
pub(super) fn apply(
    source: &MaterialSource,
    material: Material,
    element: &str,
    images: &mut Images<'_>,
    report: &mut Report,
) -> Material {
    let Some(extension) = source.extensions.as_ref().and_then(|extensions| extensions.transmission.as_ref()) else {
        return material;
    };
    let user = format!("{element}.KHR_materials_transmission");
    let factor = report.clamp_unit(extension.transmission_factor.0, || format!("{user}.transmissionFactor"));
    let mean = |texture: Option<Texture>, of: fn([u8; 4]) -> f32| {
        texture.and_then(|texture| images.images.get(texture.image)).map_or(1.0, |image| mean(image, of))
    };
    let metallic =
        material.metallic * mean(material.metallic_roughness_texture, |[_, _, blue, _]| f32::from(blue) / 255.0);
    let transmission = factor * (1.0 - metallic);
    if transmission == 0.0 {
        return material;
    }
    let texture = if extension.transmission_texture.is_some() { ", and its texture is not read" } else { "" };
    report.warn(user, format!("glass is drawn as a thin pane that neither refracts nor tints{texture}"));
    let light = |[r, g, b, _]: [u8; 4]| {
        [r, g, b].map(|byte| linear_from_srgb(f32::from(byte) / 255.0)).iter().sum::<f32>() / 3.0
    };
    let colored = mean(material.base_color_texture, light);
    let base_color_texture = match material.alpha {
        // An opaque material ignores the opacity of its texture, but a pane that blends would not.
        Alpha::Opaque => material.base_color_texture.map(|texture| images.opaque(texture)),
        _ => material.base_color_texture,
    };
    thin_pane(Material { base_color_texture, ..material }, transmission, colored)
}

fn mean(image: &Image, of: impl Fn([u8; 4]) -> f32) -> f32 {
    let sum: f64 = image.texels.iter().map(|&texel| f64::from(of(texel))).sum();
    (sum / image.texels.len().max(1) as f64) as f32
}
