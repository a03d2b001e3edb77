//! Images to and from the GPU.

use super::gpu::Gpu;
use super::statistics::Rgb;
use wgpu::{Extent3d, TexelCopyBufferLayout, TextureFormat, TextureUsages, TextureView};

/// Uploads an image of floats with `N` channels, to read in shaders.
pub fn upload<const N: usize>(gpu: &Gpu, size: [u32; 2], texels: &[[f32; N]]) -> TextureView {
    let format = [TextureFormat::R32Float, TextureFormat::Rg32Float, TextureFormat::Rgba32Float][N.min(3) - 1];
    let channels = if N == 3 { 4 } else { N };
    let bytes: Vec<u8> = texels
        .iter()
        .flat_map(|t| (0..channels).flat_map(|c| t.get(c).copied().unwrap_or(1.0).to_le_bytes()))
        .collect();
    upload_bytes(gpu, size, format, &bytes)
}

/// Uploads an image of any format, to read in shaders.
pub fn upload_bytes(gpu: &Gpu, size: [u32; 2], format: TextureFormat, bytes: &[u8]) -> TextureView {
    let texture = gpu.texture(size, format, TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST);
    let bytes_per_row = Some(size[0] * format.block_copy_size(None).unwrap());
    gpu.queue.write_texture(
        texture.as_image_copy(),
        bytes,
        TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None },
        Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
    );
    texture.create_view(&Default::default())
}

/// The content of an rgba32float target.
pub fn colors(gpu: &Gpu, view: &TextureView) -> Vec<Rgb> {
    let float = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    let texel = |t: &[u8]| [float(&t[0..4]), float(&t[4..8]), float(&t[8..12])];
    gpu.read(view.texture()).chunks_exact(16).map(texel).collect()
}
