//! Buffers with contents from the start.

use wgpu::{Buffer, BufferDescriptor, BufferUsages, COPY_BUFFER_ALIGNMENT, Device};

/// Makes a buffer that holds these bytes, at least one.
///
/// On a device that is lost or out of memory it holds nothing. Its users then fail like everything else there, and the device
/// reports the loss to its host. wgpu's own `create_buffer_init` panics in that case.
pub(crate) fn filled(device: &Device, label: &str, contents: &[u8], usage: BufferUsages) -> Buffer {
    let size = (contents.len() as u64).next_multiple_of(COPY_BUFFER_ALIGNMENT).max(COPY_BUFFER_ALIGNMENT);
    let buffer = device.create_buffer(&BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: true });
    if let Ok(mut mapped) = buffer.get_mapped_range_mut(..) {
        mapped.slice(..contents.len()).copy_from_slice(contents);
    }
    buffer.unmap();
    buffer
}
