//! A material's use of an image, as the shaders read it.

use super::places::Place;
use crate::scene::description::{Texture, Wrap};
use bytemuck::{Pod, Zeroable};

/// `TextureUse` of shaders/shared/scene.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct GpuTexture {
    first: u32,
    width: u32,
    height: u32,
    mode: u32,
    row_u: [f32; 4],
    row_v: [f32; 4],
}

/// A material's use of an image, or all zeros without one.
pub(crate) fn texture_use(texture: Option<Texture>, places: &[Place]) -> GpuTexture {
    let Some(t) = texture else { return GpuTexture::default() };
    let wrap = |w: Wrap| match w {
        Wrap::Repeat => 0,
        Wrap::Mirror => 1,
        Wrap::Clamp => 2,
    };
    let Place { first, width, height } = places[t.image];
    let mode =
        wrap(t.wrap[0]) | wrap(t.wrap[1]) << 2 | u32::from(t.nearest) << 4 | u32::from(t.uv_set == 1) << 5 | 1 << 31;
    let row = |r: [f32; 3]| [r[0], r[1], r[2], 0.0];
    GpuTexture { first, width, height, mode, row_u: row(t.transform[0]), row_v: row(t.transform[1]) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twins::layout::{assert_layout, fields};

    #[test]
    fn a_use_of_a_texture_lies_where_the_shaders_read_it() {
        let fields = fields!(GpuTexture: first, width, height, mode, row_u, row_v);
        assert_layout("TextureUse", fields, size_of::<GpuTexture>());
    }
}
