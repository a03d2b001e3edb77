//! Small results of the GPU, fetched without waiting.

use std::ops::Range;
use std::sync::{Arc, Mutex};
use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, COPY_BYTES_PER_ROW_ALIGNMENT, CommandEncoder, Device, Extent3d, MapMode,
    Origin3d, TexelCopyBufferInfo, TexelCopyBufferLayout, TexelCopyTextureInfo, Texture,
};

/// Results that have arrived, oldest first.
pub struct Readback<T>(Arc<Mutex<Vec<T>>>);

impl<T> Default for Readback<T> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<T: Send + 'static> Readback<T> {
    /// Records the copy of a buffer, and keeps the result of `read` on its bytes after the submission.
    pub fn fetch(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        buffer: &Buffer,
        read: impl FnOnce(&[u8]) -> T + Send + 'static,
    ) {
        let copy = Self::readable(device, buffer.size());
        encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, buffer.size());
        self.map(encoder, copy, read);
    }

    /// Does the same for a texture: its texels row by row, without padding.
    pub fn fetch_texture(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        texture: &Texture,
        read: impl FnOnce(&[u8]) -> T + Send + 'static,
    ) {
        self.fetch_columns(device, encoder, texture.size(), &[(texture.clone(), 0..texture.width())], read);
    }

    /// Does the same for columns of several textures of one format and size, which become one image.
    pub fn fetch_columns(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        size: Extent3d,
        parts: &[(Texture, Range<u32>)],
        read: impl FnOnce(&[u8]) -> T + Send + 'static,
    ) {
        let texel = parts.first().and_then(|(texture, _)| texture.format().block_copy_size(None)).unwrap_or(0);
        let row = size.width * texel;
        let padded = row.next_multiple_of(COPY_BYTES_PER_ROW_ALIGNMENT);
        let copy = Self::readable(device, u64::from(padded) * u64::from(size.height));
        for (texture, columns) in parts.iter().filter(|(_, columns)| !columns.is_empty()) {
            let offset = u64::from(columns.start * texel);
            let layout = TexelCopyBufferLayout { offset, bytes_per_row: Some(padded), rows_per_image: None };
            let origin = Origin3d { x: columns.start, y: 0, z: 0 };
            encoder.copy_texture_to_buffer(
                TexelCopyTextureInfo { origin, ..texture.as_image_copy() },
                TexelCopyBufferInfo { buffer: &copy, layout },
                Extent3d { width: columns.len() as u32, ..size },
            );
        }
        self.map(encoder, copy, move |bytes| {
            let texels: Vec<u8> = bytes.chunks(padded as usize).flat_map(|r| &r[..row as usize]).copied().collect();
            read(&texels)
        });
    }

    /// Maps a buffer that a recorded command copies to.
    pub fn map(&self, encoder: &mut CommandEncoder, copy: Buffer, read: impl FnOnce(&[u8]) -> T + Send + 'static) {
        let arrived = Arc::clone(&self.0);
        let mapped = copy.clone();
        encoder.map_buffer_on_submit(&copy, MapMode::Read, .., move |result| {
            // The callback of a lost device reports the loss.
            if result.is_err() {
                return;
            }
            let Ok(bytes) = mapped.slice(..).get_mapped_range() else { return };
            let value = read(&bytes);
            if let Ok(mut arrived) = arrived.lock() {
                arrived.push(value);
            }
        });
    }

    /// Makes a buffer to copy to.
    pub fn readable(device: &Device, size: u64) -> Buffer {
        let usage = BufferUsages::COPY_DST | BufferUsages::MAP_READ;
        device.create_buffer(&BufferDescriptor { label: Some("demo readback"), size, usage, mapped_at_creation: false })
    }

    /// Takes the results that have arrived since the last call.
    pub fn take(&self) -> Vec<T> {
        self.0.lock().map(|mut arrived| std::mem::take(&mut *arrived)).unwrap_or_default()
    }
}
