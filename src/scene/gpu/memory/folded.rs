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

/// Records the replacement of a texture's rows from `first_row` on, in the order of the encoder's commands.
pub(crate) fn replace(
    device: &Device,
    encoder: &mut CommandEncoder,
    texture: &Texture,
    first_row: u32,
    texels: &[Texel],
) {
    let height = texels.len().div_ceil(WIDTH);
    let mut data = texels.to_vec();
    data.resize(WIDTH * height, Texel::default());
    let staging = filled(device, "asvgf staging", bytemuck::cast_slice(&data), BufferUsages::COPY_SRC);
    encoder.copy_buffer_to_texture(
        TexelCopyBufferInfo {
            buffer: &staging,
            layout: TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some((WIDTH * size_of::<Texel>()) as u32),
                rows_per_image: None,
            },
        },
        TexelCopyTextureInfo {
            texture,
            mip_level: 0,
            origin: Origin3d { x: 0, y: first_row, z: 0 },
            aspect: TextureAspect::All,
        },
        Extent3d { width: WIDTH as u32, height: height as u32, depth_or_array_layers: 1 },
    );
}
