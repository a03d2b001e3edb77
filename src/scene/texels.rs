//! The texels of all images: in a buffer, or in the layers of a texture if they are larger than a storage binding.
//!
//! A texture would do for all, but on adapters that are the CPU fetches take longer than reads of a buffer.

use super::buffers::storage;
use super::textures::{self, Writer};
use super::{Image, SceneError, Texture, Wrap, folded};
use bytemuck::{Pod, Zeroable};
use wgpu::{BindingResource, Buffer, Device, Limits, Queue, TextureFormat, TextureView, TextureViewDimension};

/// Rows of a layer, as in shaders/shared/scene.wgsl. A layer is written at once: a layer that is written in part is cleared first.
const ROWS: usize = 1024;

/// Texels of a layer.
const LAYER: usize = folded::WIDTH * ROWS;

const _: () = assert!(LAYER * size_of::<u32>() <= textures::PIECE);

/// Where an image lies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    first: u32,
    width: u32,
    height: u32,
}

/// `TextureUse` of shaders/shared/scene.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(super) struct GpuTexture {
    first: u32,
    width: u32,
    height: u32,
    mode: u32,
    row_u: [f32; 4],
    row_v: [f32; 4],
}

/// Where the images lie, one after the other.
///
/// # Errors
/// The images have more texels than a texture of the device.
pub(super) fn places(device: &Device, images: &[Image]) -> Result<Vec<Place>, SceneError> {
    let count = images.iter().map(|image| image.texels.len() as u64).sum();
    check(count, &device.limits())?;
    let mut next = 0;
    let place = |image: &Image| {
        let first = next;
        next += image.texels.len() as u64;
        Place { first: first as u32, width: image.width, height: image.height }
    };
    Ok(images.iter().map(place).collect())
}

fn check(texels: u64, limits: &Limits) -> Result<(), SceneError> {
    // Texels are numbered with 32 bits.
    let most = (u64::from(limits.max_texture_array_layers) * LAYER as u64).min(1 << 32);
    if texels <= most {
        return Ok(());
    }
    let reason = format!(
        "have {texels} texels together, the {} layers that a texture of the device may have hold {most}: scale images \
         down, or raise max_texture_array_layers",
        limits.max_texture_array_layers
    );
    Err(SceneError { file: "scene".into(), element: "images".into(), reason })
}

/// The images on the GPU.
#[derive(Debug)]
pub(super) enum Images {
    Buffer(Buffer),
    /// [`Feature::FoldedImages`](crate::plan::Feature::FoldedImages).
    Texture(wgpu::Texture, TextureView),
}

impl Images {
    pub fn new(device: &Device, queue: &Queue, images: &[Image]) -> Self {
        let limits = device.limits();
        let largest = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let count: usize = images.iter().map(|image| image.texels.len()).sum();
        if (count * size_of::<u32>()) as u64 <= largest {
            let texels: Vec<[u8; 4]> = images.iter().flat_map(|image| &image.texels).copied().collect();
            // Shaders for all kinds of scenes bind a buffer of a word, where there are no images.
            return Self::Buffer(storage(device, "images", &texels, size_of::<u32>()));
        }
        let (texture, view) = texture(device, queue, images, count);
        Self::Texture(texture, view)
    }

    pub fn are_folded(&self) -> bool {
        matches!(self, Self::Texture(..))
    }

    pub fn bytes(&self) -> u64 {
        match self {
            Self::Buffer(buffer) => buffer.size(),
            Self::Texture(texture, _) => textures::bytes(texture),
        }
    }

    pub fn resource(&self) -> BindingResource<'_> {
        match self {
            Self::Buffer(buffer) => buffer.as_entire_binding(),
            Self::Texture(_, view) => BindingResource::TextureView(view),
        }
    }
}

/// A texture that holds the images, `count` texels together.
fn texture(device: &Device, queue: &Queue, images: &[Image], count: usize) -> (wgpu::Texture, TextureView) {
    let size = [folded::WIDTH, count.div_ceil(folded::WIDTH).min(ROWS), count.div_ceil(LAYER)].map(|size| size as u32);
    let (texture, view) =
        textures::texture(device, "images", TextureFormat::R32Uint, size, TextureViewDimension::D2Array);
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

/// A material's use of an image; all zero where there is none.
pub(super) fn texture_use(texture: Option<Texture>, places: &[Place]) -> GpuTexture {
    let Some(t) = texture else { return GpuTexture::default() };
    let wrap = |w: Wrap| match w {
        Wrap::Repeat => 0,
        Wrap::Mirror => 1,
        Wrap::Clamp => 2,
    };
    let Place { first, width, height } = places[t.image];
    let mode =
        wrap(t.wrap[0]) | wrap(t.wrap[1]) << 2 | u32::from(t.nearest) << 4 | u32::from(t.uv_set == 1) << 5 | 1 << 31;
    let row = |r: [f32; 3]| [r[0], r[1], r[2], 0.0];
    GpuTexture { first, width, height, mode, row_u: row(t.transform[0]), row_v: row(t.transform[1]) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twins::layout::{assert_layout, fields};

    #[test]
    fn a_use_of_a_texture_lies_where_the_shaders_read_it() {
        let fields = fields!(GpuTexture: first, width, height, mode, row_u, row_v);
        assert_layout("TextureUse", fields, size_of::<GpuTexture>());
    }

    #[test]
    fn images_that_are_too_large_are_named_with_a_remedy() {
        let limits = Limits::default();
        let most = 256 * LAYER as u64;
        assert!(check(most, &limits).is_ok());
        let error = check(most + 1, &limits).unwrap_err();
        assert_eq!(error.element, "images");
        for part in ["1073741825 texels", "hold 1073741824", "scale images down", "max_texture_array_layers"] {
            assert!(error.reason.contains(part), "{part}: {error}");
        }
    }
}
