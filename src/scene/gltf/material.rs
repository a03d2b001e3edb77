//! Metallic-roughness materials.

use gltf::json::Material as MaterialSource;
use gltf::json::material::AlphaMode;
use gltf::json::validation::Checked;

use super::image::Images;
use super::source::Source;
use crate::scene::description::{Alpha, Material, Scene};
use crate::scene::load::report::{Fault, Report};

/// Normal-incidence reflectance of the dielectrics of glTF 2.0 (an index of refraction of 1.5).
const SPECULAR: [f32; 3] = [0.04; 3];

/// Opacity below which a blended surface is taken to be absent.
const BLEND_CUTOFF: f32 = 0.5;

/// Reads all materials, which keep their indices, and the images that they use.
pub(super) fn read_all(source: &Source<'_>, report: &mut Report, scene: &mut Scene) -> Result<(), Fault> {
    let mut images = Images::new(source);
    for (index, material) in source.root.materials.iter().enumerate() {
        scene.materials.push(read(material, &format!("materials[{index}]"), &mut images, report)?);
    }
    images.check_unused(report);
    scene.images = images.images;
    Ok(())
}

/// What a primitive without a material looks like.
pub(super) fn default_material() -> Material {
    Material { name: "default".into(), metallic: 1.0, roughness: 1.0, specular: SPECULAR, ..Material::default() }
}

fn read(source: &MaterialSource, element: &str, images: &mut Images, report: &mut Report) -> Result<Material, Fault> {
    let pbr = &source.pbr_metallic_roughness;
    let mut texture = |info: &Option<gltf::json::texture::Info>, name: &str, report: &mut Report| match info {
        Some(info) => images.texture(info, &format!("{element}.{name}"), report),
        None => Ok(None),
    };
    let base_color_texture = texture(&pbr.base_color_texture, "pbrMetallicRoughness.baseColorTexture", report)?;
    let metallic_roughness_texture =
        texture(&pbr.metallic_roughness_texture, "pbrMetallicRoughness.metallicRoughnessTexture", report)?;
    let emissive_texture = texture(&source.emissive_texture, "emissiveTexture", report)?;
    if source.normal_texture.is_some() {
        report.warn_once(element, "normal maps are not read");
    }
    if source.occlusion_texture.is_some() {
        report.warn_once(element, "occlusion maps are not read; the path tracer finds occlusion itself");
    }

    let extensions = source.extensions.as_ref();
    let strength = extensions.and_then(|extensions| extensions.emissive_strength.as_ref());
    let strength = strength.map_or(1.0, |extension| extension.emissive_strength.0);
    let emissive = source.emissive_factor.0.map(|factor| factor * strength);
    let factor = |name: &'static str| move || format!("{element}.pbrMetallicRoughness.{name}");
    Ok(Material {
        name: source.name.clone().unwrap_or_default(),
        base_color: pbr.base_color_factor.0.map(|factor_| report.clamp_unit(factor_, factor("baseColorFactor"))),
        base_color_texture,
        metallic: report.clamp_unit(pbr.metallic_factor.0, factor("metallicFactor")),
        roughness: report.clamp_unit(pbr.roughness_factor.0, factor("roughnessFactor")),
        metallic_roughness_texture,
        emissive: report.clamp_radiance(emissive, || format!("{element}.emissiveFactor")),
        emissive_texture,
        alpha: alpha(source, element, report)?,
        double_sided: source.double_sided,
        unlit: extensions.is_some_and(|extensions| extensions.unlit.is_some()),
        specular: SPECULAR,
        ..Material::default()
    })
}

fn alpha(source: &MaterialSource, element: &str, report: &mut Report) -> Result<Alpha, Fault> {
    match source.alpha_mode {
        Checked::Valid(AlphaMode::Opaque) => Ok(Alpha::Opaque),
        Checked::Valid(AlphaMode::Mask) => {
            let cutoff = source.alpha_cutoff.unwrap_or_default().0;
            Ok(Alpha::Mask(cutoff.clamp(0.0, f32::MAX)))
        }
        Checked::Valid(AlphaMode::Blend) => {
            report.warn(element, format!("alphaMode BLEND is drawn as MASK with a cutoff of {BLEND_CUTOFF}"));
            Ok(Alpha::Mask(BLEND_CUTOFF))
        }
        Checked::Invalid => Err(Fault::new(format!("{element}.alphaMode"), "is none of OPAQUE, MASK and BLEND")),
    }
}
