//! Buffers that are filled once.

use crate::gpu::filled::filled;
use bytemuck::Pod;
use wgpu::{Buffer, BufferUsages, Device};

pub(crate) fn buffer(device: &Device, label: &str, contents: &[u8], usage: BufferUsages) -> Buffer {
    filled(device, &format!("asvgf {label}"), contents, usage)
}

/// A storage buffer of at least `least` bytes, as its binding requires.
pub(crate) fn storage<T: Pod>(device: &Device, label: &str, contents: &[T], least: usize) -> Buffer {
    at_least(device, label, contents, least, BufferUsages::STORAGE)
}

/// The same, with contents that may be replaced.
pub(crate) fn replaceable<T: Pod>(device: &Device, label: &str, contents: &[T], least: usize) -> Buffer {
    at_least(device, label, contents, least, BufferUsages::STORAGE | BufferUsages::COPY_DST)
}

fn at_least<T: Pod>(device: &Device, label: &str, contents: &[T], least: usize, usage: BufferUsages) -> Buffer {
    let bytes: &[u8] = bytemuck::cast_slice(contents);
    if bytes.len() >= least {
        buffer(device, label, bytes, usage)
    } else {
        buffer(device, label, &vec![0; least], usage)
    }
}
