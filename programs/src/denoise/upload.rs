//! A frame's layers as the denoiser takes them, on the GPU.

use crate::denoise::grid::around;
use crate::gpu::Gpu;
use crate::sequence::layers::Layer;
use crate::sequence::{Pixels, Sequence};
use asvgf::wgpu::{self, TextureFormat, TextureUsages, TextureView};

/// A frame's layers on the GPU.
pub struct Views {
    views: Vec<Option<TextureView>>,
    pub motion: TextureView,
}

impl Views {
    /// Uploads a frame. In a run backwards, data of the last frame belongs to the next one, and is left out.
    pub fn new(gpu: &Gpu, sequence: &Sequence, pixels: &Pixels, motion: &[f32], backwards: bool) -> Self {
        let size = sequence.size;
        let forwards = |layer: Layer| {
            !matches!(
                layer,
                Layer::PreviousDepth
                    | Layer::GradientCurrent
                    | Layer::GradientPrevious
                    | Layer::SpecularGradientCurrent
                    | Layer::SpecularGradientPrevious
                    | Layer::Lambda
                    | Layer::Motion
                    | Layer::SpecularMotion
            ) || (layer == Layer::PreviousDepth && !sequence.has_surfaces())
        };
        let wanted = |layer: Layer| !backwards || forwards(layer);
        let mut views = Layer::ALL.map(|layer| {
            let samples = pixels.get(layer).filter(|_| wanted(layer) && layer != Layer::Motion);
            samples.map(|samples| upload(gpu, size, layer, samples))
        });
        let (depth, albedo) = surfaces(pixels, size);
        views[Layer::Depth as usize] = Some(upload(gpu, size, Layer::Depth, &depth));
        views[Layer::Albedo as usize] = albedo.map(|albedo| upload(gpu, size, Layer::Albedo, &albedo));
        Self { views: views.into(), motion: upload(gpu, size, Layer::Motion, motion) }
    }

    pub fn get(&self, layer: Layer) -> Option<&TextureView> {
        self.views[layer as usize].as_ref()
    }
}

/// Returns the depths and albedos for the filter. A light that reflects nothing is excluded: its zeros would darken its
/// neighbours. A surface that glows and is lit although its albedo is 0 (a mirror, if the albedo is the diffuse one) is
/// filtered undivided.
fn surfaces(pixels: &Pixels, size: [u32; 2]) -> (Vec<f32>, Option<Vec<f32>>) {
    let size = size.map(|side| side as usize);
    let mut depths = pixels.get(Layer::Depth).unwrap_or_default().to_vec();
    let layers = (pixels.get(Layer::Albedo), pixels.get(Layer::Emission), pixels.get(Layer::Color));
    let (Some(albedo), Some(emission), Some(color)) = layers else {
        return (depths, layers.0.map(<[f32]>::to_vec));
    };
    let mut albedos = albedo.to_vec();
    let black = |i: usize| albedo[3 * i..3 * i + 3] == [0.0; 3];
    let sum = |image: &[f32], i: usize| image[3 * i..3 * i + 3].iter().sum::<f32>();
    for i in (0..depths.len()).filter(|&i| black(i) && sum(emission, i) != 0.0) {
        // Sums similar pixels around as well, because a single path may have found nothing.
        let (mut light, mut emitted) = (0.0, 0.0);
        for j in around(size, i, AROUND) {
            if black(j) {
                light += (sum(color, j) - sum(emission, j)).max(0.0);
                emitted += sum(emission, j);
            }
        }
        if light <= REFLECTED * emitted {
            depths[i] = 0.0;
        } else {
            albedos[3 * i..3 * i + 3].fill(1.0);
        }
    }
    (depths, Some(albedos))
}

/// Pixels to each side.
const AROUND: usize = 2;

/// Ratio of light to emission above which the light is real, and no rounding.
const REFLECTED: f32 = 0.02;

/// Uploads a layer as a texture of 32-bit floats. Three channels get a fourth, because there are no textures of three.
pub fn upload(gpu: &Gpu, size: [u32; 2], layer: Layer, samples: &[f32]) -> TextureView {
    let components = layer.components().len();
    let padded: Vec<f32>;
    let (format, texels) = match components {
        1 => (TextureFormat::R32Float, samples),
        2 => (TextureFormat::Rg32Float, samples),
        _ => {
            padded = samples.chunks_exact(3).flat_map(|c| [c[0], c[1], c[2], 0.0]).collect();
            (TextureFormat::Rgba32Float, padded.as_slice())
        }
    };
    let extent = wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(layer.name()),
        size: extent,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let bytes: Vec<u8> = texels.iter().flat_map(|x| x.to_le_bytes()).collect();
    let row = size[0] * 4 * components.next_power_of_two() as u32;
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    gpu.queue.write_texture(texture.as_image_copy(), &bytes, layout, extent);
    texture.create_view(&Default::default())
}
