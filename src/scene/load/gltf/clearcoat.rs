//! Clear coats: KHR_materials_clearcoat.

use gltf::json::Material as MaterialSource;
use gltf::json::material::NormalTexture;
use gltf::json::texture::Info;
use serde::Deserialize;

use super::image::Images;
use super::normal_map;
use crate::scene::description::{Clearcoat, Material};
use crate::scene::load::common::report::Report;

const NAME: &str = "KHR_materials_clearcoat";

/// The extension, which the JSON reader does not know.
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Extension {
    clearcoat_factor: f32,
    clearcoat_texture: Option<Info>,
    clearcoat_roughness_factor: f32,
    clearcoat_roughness_texture: Option<Info>,
    clearcoat_normal_texture: Option<NormalTexture>,
}

/// Adds the coat to a material.
pub(super) fn apply(
    source: &MaterialSource,
    material: Material,
    element: &str,
    images: &mut Images<'_>,
    report: &mut Report,
) -> Material {
    let extensions = source.extensions.as_ref();
    let Some(value) = extensions.and_then(|extensions| extensions.others.get(NAME)) else { return material };
    match Extension::deserialize(value) {
        Ok(extension) => {
            let clearcoat = read(&extension, &material, &format!("{element}.{NAME}"), images, report);
            Material { clearcoat, ..material }
        }
        Err(error) => {
            report.warn(format!("{element}.{NAME}"), format!("{error}; the surface has no coat"));
            material
        }
    }
}

fn read(
    extension: &Extension,
    below: &Material,
    element: &str,
    images: &mut Images<'_>,
    report: &mut Report,
) -> Clearcoat {
    let user = |name: &str| format!("{element}.{name}");
    let normals = extension.clearcoat_normal_texture.as_ref();
    let (normal_texture, normal_scale) = normal_map::read(normals, &user("clearcoatNormalTexture"), images, report);
    // A mesh has one set of tangents, which belongs to one set of coordinates.
    let apart = normal_texture.zip(below.normal_texture).is_some_and(|(coat, below)| coat.uv_set != below.uv_set);
    if apart {
        let reason = "uses other coordinates than normalTexture; the coat is drawn without it";
        report.warn(user("clearcoatNormalTexture.texCoord"), reason);
    }
    Clearcoat {
        weight: report.clamp_unit(extension.clearcoat_factor, || user("clearcoatFactor")),
        weight_texture: images.texture(&extension.clearcoat_texture, &user("clearcoatTexture"), report),
        roughness: report.clamp_unit(extension.clearcoat_roughness_factor, || user("clearcoatRoughnessFactor")),
        roughness_texture: images.texture(
            &extension.clearcoat_roughness_texture,
            &user("clearcoatRoughnessTexture"),
            report,
        ),
        normal_texture: normal_texture.filter(|_| !apart),
        normal_scale,
    }
}
