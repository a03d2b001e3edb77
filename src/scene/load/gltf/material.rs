//! Metallic-roughness materials.

use gltf::json::Material as MaterialSource;
use gltf::json::material::AlphaMode;
use gltf::json::validation::Checked;

use super::clearcoat;
use super::glossiness;
use super::image::Images;
use super::normal_map;
use super::source::Source;
use super::transmission;
use crate::scene::description::{Alpha, Interior, Material, Scene};
use crate::scene::load::common::report::Report;

/// Index of refraction of the dielectrics of glTF 2.0, unless KHR_materials_ior gives another.
const IOR: f32 = 1.5;

/// Reads all materials, which keep their indices, and the images that they use.
pub(super) fn read_all(source: &Source<'_>, report: &mut Report, scene: &mut Scene) {
    let mut images = Images::new(source);
    for (index, material) in source.root.materials.iter().enumerate() {
        scene.materials.push(read(material, &format!("materials[{index}]"), &mut images, report));
    }
    images.check_unused(report);
    scene.images = images.images;
}

/// The material of a primitive without one.
pub(super) fn default_material() -> Material {
    let specular = [reflectance(IOR); 3];
    Material { name: "default".into(), metallic: 1.0, roughness: 1.0, specular, ..Material::default() }
}

/// Fresnel's reflectance at normal incidence between air and a dielectric: ((n − 1) / (n + 1))².
fn reflectance(ior: f32) -> f32 {
    let ior = f64::from(ior);
    ((ior - 1.0) / (ior + 1.0)).powi(2) as f32
}

fn read(source: &MaterialSource, element: &str, images: &mut Images, report: &mut Report) -> Material {
    let extensions = source.extensions.as_ref();
    if source.occlusion_texture.is_some() {
        report.warn_once(element, "occlusion maps are not read; the path tracer finds occlusion itself");
    }
    let normals = source.normal_texture.as_ref();
    let (normal_texture, normal_scale) = normal_map::read(normals, &format!("{element}.normalTexture"), images, report);
    let emissive_texture = images.texture(&source.emissive_texture, &format!("{element}.emissiveTexture"), report);
    let (factor, mut strength) = emission(source);
    if strength.is_nan() || strength < 0.0 {
        let user = format!("{element}.KHR_materials_emissive_strength.emissiveStrength");
        report.warn(user, format!("{strength} is not at least 0; 0 is used"));
        strength = 0.0;
    }
    let emissive = factor.map(|factor| factor * strength);
    let common = Material {
        name: source.name.clone().unwrap_or_default(),
        emissive: report.clamp_radiance(emissive, || format!("{element}.emissiveFactor")),
        emissive_texture,
        normal_texture,
        normal_scale,
        alpha: alpha(source, element, report),
        double_sided: source.double_sided,
        unlit: extensions.is_some_and(|extensions| extensions.unlit.is_some()),
        ..Material::default()
    };
    let material = match extensions.and_then(|extensions| extensions.pbr_specular_glossiness.as_ref()) {
        Some(extension) => {
            if extensions.is_some_and(|extensions| extensions.transmission.is_some()) {
                let reason = "is not read beside KHR_materials_pbrSpecularGlossiness; the surface is opaque";
                report.warn(format!("{element}.KHR_materials_transmission"), reason);
            }
            glossiness::read(extension, common, element, images, report)
        }
        None => {
            let material = metallic_roughness(source, common, element, images, report);
            let index = ior(source).unwrap_or(IOR).clamp(1.0, Interior::MOST_INDEX);
            transmission::apply(source, material, index, element, images, report)
        }
    };
    clearcoat::apply(source, material, element, images, report)
}

/// Colour and strength of the emission.
pub(super) fn emission(source: &MaterialSource) -> ([f32; 3], f32) {
    let extension = source.extensions.as_ref().and_then(|extensions| extensions.emissive_strength.as_ref());
    (source.emissive_factor.0, extension.map_or(1.0, |extension| extension.emissive_strength.0))
}

