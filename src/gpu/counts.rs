//! Counts of input that had to be cleaned.

use super::readback::Mailbox;
use wgpu::{Buffer, BufferDescriptor, BufferUsages, CommandEncoder, Device};

/// Numbers of pixels of a host's frame that had to be cleaned before they could reach the history. All of them should be zero,
/// except that a clean frame may have outliers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct InputCounts {
    /// `Surfaces::index`.
    pub frame: u32,
    /// Pixels with a positive, finite depth whose normal is zero or not finite (treated as a miss), or whose motion or previous depth
    /// is not finite (treated as new).
    pub surfaces: u32,
    /// Pixels with a channel of radiance, albedo or emission that is infinite or not a number. Radiance that is not a number is no sample,
    /// infinite radiance becomes 65504, and such an albedo becomes 1.
    pub non_finite: u32,
    /// Pixels with a negative channel of the same; the channel became 0.
    pub negative: u32,
    /// Strata with a pair that is infinite or not a number; the pair was left out.
    pub pairs: u32,
    /// Pixels whose sample was above the limit of outliers, see [`FilterSettings::outlier_limit`](crate::FilterSettings::outlier_limit).
    pub outliers: u32,
}

/// Bytes of `Counts` in counts.wgsl.
const SIZE: u64 = 20;

#[derive(Debug, Default)]
pub(crate) struct Counters(Mailbox<InputCounts>);

impl Counters {
    /// Makes the counters of one frame. They are zero, like every new buffer in WebGPU.
    pub fn begin(device: &Device) -> Buffer {
        device.create_buffer(&BufferDescriptor {
            label: Some("asvgf counts"),
            size: SIZE,
            usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        })
    }

    pub fn end(&self, device: &Device, encoder: &mut CommandEncoder, counts: &Buffer, frame: u32) {
        self.0.fetch(device, encoder, counts, "asvgf counts readback", move |bytes| {
            let word = |i: usize| bytemuck::pod_read_unaligned(&bytes[4 * i..4 * i + 4]);
            let [surfaces, non_finite, negative, pairs, outliers] = [0, 1, 2, 3, 4].map(word);
            InputCounts { frame, surfaces, non_finite, negative, pairs, outliers }
        });
    }

    pub fn take(&self) -> Option<InputCounts> {
        self.0.take()
    }
}
