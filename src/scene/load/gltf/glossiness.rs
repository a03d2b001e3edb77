//! Specular-glossiness materials (KHR_materials_pbrSpecularGlossiness) of older files.
//!
//! The model of the extension is Lambert + GGX too: diffuse colour c · (1 − max(s)), F₀ = s, roughness 1 − glossiness. All of these are
//! fields of [`Material`]. Only the roughness texture has to be made, from the glossiness.

use gltf::json::extensions::material::PbrSpecularGlossiness;

use super::image::Images;
use crate::scene::description::{Image, Material, Texture};
use crate::scene::load::common::report::Report;

/// Reads the extension. `common` is the rest of the material.
pub(super) fn read(
    source: &PbrSpecularGlossiness,
    common: Material,
    element: &str,
    images: &mut Images,
    report: &mut Report,
) -> Material {
    let user = |name: &str| format!("{element}.KHR_materials_pbrSpecularGlossiness.{name}");
    let mut color = source.diffuse_factor.0.map(|factor| report.clamp_unit(factor, || user("diffuseFactor")));
    let specular = source.specular_factor.0.map(|factor| report.clamp_unit(factor, || user("specularFactor")));
    let glossiness = report.clamp_unit(source.glossiness_factor.0, || user("glossinessFactor"));
    let texture = images.texture(&source.specular_glossiness_texture, &user("specularGlossinessTexture"), report);
    let strongest = specular.iter().copied().fold(0.0, f32::max);
    if texture.is_none() {
        color[..3].iter_mut().for_each(|channel| *channel *= 1.0 - strongest);
    }
    let roughness = texture.and_then(|texture| {
        let image = roughness(images.images.get(texture.image)?, glossiness);
        images.images.push(image);
        Some(Texture { image: images.images.len() - 1, ..texture })
    });
    Material {
        base_color: color,
        base_color_texture: images.texture(&source.diffuse_texture, &user("diffuseTexture"), report),
        metallic: 0.0,
        roughness: if roughness.is_some() { 1.0 } else { 1.0 - glossiness },
        metallic_roughness_texture: roughness,
        specular,
        specular_color_texture: texture,
        ..common
    }
}

/// Roughness in the green channel, from the glossiness in the alpha channel.
fn roughness(source: &Image, factor: f32) -> Image {
    let texel = |&[_, _, _, glossiness]: &[u8; 4]| {
        let roughness = 255.0 - factor * f32::from(glossiness);
        [0, roughness.round() as u8, 255, 255]
    };
    Image { name: format!("{} (roughness)", source.name), texels: source.texels.iter().map(texel).collect(), ..*source }
}