fn metallic_roughness(
    source: &MaterialSource,
    common: Material,
    element: &str,
    images: &mut Images,
    report: &mut Report,
) -> Material {
    let pbr = &source.pbr_metallic_roughness;
    let user = |name: &str| format!("{element}.pbrMetallicRoughness.{name}");
    let material = Material {
        base_color: pbr.base_color_factor.0.map(|factor| report.clamp_unit(factor, || user("baseColorFactor"))),
        base_color_texture: images.texture(&pbr.base_color_texture, &user("baseColorTexture"), report),
        metallic: report.clamp_unit(pbr.metallic_factor.0, || user("metallicFactor")),
        roughness: report.clamp_unit(pbr.roughness_factor.0, || user("roughnessFactor")),
        metallic_roughness_texture: images.texture(
            &pbr.metallic_roughness_texture,
            &user("metallicRoughnessTexture"),
            report,
        ),
        ..common
    };
    specular(source, material, element, images, report)
}

/// The index of refraction, where 0 stands for infinity; as an error, one that is not read.
fn ior(source: &MaterialSource) -> Result<f32, f32> {
    let extension = source.extensions.as_ref().and_then(|extensions| extensions.ior.as_ref());
    match extension.map_or(IOR, |extension| extension.ior.0) {
        0.0 => Ok(f32::INFINITY),
        ior if ior >= 1.0 && ior.is_finite() => Ok(ior),
        ior => Err(ior),
    }
}

/// The dielectric part, from KHR_materials_ior and KHR_materials_specular:
/// F₀ = min(((n − 1) / (n + 1))² · color, 1) · factor, F₉₀ = factor.
fn specular(
    source: &MaterialSource,
    material: Material,
    element: &str,
    images: &mut Images,
    report: &mut Report,
) -> Material {
    let extensions = source.extensions.as_ref();
    let base = match ior(source) {
        Ok(f32::INFINITY) => 1.0,
        Ok(ior) => reflectance(ior),
        Err(ior) => {
            let reason = format!("{ior} is neither 0 nor finite and at least 1; {IOR} is used");
            report.warn(format!("{element}.KHR_materials_ior.ior"), reason);
            reflectance(IOR)
        }
    };
    let Some(extension) = extensions.and_then(|extensions| extensions.specular.as_ref()) else {
        return Material { specular: [base; 3], ..material };
    };
    let user = |name: &str| format!("{element}.KHR_materials_specular.{name}");
    let factor = report.clamp_unit(extension.specular_factor.0, || user("specularFactor"));
    // Colours above 1 are allowed; the reflectance is not above 1.
    let color = report.clamp_radiance(extension.specular_color_factor.0, || user("specularColorFactor"));
    Material {
        specular: color.map(|channel| (base * channel).min(1.0) * factor),
        specular_edge: factor,
        specular_texture: images.texture(&extension.specular_texture, &user("specularTexture"), report),
        specular_color_texture: images.texture(
            &extension.specular_color_texture,
            &user("specularColorTexture"),
            report,
        ),
        ..material
    }
}

fn alpha(source: &MaterialSource, element: &str, report: &mut Report) -> Alpha {
    match source.alpha_mode {
        Checked::Valid(AlphaMode::Opaque) => Alpha::Opaque,
        Checked::Valid(AlphaMode::Mask) => {
            let cutoff = source.alpha_cutoff.unwrap_or_default().0;
            if !cutoff.is_finite() {
                report.warn(format!("{element}.alphaCutoff"), format!("{cutoff} is not finite; 0.5 is used"));
                return Alpha::Mask(0.5);
            }
            Alpha::Mask(cutoff.max(0.0))
        }
        Checked::Valid(AlphaMode::Blend) => Alpha::Blend,
        Checked::Invalid => {
            let reason = "is none of OPAQUE, MASK and BLEND; OPAQUE is used";
            report.warn(format!("{element}.alphaMode"), reason);
            Alpha::Opaque
        }
    }
}
