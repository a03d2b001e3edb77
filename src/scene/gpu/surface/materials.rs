//! Materials as shaders/shared/scene.wgsl reads them.

use super::places::Place;
use super::texture_use::{GpuTexture, texture_use};
use crate::scene::description::{Alpha, Material};
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
    pad: u32,
    base_color_texture: GpuTexture,
    metallic_roughness_texture: GpuTexture,
    emissive_texture: GpuTexture,
    specular_texture: GpuTexture,
    specular_color_texture: GpuTexture,
}

/// The materials with the emission of a pose.
pub(crate) fn materials(materials: &[Material], emission: &[[f32; 3]], images: &[Place]) -> Vec<GpuMaterial> {
    let texture = |t| texture_use(t, images);
    materials
        .iter()
        .zip(emission)
        .map(|(m, factor)| GpuMaterial {
            base_color: m.base_color,
            emissive: [0, 1, 2].map(|c| m.emissive[c] * factor[c]),
            flags: u32::from(m.double_sided)
                | u32::from(m.unlit) << 1
                | u32::from(m.culled) << 2
                | u32::from(m.alpha == Alpha::Blend) << 3,
            metallic: m.metallic,
            roughness: m.roughness,
            cutoff: match m.alpha {
                Alpha::Opaque => 0.0,
                Alpha::Mask(cutoff) => cutoff,
                // 0 would skip the test.
                Alpha::Blend => 0.5,
            },
            specular_edge: m.specular_edge,
            specular: m.specular,
            pad: 0,
            base_color_texture: texture(m.base_color_texture),
            metallic_roughness_texture: texture(m.metallic_roughness_texture),
            emissive_texture: texture(m.emissive_texture),
            specular_texture: texture(m.specular_texture),
            specular_color_texture: texture(m.specular_color_texture),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twins::layout::{assert_layout, fields};

    #[test]
    fn a_material_lies_where_the_shaders_read_it() {
        let material = fields!(GpuMaterial: base_color, emissive, flags, metallic, roughness, cutoff,
            specular_edge, specular, base_color_texture, metallic_roughness_texture, emissive_texture,
            specular_texture, specular_color_texture);
        assert_layout("Material", material, size_of::<GpuMaterial>());
    }
}
