//! The texels of all images on the GPU: in a buffer, or in the layers of a texture if a storage binding cannot hold them.
//!
//! A texture would suit all scenes, but on an adapter that is the CPU a fetch takes longer than a read of a buffer.

use super::places::{LAYER, ROWS};
use crate::scene::description::Image;
use crate::scene::gpu::memory::buffers::storage;
use crate::scene::gpu::memory::folded;
use crate::scene::gpu::memory::pieces::{self, Writer};
use wgpu::{BindingResource, Buffer, Device, Queue, Texture, TextureFormat, TextureView, TextureViewDimension};

const _: () = assert!(LAYER * size_of::<u32>() <= pieces::PIECE);

/// The images on the GPU.
#[derive(Debug)]
pub(crate) enum Images {
    Buffer(Buffer),
    /// For [`Feature::FoldedImages`](crate::plan::Feature::FoldedImages).
    Texture(Texture, TextureView),
}

impl Images {
    /// Uploads the images into a texture if they are `folded`, else into a buffer.
    pub fn new(device: &Device, queue: &Queue, images: &[Image], folded: bool) -> Self {
        if folded {
            let (texture, view) = texture(device, queue, images);
            return Self::Texture(texture, view);
        }
        let texels: Vec<[u8; 4]> = images.iter().flat_map(|image| &image.texels).copied().collect();
        // Without images the buffer still has one word, because shaders for all kinds of scenes bind it.
        Self::Buffer(storage(device, "images", &texels, size_of::<u32>()))
    }

    pub fn bytes(&self) -> u64 {
        match self {
            Self::Buffer(buffer) => buffer.size(),
            Self::Texture(texture, _) => pieces::bytes(texture),
        }
    }

    pub fn resource(&self) -> BindingResource<'_> {
        match self {
            Self::Buffer(buffer) => buffer.as_entire_binding(),
            Self::Texture(_, view) => BindingResource::TextureView(view),
        }
    }
}

/// A texture that holds the images.
fn texture(device: &Device, queue: &Queue, images: &[Image]) -> (Texture, TextureView) {
    let count: usize = images.iter().map(|image| image.texels.len()).sum();
    let size = [folded::WIDTH, count.div_ceil(folded::WIDTH).min(ROWS), count.div_ceil(LAYER)].map(|size| size as u32);
    let (texture, view) =
        pieces::texture(device, "images", TextureFormat::R32Uint, size, TextureViewDimension::D2Array);
    let mut writer = Writer::new(queue);
    let height = size[1] as usize;
    let mut layer = 0;
    let mut texels: Vec<[u8; 4]> = Vec::with_capacity(folded::WIDTH * height);
    let mut write = |texels: &mut Vec<[u8; 4]>| {
        texels.resize(folded::WIDTH * height, [0; 4]);
        writer.rows(&texture, [layer, 0], bytemuck::cast_slice(texels));
        layer += 1;
        texels.clear();
    };
    for image in images {
        let mut rest = image.texels.as_slice();
        while !rest.is_empty() {
            let (now, later) = rest.split_at(rest.len().min(LAYER - texels.len()));
            texels.extend_from_slice(now);
            rest = later;
            if texels.len() == LAYER {
                write(&mut texels);
            }
        }
    }
    if !texels.is_empty() {
        write(&mut texels);
    }
    (texture, view)
}
