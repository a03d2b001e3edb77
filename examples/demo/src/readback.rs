//! Small results of the GPU, fetched without waiting.

use std::sync::{Arc, Mutex};
use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, COPY_BYTES_PER_ROW_ALIGNMENT, CommandEncoder, Device, MapMode,
    TexelCopyBufferInfo, TexelCopyBufferLayout, Texture,
};

/// Where results arrive, oldest first.
pub struct Readback<T>(Arc<Mutex<Vec<T>>>);

impl<T> Default for Readback<T> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<T: Send + 'static> Readback<T> {
    /// Copies a buffer once what was recorded is submitted, and keeps what `read` makes of the bytes.
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

    /// Likewise of a texture: its texels row by row, without padding.
    pub fn fetch_texture(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        texture: &Texture,
        read: impl FnOnce(&[u8]) -> T + Send + 'static,
    ) {
        let row = texture.width() * texture.format().block_copy_size(None).unwrap_or(0);
        let padded = row.next_multiple_of(COPY_BYTES_PER_ROW_ALIGNMENT);
        let copy = Self::readable(device, u64::from(padded) * u64::from(texture.height()));
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None };
        let destination = TexelCopyBufferInfo { buffer: &copy, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), destination, texture.size());
        self.map(encoder, copy, move |bytes| {
            let texels: Vec<u8> = bytes.chunks(padded as usize).flat_map(|r| &r[..row as usize]).copied().collect();
            read(&texels)
        });
    }

    /// Maps a buffer that something was copied to.
    pub fn map(&self, encoder: &mut CommandEncoder, copy: Buffer, read: impl FnOnce(&[u8]) -> T + Send + 'static) {
        let arrived = Arc::clone(&self.0);
        let mapped = copy.clone();
        encoder.map_buffer_on_submit(&copy, MapMode::Read, .., move |result| {
            // A device that was lost is reported by its own callback.
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

    /// A buffer to copy to.
    pub fn readable(device: &Device, size: u64) -> Buffer {
        let usage = BufferUsages::COPY_DST | BufferUsages::MAP_READ;
        device.create_buffer(&BufferDescriptor { label: Some("demo readback"), size, usage, mapped_at_creation: false })
    }

    /// What has arrived since the last call.
    pub fn take(&self) -> Vec<T> {
        self.0.lock().map(|mut arrived| std::mem::take(&mut *arrived)).unwrap_or_default()
    }
}
