//! Lists of texels folded into the rows of a texture, because they are too long for one row.

use crate::gpu::filled::filled;
use bytemuck::Pod;
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{
    BufferUsages, CommandEncoder, Device, Extent3d, Origin3d, Queue, TexelCopyBufferInfo, TexelCopyBufferLayout,
    TexelCopyTextureInfo, Texture, TextureAspect, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages,
};

/// Texels per row, as in shaders/shared/scene.wgsl.
pub(crate) const WIDTH: usize = 4096;

/// A texel of four words.
pub(crate) type Texel = [u32; 4];

/// The texels of a slice of whole texels.
pub(crate) fn texels<T: Pod>(values: &[T]) -> &[Texel] {
    bytemuck::cast_slice(values)
}

/// A texture that holds the texels.
pub(crate) fn texture(device: &Device, queue: &Queue, label: &str, texels: &[Texel]) -> Texture {
    let height = texels.len().div_ceil(WIDTH).max(1);
    let mut data = texels.to_vec();
    data.resize(WIDTH * height, Texel::default());
    let descriptor = TextureDescriptor {
        label: Some(&format!("asvgf {label}")),
        size: Extent3d { width: WIDTH as u32, height: height as u32, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: TextureFormat::Rgba32Uint,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    };
    device.create_texture_with_data(queue, &descriptor, TextureDataOrder::LayerMajor, bytemuck::cast_slice(&data))
}

/// Records the replacement of a texture's texels from number `first` on, in the order of the encoder's commands.
pub(crate) fn replace(
    device: &Device,
    encoder: &mut CommandEncoder,
    texture: &Texture,
    first: usize,
    texels: &[Texel],
) {
    let staging = filled(device, "asvgf staging", bytemuck::cast_slice(texels), BufferUsages::COPY_SRC);
    for Rectangle { first: [x, y], size: [width, height] } in rectangles(first, texels.len()) {
        let offset = ((y * WIDTH + x - first) * size_of::<Texel>()) as u64;
        let bytes_per_row = (height > 1).then_some((WIDTH * size_of::<Texel>()) as u32);
        encoder.copy_buffer_to_texture(
            TexelCopyBufferInfo {
                buffer: &staging,
                layout: TexelCopyBufferLayout { offset, bytes_per_row, rows_per_image: None },
            },
            TexelCopyTextureInfo {
                texture,
                mip_level: 0,
                origin: Origin3d { x: x as u32, y: y as u32, z: 0 },
                aspect: TextureAspect::All,
            },
            Extent3d { width: width as u32, height: height as u32, depth_or_array_layers: 1 },
        );
    }
}

/// A rectangle of a folded texture: its first column and row, its width and height.
#[derive(Debug, PartialEq)]
struct Rectangle {
    first: [usize; 2],
    size: [usize; 2],
}

/// The rectangles that hold `count` texels from number `first` on: the end of a row, whole rows, and the beginning of one.
fn rectangles(first: usize, count: usize) -> Vec<Rectangle> {
    let (mut at, end) = (first, first + count);
    let mut rectangles = Vec::new();
    while at < end {
        let (x, y) = (at % WIDTH, at / WIDTH);
        let size = match (x, (end - at) / WIDTH) {
            (0, rows @ 1..) => [WIDTH, rows],
            _ => [(end - at).min(WIDTH - x), 1],
        };
        rectangles.push(Rectangle { first: [x, y], size });
        at += size[0] * size[1];
    }
    rectangles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_of_texels_is_three_rectangles_at_most() {
        let of = |first, count| rectangles(first, count).into_iter().map(|r| (r.first, r.size)).collect::<Vec<_>>();
        assert_eq!(of(5, 0), []);
        assert_eq!(of(5, 3), [([5, 0], [3, 1])]);
        assert_eq!(of(4096, 8192), [([0, 1], [4096, 2])]);
        assert_eq!(of(4095, 2), [([4095, 0], [1, 1]), ([0, 1], [1, 1])]);
        assert_eq!(of(4000, 8193 + 96), [([4000, 0], [96, 1]), ([0, 1], [4096, 2]), ([0, 3], [1, 1])]);
    }
}
