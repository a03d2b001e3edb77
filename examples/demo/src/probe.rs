//! The value under the pointer: one texel, fetched without waiting.

use crate::means::floats;
use crate::readback::Readback;
use wgpu::{CommandEncoder, Device, Extent3d, Origin3d, TexelCopyBufferInfo, TexelCopyTextureInfo, TextureView};

/// A texel of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    pub pixel: [u32; 2],
    pub value: [f32; 3],
}

/// Asks for texels and keeps the last one that arrived.
#[derive(Default)]
pub struct Probe {
    arrived: Readback<Sample>,
    last: Option<Sample>,
}

impl Probe {
    /// Records the copy of a texel of an rgba32float image.
    pub fn record(&self, device: &Device, encoder: &mut CommandEncoder, image: &TextureView, pixel: [u32; 2]) {
        let buffer = Readback::<Sample>::readable(device, 16);
        let [x, y] = pixel;
        encoder.copy_texture_to_buffer(
            TexelCopyTextureInfo { origin: Origin3d { x, y, z: 0 }, ..image.texture().as_image_copy() },
            TexelCopyBufferInfo { buffer: &buffer, layout: Default::default() },
            Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
        );
        self.arrived.map(encoder, buffer, move |bytes| {
            let texel = floats(bytes);
            Sample { pixel, value: [texel[0], texel[1], texel[2]] }
        });
    }

    /// The last texel that arrived.
    pub fn last(&mut self) -> Option<Sample> {
        self.last = self.arrived.take().pop().or(self.last);
        self.last
    }
}
