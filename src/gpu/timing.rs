//! GPU times by timestamps at the passes' boundaries, read back without waiting.

use std::sync::{Arc, Mutex};
use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoder, ComputePassTimestampWrites, Device, MapMode, QuerySet,
    QuerySetDescriptor, QueryType, Queue,
};

/// Times of one frame's passes on the GPU.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FrameTimes {
    /// `Frame::index`.
    pub frame: u32,
    /// Name of each pass and its milliseconds, in order; iterations one by one.
    pub passes: Vec<(&'static str, f64)>,
}

impl FrameTimes {
    /// Sum over all passes, in milliseconds.
    pub fn total(&self) -> f64 {
        self.passes.iter().map(|(_, ms)| ms).sum()
    }
}

/// Frames whose times wait to be taken; older ones are dropped, so that a host that never asks loses no memory.
const KEPT: usize = 256;

#[derive(Debug)]
pub(crate) struct Timing {
    milliseconds_per_tick: f64,
    done: Arc<Mutex<Vec<FrameTimes>>>,
}

/// The queries of one frame.
pub(crate) struct FrameQueries {
    set: QuerySet,
    names: Vec<&'static str>,
    frame: u32,
}

impl Timing {
    pub fn new(queue: &Queue) -> Self {
        let milliseconds_per_tick = f64::from(queue.get_timestamp_period()) * 1e-6;
        Self { milliseconds_per_tick, done: Arc::default() }
    }

    /// Queries for a frame of `passes` passes.
    pub fn begin(&self, device: &Device, frame: u32, passes: usize) -> FrameQueries {
        let set = device.create_query_set(&QuerySetDescriptor {
            label: Some("asvgf timestamps"),
            ty: QueryType::Timestamp,
            count: 2 * passes as u32,
        });
        FrameQueries { set, names: Vec::new(), frame }
    }

    /// Resolves a frame's queries and maps them once the host has submitted.
    pub fn end(&self, device: &Device, encoder: &mut CommandEncoder, queries: FrameQueries) {
        let size = 16 * queries.names.len() as u64;
        let buffer = |label, usage| -> Buffer {
            device.create_buffer(&BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        let resolved = buffer("asvgf timestamps", BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC);
        let readable = buffer("asvgf timestamps readback", BufferUsages::COPY_DST | BufferUsages::MAP_READ);
        encoder.resolve_query_set(&queries.set, 0..2 * queries.names.len() as u32, &resolved, 0);
        encoder.copy_buffer_to_buffer(&resolved, 0, &readable, 0, size);
        let milliseconds = self.milliseconds_per_tick;
        let done = Arc::clone(&self.done);
        let mapped = readable.clone();
        encoder.map_buffer_on_submit(&readable, MapMode::Read, 0..size, move |result| {
            if result.is_err() {
                return;
            }
            let Ok(bytes) = mapped.slice(..).get_mapped_range() else { return };
            let ticks: Vec<u64> =
                bytes.chunks_exact(8).map(|b| u64::from_le_bytes(b.try_into().unwrap_or_default())).collect();
            let passes = queries
                .names
                .iter()
                .zip(ticks.chunks_exact(2))
                .map(|(name, t)| (*name, t[1].saturating_sub(t[0]) as f64 * milliseconds))
                .collect();
            if let Ok(mut done) = done.lock() {
                if done.len() >= KEPT {
                    done.remove(0);
                }
                done.push(FrameTimes { frame: queries.frame, passes });
            }
        });
    }

    /// Times of the oldest frame that is done and was not taken yet.
    pub fn take(&self) -> Option<FrameTimes> {
        let mut done = self.done.lock().ok()?;
        if done.is_empty() { None } else { Some(done.remove(0)) }
    }
}

impl FrameQueries {
    /// Where the next pass writes its two timestamps.
    pub fn next(&mut self, name: &'static str) -> ComputePassTimestampWrites<'_> {
        let first = 2 * self.names.len() as u32;
        self.names.push(name);
        ComputePassTimestampWrites {
            query_set: &self.set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        }
    }
}
