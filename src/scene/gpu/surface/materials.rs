//! Materials as shaders/shared/scene.wgsl reads them.

use super::places::Place;
use super::texture_use::{GpuTexture, texture_use};
use crate::scene::description::{Alpha, Clearcoat, Interior, Material};
use crate::scene::gpu::memory::folded::{Texel, texels};
use bytemuck::{Pod, Zeroable};

/// `Material` of scene.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct GpuMaterial {
    base_color: [f32; 4],
    emissive: [f32; 3],
    flags: u32,
    metallic: f32,
    roughness: f32,
    cutoff: f32,
    specular_edge: f32,
    specular: [f32; 3],
    extension: u32,
    base_color_texture: GpuTexture,
    metallic_roughness_texture: GpuTexture,
    emissive_texture: GpuTexture,
    specular_texture: GpuTexture,
    specular_color_texture: GpuTexture,
}

/// `NormalMap` of scene.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct GpuNormalMap {
    texture: GpuTexture,
    scale: f32,
    pad: [u32; 3],
}

/// `Glass` of scene.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct GpuGlass {
    texture: GpuTexture,
    absorption: [f32; 3],
    transmission: f32,
    index: f32,
    solid: u32,
    pad: [u32; 2],
}

/// `Coat` of scene.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct GpuCoat {
    weight_texture: GpuTexture,
    roughness_texture: GpuTexture,
    normal_texture: GpuTexture,
    weight: f32,
    roughness: f32,
    normal_scale: f32,
    pad: u32,
}

/// Bit of `flags` of a material whose extension has a normal map.
const NORMAL_MAP: u32 = 1 << 4;

/// Bit of `flags` of a material whose extension has a glass.
const GLASS: u32 = 1 << 5;

/// Bit of `flags` of a material whose extension has a clear coat.
const COATED: u32 = 1 << 6;

/// Least index of refraction. At 1 the normal of a facet that refracts is not defined; here light bends by a thousandth.
const LEAST_INDEX: f32 = 1.001;

/// Greatest absorption per unit of length. Its products with the longest ray stay finite.
const MOST_ABSORPTION: f32 = 1e6;

/// Greatest scale of a normal map. Beyond, all normals lie in the surface, and their squares may be infinite.
const MOST_SCALE: f32 = 1e6;

/// The materials with the emission of a pose, and after them the extensions of those that have one. A scene whose materials are plain
/// has no extensions.
pub(crate) fn materials(materials: &[Material], emission: &[[f32; 3]], images: &[Place]) -> Vec<Texel> {
    let mut extensions: Vec<Texel> = Vec::new();
    let first = materials.len() * size_of::<GpuMaterial>() / size_of::<Texel>();
    let mut records: Vec<GpuMaterial> = Vec::with_capacity(materials.len());
    for (m, &factor) in materials.iter().zip(emission) {
        let mut record = plain(m, factor, images);
        record.extension = (first + extensions.len()) as u32;
        if m.normal_texture.is_some() {
            record.flags |= NORMAL_MAP;
            extensions.extend_from_slice(texels(&[normal_map(m, images)]));
        }
        if m.transmits() {
            record.flags |= GLASS;
            extensions.extend_from_slice(texels(&[glass(m, images)]));
        }
        if m.is_coated() {
            record.flags |= COATED;
            extensions.extend_from_slice(texels(&[coat(&m.clearcoat, images)]));
        }
        records.push(record);
    }
    let mut all = texels(&records).to_vec();
    all.append(&mut extensions);
    all
}

fn normal_map(material: &Material, images: &[Place]) -> GpuNormalMap {
    let scale = bounded(material.normal_scale);
    GpuNormalMap { texture: texture_use(material.normal_texture, images), scale, pad: [0; 3] }
}

fn bounded(scale: f32) -> f32 {
    scale.clamp(-MOST_SCALE, MOST_SCALE)
}

fn coat(coat: &Clearcoat, images: &[Place]) -> GpuCoat {
    GpuCoat {
        weight_texture: texture_use(coat.weight_texture, images),
        roughness_texture: texture_use(coat.roughness_texture, images),
        normal_texture: texture_use(coat.normal_texture, images),
        weight: coat.weight,
        roughness: coat.roughness,
        normal_scale: bounded(coat.normal_scale),
        pad: 0,
    }
}

