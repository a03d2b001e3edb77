//! Buffers that hold what does not change, and what fits a device.

use super::{SceneError, bvh, folded};
use crate::gpu::filled::filled;
use bytemuck::Pod;
use wgpu::{Buffer, BufferUsages, Device};

/// What is folded into a texture may fill as many rows as a texture has, and references number 2²⁷ triangles.
pub(super) fn check_texels(device: &Device, element: &str, texels: usize) -> Result<(), SceneError> {
    let limit = device.limits().max_texture_dimension_2d;
    if texels <= folded::WIDTH * limit as usize && texels / 3 < bvh::LARGEST_FIRST as usize {
        return Ok(());
    }
    let reason = format!(
        "take {texels} texels, a folded texture of the device has {}: use fewer, or raise max_texture_dimension_2d",
        folded::WIDTH * limit as usize
    );
    Err(SceneError { file: "scene".into(), element: element.into(), reason })
}

pub(super) fn check_size(device: &Device, element: &str, bytes: usize) -> Result<(), SceneError> {
    let limits = device.limits();
    let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    if bytes as u64 <= limit {
        return Ok(());
    }
    let reason = format!(
        "take {bytes} bytes, the device's max_storage_buffer_binding_size is {limit}: raise it, or use fewer triangles"
    );
    Err(SceneError { file: "scene".into(), element: element.into(), reason })
}

pub(super) fn buffer(device: &Device, label: &str, contents: &[u8], usage: BufferUsages) -> Buffer {
    filled(device, &format!("asvgf {label}"), contents, usage)
}

/// A storage buffer, of at least the bytes that its binding needs.
pub(super) fn storage<T: Pod>(device: &Device, label: &str, contents: &[T], least: usize) -> Buffer {
    let bytes: &[u8] = bytemuck::cast_slice(contents);
    if bytes.len() >= least {
        buffer(device, label, bytes, BufferUsages::STORAGE)
    } else {
        buffer(device, label, &vec![0; least], BufferUsages::STORAGE)
    }
}
