//! A light as the shaders read it.

use bytemuck::{Pod, Zeroable};

/// Light kinds, as in shaders/shared/light.wgsl.
pub(crate) const EMITTER: u32 = 0;
pub(crate) const POINT: u32 = 1;
pub(crate) const DIRECTIONAL: u32 = 2;
pub(crate) const ENVIRONMENT: u32 = 3;

/// `Light` of shaders/shared/scene.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct GpuLight {
    pub kind: u32,
    pub alias: u32,
    pub threshold: f32,
    pub pmf: f32,
    pub position: [f32; 3],
    pub triangle: u32,
    pub axis: [f32; 3],
    pub instance: u32,
    pub intensity: [f32; 3],
    pub range: f32,
    pub spot_scale: f32,
    pub spot_offset: f32,
    /// Of an emitter that is divided: the texel at which the table of its pieces begins, and log₂ of the number of their rows.
    pub pieces: u32,
    pub level: u32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twins::layout::{assert_layout, fields};

    #[test]
    fn a_light_lies_where_the_shaders_read_it() {
        let light = fields!(GpuLight: kind, alias as "alias_index", threshold, pmf, position, triangle, axis, instance,
            intensity, range, spot_scale, spot_offset, pieces, level);
        assert_layout("Light", light, size_of::<GpuLight>());
    }
}
