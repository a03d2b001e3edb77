//! The textures behind a plan's images.

use crate::plan::{Grid, Image, Plan};
use std::collections::BTreeMap;
use wgpu::{Device, Extent3d, TextureDescriptor, TextureDimension, TextureUsages, TextureView, TextureViewDescriptor};

/// Strata of 3×3 pixels that cover an image.
pub(crate) fn strata(size: [u32; 2]) -> [u32; 2] {
    size.map(|s| s.div_ceil(3))
}

/// All images of one denoiser. Those of which the previous frame's is needed exist twice and swap roles.
#[derive(Debug, Default)]
pub(crate) struct Textures {
    views: BTreeMap<Image, Vec<TextureView>>,
    bytes: u64,
}

impl Textures {
    /// Makes what a plan needs and drops what it does not. Returns whether an image of the previous frame is new, so that
    /// there is no history.
    pub fn fit(&mut self, device: &Device, size: [u32; 2], plan: &Plan) -> bool {
        let needed: BTreeMap<Image, bool> = plan.images().into_iter().collect();
        self.views.retain(|image, _| needed.contains_key(image));
        self.grow(device, size, plan)
    }

    /// As [`Textures::fit`], and keeps what the plan does not need.
    pub fn grow(&mut self, device: &Device, size: [u32; 2], plan: &Plan) -> bool {
        let needed: BTreeMap<Image, bool> = plan.images().into_iter().collect();
        self.views.retain(|image, views| needed.get(image).is_none_or(|&pair| views.len() == 1 + usize::from(pair)));
        let mut lost = false;
        for (&image, &pair) in &needed {
            self.views.entry(image).or_insert_with(|| {
                lost |= pair;
                (0..1 + usize::from(pair)).map(|_| create(device, size, image)).collect()
            });
        }
        self.bytes = self.views.iter().map(|(i, v)| v.len() as u64 * bytes(*i, size)).sum();
        lost
    }

    pub fn clear(&mut self) {
        self.views.clear();
    }

    /// This frame's view of an image; `parity` alternates from frame to frame.
    pub fn now(&self, image: Image, parity: usize) -> Option<&TextureView> {
        self.views.get(&image).and_then(|v| v.get(parity % v.len()))
    }

    /// The previous frame's.
    pub fn before(&self, image: Image, parity: usize) -> Option<&TextureView> {
        self.now(image, parity + 1)
    }

    /// Bytes of all textures.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

fn extent(image: Image, size: [u32; 2]) -> [u32; 2] {
    let [width, height] = match image.grid() {
        Grid::Pixels => size,
        Grid::Strata => strata(size),
    };
    [image.texels() * width, height]
}

fn bytes(image: Image, size: [u32; 2]) -> u64 {
    let [width, height] = extent(image, size).map(u64::from);
    width * height * u64::from(image.format().block_copy_size(None).unwrap_or(0))
}

fn create(device: &Device, size: [u32; 2], image: Image) -> TextureView {
    let [width, height] = extent(image, size);
    let label = format!("asvgf {image:?}");
    device
        .create_texture(&TextureDescriptor {
            label: Some(&label),
            size: Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: image.format(),
            usage: TextureUsages::STORAGE_BINDING | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC,
            view_formats: &[],
        })
        .create_view(&TextureViewDescriptor::default())
}
