//! The textures behind a plan's images.

use crate::plan::{Image, Kind, Memory, Plan, Slot, needed};
use wgpu::{Device, Extent3d, TextureDescriptor, TextureDimension, TextureUsages, TextureView, TextureViewDescriptor};

/// All textures of one denoiser.
#[derive(Debug, Default)]
pub(crate) struct Textures {
    memory: Memory,
    /// The views of the textures, by their numbers in `memory`.
    views: Vec<Option<TextureView>>,
    /// The images of the largest plan, when textures were last given up.
    images: Vec<(Image, bool)>,
    /// True to keep every image until the next frame.
    keep: bool,
    bytes: u64,
}

impl Textures {
    /// Makes the textures of one denoiser. With `keep`, no texture holds two images of one frame.
    pub fn new(keep: bool) -> Self {
        Self { keep, ..Default::default() }
    }

    /// True if every image is kept until the next frame.
    pub fn keeps(&self) -> bool {
        self.keep
    }

    /// True if a new frame finds all images of the last one that a plan reads.
    pub fn has_all_before(&self, plan: &Plan) -> bool {
        self.memory.has_all_before(&plan.steps)
    }

    /// Begins a frame.
    pub fn begin(&mut self) {
        self.memory.begin();
    }

    /// Creates the textures that steps `from..to` of a plan use. If these steps end the frame, a texture is reused after its last use, and
    /// the images that the next frame needs are kept. `images` are those of the same plan if everything changes.
    pub fn place(
        &mut self,
        device: &Device,
        size: [u32; 2],
        plan: &Plan,
        (from, to): (usize, usize),
        images: Vec<(Image, bool)>,
    ) {
        let needed = needed(&images);
        let last = to == plan.steps.len();
        let over = |step: usize, slot: Slot| last && plan.is_over(step, slot, &needed, self.keep);
        self.memory.place(&plan.steps[..to], from, over);
        if last {
            self.memory.end(needed);
            if images != self.images {
                self.memory.shrink();
                self.images = images;
            }
        }
        let kinds = self.memory.textures();
        self.views.resize(kinds.len(), None);
        for (number, (view, kind)) in self.views.iter_mut().zip(kinds).enumerate() {
            match kind {
                Some(kind) if view.as_ref().is_some_and(|view| suits(view, *kind, size)) => {}
                Some(kind) => *view = Some(create(device, size, *kind, number)),
                None => *view = None,
            }
        }
        self.bytes = kinds.iter().flatten().map(|kind| kind.bytes(size)).sum();
    }

    /// Drops a frame that was begun and not finished.
    pub fn abandon(&mut self) {
        self.memory.abandon();
    }

    /// Gives up all textures.
    pub fn clear(&mut self) {
        *self = Self::new(self.keep);
    }

    /// The view behind a slot.
    pub fn view(&self, slot: Slot) -> Option<&TextureView> {
        self.views.get(self.memory.texture(slot)?)?.as_ref()
    }

    /// True if the textures hold a whole frame, because none was begun since.
    pub fn is_complete(&self) -> bool {
        self.memory.is_complete()
    }

    /// True if the last frame's image is still there.
    pub fn holds(&self, image: Image) -> bool {
        self.memory.holds(image)
    }

    /// Bytes of all textures.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

fn suits(view: &TextureView, kind: Kind, size: [u32; 2]) -> bool {
    let texture = view.texture();
    texture.format() == kind.format && [texture.width(), texture.height()] == kind.grid.extent(size)
}

fn create(device: &Device, size: [u32; 2], kind: Kind, number: usize) -> TextureView {
    let [width, height] = kind.grid.extent(size);
    let label = format!("asvgf texture {number}");
    device
        .create_texture(&TextureDescriptor {
            label: Some(&label),
            size: Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: kind.format,
            usage: TextureUsages::STORAGE_BINDING | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC,
            view_formats: &[],
        })
        .create_view(&TextureViewDescriptor::default())
}
