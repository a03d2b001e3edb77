//! Clear coats: KHR_materials_clearcoat.

use gltf::json::Material as MaterialSource;
use gltf::json::material::NormalTexture;
use serde::Deserialize;
use serde_json::Value;

use super::image::Images;
use super::normal_map;
use crate::scene::description::{Clearcoat, Material};
use crate::scene::load::common::report::Report;

const NAME: &str = "KHR_materials_clearcoat";

/// The extension, which the JSON reader does not know. Textures are read one by one, so that a broken one costs itself.
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Extension {
    clearcoat_factor: f32,
    clearcoat_texture: Option<Value>,
    clearcoat_roughness_factor: f32,
    clearcoat_roughness_texture: Option<Value>,
    clearcoat_normal_texture: Option<Value>,
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
    let weights = texture(&extension.clearcoat_texture, &user("clearcoatTexture"), report);
    let roughnesses = texture(&extension.clearcoat_roughness_texture, &user("clearcoatRoughnessTexture"), report);
    let normals: Option<NormalTexture> =
        texture(&extension.clearcoat_normal_texture, &user("clearcoatNormalTexture"), report);
    let (normal_texture, normal_scale) =
        normal_map::read(normals.as_ref(), &user("clearcoatNormalTexture"), images, report);
    // A mesh has one set of tangents, which belongs to one set of coordinates.
    let apart = normal_texture.zip(below.normal_texture).is_some_and(|(coat, below)| coat.uv_set != below.uv_set);
    if apart {
        let reason = "uses other coordinates than normalTexture; the coat is drawn without it";
        report.warn(user("clearcoatNormalTexture.texCoord"), reason);
    }
    Clearcoat {
        weight: report.clamp_unit(extension.clearcoat_factor, || user("clearcoatFactor")),
        weight_texture: images.texture(&weights, &user("clearcoatTexture"), report),
        roughness: report.clamp_unit(extension.clearcoat_roughness_factor, || user("clearcoatRoughnessFactor")),
        roughness_texture: images.texture(&roughnesses, &user("clearcoatRoughnessTexture"), report),
        normal_texture: normal_texture.filter(|_| !apart),
        normal_scale,
    }
}

/// A texture of the extension, or none, with a warning, if it cannot be read.
fn texture<T: for<'a> Deserialize<'a>>(value: &Option<Value>, element: &str, report: &mut Report) -> Option<T> {
    let read = T::deserialize(value.as_ref()?);
    read.map_err(|error| report.warn(element, format!("{error}; the coat is drawn without it"))).ok()
}
