//! Textures that are written piece by piece, because images and environments may take hundreds of megabytes.

use wgpu::{
    Device, Extent3d, Origin3d, Queue, TexelCopyBufferLayout, TexelCopyTextureInfo, Texture, TextureAspect,
    TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView, TextureViewDescriptor,
    TextureViewDimension,
};

/// Maximum number of bytes of one write.
pub(crate) const PIECE: usize = 16 << 20;

/// Maximum number of bytes of copies that wait for a submission.
const WAITING: usize = 64 << 20;

/// A texture for texel fetches, and its view.
pub(crate) fn texture(
    device: &Device,
    label: &str,
    format: TextureFormat,
    size: [u32; 3],
    dimension: TextureViewDimension,
) -> (Texture, TextureView) {
    let [width, height, depth_or_array_layers] = size;
    let texture = device.create_texture(&TextureDescriptor {
        label: Some(&format!("asvgf {label}")),
        size: Extent3d { width, height, depth_or_array_layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let view = texture.create_view(&TextureViewDescriptor { dimension: Some(dimension), ..Default::default() });
    (texture, view)
}

/// Writes rows of textures.
pub(crate) struct Writer<'a> {
    queue: &'a Queue,
    waiting: usize,
}

impl<'a> Writer<'a> {
    pub fn new(queue: &'a Queue) -> Self {
        Self { queue, waiting: 0 }
    }

    /// Writes whole rows of a layer, from `first_row` on.
    pub fn rows(&mut self, texture: &Texture, [layer, first_row]: [u32; 2], bytes: &[u8]) {
        let texel = texture.format().block_copy_size(None).expect("a format of one plane");
        let row = texture.width() * texel;
        let height = bytes.len() as u32 / row;
        self.queue.write_texture(
            TexelCopyTextureInfo {
                texture,
                mip_level: 0,
                origin: Origin3d { x: 0, y: first_row, z: layer },
                aspect: TextureAspect::All,
            },
            bytes,
            TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: Some(height) },
            Extent3d { width: texture.width(), height, depth_or_array_layers: 1 },
        );
        // wgpu keeps a copy of all that is written until the next submission has been executed.
        self.waiting += bytes.len();
        if self.waiting >= WAITING {
            self.queue.submit([]);
            self.waiting = 0;
        }
    }
}

/// Bytes of a texture without mip levels.
pub(crate) fn bytes(texture: &Texture) -> u64 {
    let size = texture.size();
    let texels = u64::from(size.width) * u64::from(size.height) * u64::from(size.depth_or_array_layers);
    texels * u64::from(texture.format().block_copy_size(None).unwrap_or_default())
}
