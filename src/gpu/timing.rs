//! GPU times by timestamps at the passes' boundaries, read back without waiting.

use super::readback::Mailbox;
use wgpu::{
    BufferDescriptor, BufferUsages, CommandEncoder, ComputePassTimestampWrites, Device, QuerySet, QuerySetDescriptor,
    QueryType, Queue,
};

/// Times of one frame's passes on the GPU.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FrameTimes {
    /// `Frame::index`, or `Surfaces::index`.
    pub frame: u32,
    /// Name and milliseconds of each pass, in order, iterations one by one. At most the first 2048 dispatches of a frame.
    pub passes: Vec<(&'static str, f64)>,
}

impl FrameTimes {
    /// Sum over all passes, in milliseconds.
    pub fn total(&self) -> f64 {
        self.passes.iter().map(|(_, ms)| ms).sum()
    }
}

#[derive(Debug)]
pub(crate) struct Timing {
    milliseconds_per_tick: f64,
    done: Mailbox<FrameTimes>,
}

/// Number of passes whose two timestamps fit into one query set.
const MOST_PASSES: usize = wgpu::QUERY_SET_MAX_QUERIES as usize / 2;

/// The queries of one frame.
#[derive(Debug)]
pub(crate) struct FrameQueries {
    set: QuerySet,
    /// Number of passes that the queries have timestamps for.
    room: usize,
    names: Vec<&'static str>,
    frame: u32,
}

impl Timing {
    pub fn new(queue: &Queue) -> Self {
        let milliseconds_per_tick = f64::from(queue.get_timestamp_period()) * 1e-6;
        Self { milliseconds_per_tick, done: Mailbox::default() }
    }

    /// Makes the queries for a frame of up to `passes` passes; passes beyond the capacity of a query set are not timed.
    pub fn begin(&self, device: &Device, frame: u32, passes: usize) -> FrameQueries {
        let set = device.create_query_set(&QuerySetDescriptor {
            label: Some("asvgf timestamps"),
            ty: QueryType::Timestamp,
            count: 2 * passes.min(MOST_PASSES) as u32,
        });
        FrameQueries { set, room: passes.min(MOST_PASSES), names: Vec::new(), frame }
    }

    /// Resolves a frame's queries and maps them once the host has submitted.
    pub fn end(&self, device: &Device, encoder: &mut CommandEncoder, queries: FrameQueries) {
        let count = 2 * queries.names.len() as u32;
        let resolved = device.create_buffer(&BufferDescriptor {
            label: Some("asvgf timestamps"),
            size: 8 * u64::from(count),
            usage: BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        encoder.resolve_query_set(&queries.set, 0..count, &resolved, 0);
        let milliseconds = self.milliseconds_per_tick;
        self.done.fetch(device, encoder, &resolved, "asvgf timestamps readback", move |bytes| {
            let ticks: Vec<u64> =
                bytes.chunks_exact(8).map(|b| u64::from_le_bytes(b.try_into().unwrap_or_default())).collect();
            let times = ticks.chunks_exact(2).map(|t| t[1].saturating_sub(t[0]) as f64 * milliseconds);
            FrameTimes { frame: queries.frame, passes: queries.names.into_iter().zip(times).collect() }
        });
    }

    /// Takes the times of the oldest finished frame.
    pub fn take(&self) -> Option<FrameTimes> {
        self.done.take()
    }
}

impl FrameQueries {
    /// The two timestamps that the next pass writes; `None` if there is no room left.
    pub fn next(&mut self, name: &'static str) -> Option<ComputePassTimestampWrites<'_>> {
        let first = 2 * self.names.len() as u32;
        (self.names.len() < self.room).then(|| {
            self.names.push(name);
            ComputePassTimestampWrites {
                query_set: &self.set,
                beginning_of_pass_write_index: Some(first),
                end_of_pass_write_index: Some(first + 1),
            }
        })
    }
}
