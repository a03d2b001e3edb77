//! Glass (KHR_materials_transmission), drawn as thin panes.

use gltf::json::Material as MaterialSource;

use crate::scene::description::Material;
use crate::scene::load::pane::thin_pane;
use crate::scene::load::report::Report;

/// Makes a material that transmits a thin pane.
pub(super) fn apply(source: &MaterialSource, material: Material, element: &str, report: &mut Report) -> Material {
    let Some(extension) = source.extensions.as_ref().and_then(|extensions| extensions.transmission.as_ref()) else {
        return material;
    };
    let user = format!("{element}.KHR_materials_transmission");
    let factor = report.clamp_unit(extension.transmission_factor.0, || format!("{user}.transmissionFactor"));
    let transmission = factor * (1.0 - material.metallic);
    if transmission == 0.0 {
        return material;
    }
    let texture = if extension.transmission_texture.is_some() { ", and its texture is not read" } else { "" };
    report.warn(user, format!("glass is drawn as a thin pane that neither refracts nor tints{texture}"));
    thin_pane(material, transmission)
}