fn glass(material: &Material, images: &[Place]) -> GpuGlass {
    let Interior { index, absorption } = material.interior;
    GpuGlass {
        texture: texture_use(material.transmission_texture, images),
        absorption: absorption.unwrap_or_default().map(|channel| channel.min(MOST_ABSORPTION)),
        transmission: material.transmission,
        index: index.max(LEAST_INDEX),
        solid: absorption.is_some().into(),
        pad: [0; 2],
    }
}

/// A material without its extension.
fn plain(m: &Material, emission: [f32; 3], images: &[Place]) -> GpuMaterial {
    let texture = |t| texture_use(t, images);
    GpuMaterial {
        base_color: m.base_color,
        emissive: [0, 1, 2].map(|c| m.emissive[c] * emission[c]),
        flags: u32::from(m.double_sided)
            | u32::from(m.unlit) << 1
            | u32::from(m.culled) << 2
            | u32::from(m.is_blended()) << 3,
        metallic: m.metallic,
        roughness: m.roughness,
        cutoff: match m.alpha {
            Alpha::Opaque => 0.0,
            Alpha::Mask(cutoff) => cutoff,
            // 0 skips the test.
            Alpha::Blend => {
                if m.is_blended() {
                    0.5
                } else {
                    0.0
                }
            }
        },
        specular_edge: m.specular_edge,
        specular: m.specular,
        extension: 0,
        base_color_texture: texture(m.base_color_texture),
        metallic_roughness_texture: texture(m.metallic_roughness_texture),
        emissive_texture: texture(m.emissive_texture),
        specular_texture: texture(m.specular_texture),
        specular_color_texture: texture(m.specular_color_texture),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Feature;
    use crate::scene::description::Texture;
    use crate::twins::layout::{assert_layout_with, fields};

    #[test]
    fn a_material_lies_where_the_shaders_read_it() {
        let material = fields!(GpuMaterial: base_color, emissive, flags, metallic, roughness, cutoff,
            specular_edge, specular, extension, base_color_texture, metallic_roughness_texture, emissive_texture,
            specular_texture, specular_color_texture);
        let features = [Feature::NormalMaps, Feature::ShadingNormals];
        assert_layout_with(&features, "Material", material, size_of::<GpuMaterial>());
        let map = fields!(GpuNormalMap: texture, scale);
        assert_layout_with(&features, "NormalMap", map, size_of::<GpuNormalMap>());
        let glass = fields!(GpuGlass: texture, absorption, transmission, index, solid);
        assert_layout_with(&[Feature::Transmission, Feature::Specular], "Glass", glass, size_of::<GpuGlass>());
        let coat = fields!(GpuCoat: weight_texture, roughness_texture, normal_texture, weight, roughness, normal_scale);
        assert_layout_with(&[Feature::Clearcoat, Feature::Specular], "Coat", coat, size_of::<GpuCoat>());
    }

    #[test]
    fn extensions_follow_the_materials_that_have_one() {
        let place = Place { first: 7, width: 4, height: 2 };
        let mapped = Material { normal_texture: Some(Texture::new(0)), normal_scale: 0.5, ..Material::default() };
        let emission = [[1.0; 3]; 3];
        let record = size_of::<GpuMaterial>() / size_of::<Texel>();
        let all = materials(&[Material::default(), mapped.clone(), mapped], &emission, &[place]);
        assert_eq!(all.len(), 3 * record + 2 * 4);
        let extension = |material: usize| all[material * record + 3][3] as usize;
        assert_eq!([1, 2].map(extension), [3 * record, 3 * record + 4]);
        assert_eq!(all[extension(2)], [7, 4, 2, 1 << 31]);
        assert_eq!(f32::from_bits(all[extension(2) + 3][0]), 0.5);
        // Plain materials take no more than their records.
        assert_eq!(materials(&[Material::default(), Material::default()], &emission[..2], &[]).len(), 2 * record);
    }
}
