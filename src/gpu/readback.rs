//! Results that come back from the GPU when they are ready, without waiting.

use std::sync::{Arc, Mutex};
use wgpu::{Buffer, BufferDescriptor, BufferUsages, CommandEncoder, Device, MapMode};

/// Number of results that wait to be taken. Older ones are dropped, so that a host that never asks does not lose memory.
const KEPT: usize = 256;

/// The results that have arrived, oldest first.
#[derive(Debug)]
pub(crate) struct Mailbox<T>(Arc<Mutex<Vec<T>>>);

impl<T> Default for Mailbox<T> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<T: Send + 'static> Mailbox<T> {
    /// Copies a buffer, maps the copy once the host has submitted, and keeps the result of `read` on its bytes.
    pub fn fetch(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        buffer: &Buffer,
        label: &str,
        read: impl FnOnce(&[u8]) -> T + Send + 'static,
    ) {
        let size = buffer.size();
        let usage = BufferUsages::COPY_DST | BufferUsages::MAP_READ;
        let readable =
            device.create_buffer(&BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false });
        encoder.copy_buffer_to_buffer(buffer, 0, &readable, 0, size);
        let results = Arc::clone(&self.0);
        let mapped = readable.clone();
        encoder.map_buffer_on_submit(&readable, MapMode::Read, 0..size, move |result| {
            if result.is_err() {
                return;
            }
            let Ok(bytes) = mapped.slice(..).get_mapped_range() else { return };
            let value = read(&bytes);
            if let Ok(mut results) = results.lock() {
                if results.len() >= KEPT {
                    results.remove(0);
                }
                results.push(value);
            }
        });
    }

    /// Takes the oldest result.
    pub fn take(&self) -> Option<T> {
        let mut results = self.0.lock().ok()?;
        if results.is_empty() { None } else { Some(results.remove(0)) }
    }
}
