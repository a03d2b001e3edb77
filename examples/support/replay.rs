//! Frames of a sequence on a film, as a host with a renderer of its own hands them in.

use crate::camera::Camera;
use crate::film::Film;
use crate::gpu::Gpu;
use crate::layers::Layer;
use crate::sequence::{Pixels, Sequence};
use crate::times::PassTimes;
use asvgf::wgpu::{self, TextureFormat, TextureUsages, TextureView};
use asvgf::{Error, Gradient, Lambda, Pairs, Shading, Surfaces};

/// Denoises a sequence, calling back after each frame.
pub fn denoise(
    film: &mut Film<'_>,
    sequence: &Sequence,
    mut done: impl FnMut(u32, &mut Film<'_>) -> Result<(), Box<dyn std::error::Error>>,
) -> Result<Vec<PassTimes>, Box<dyn std::error::Error>> {
    let mut times = Vec::new();
    for frame in sequence.first..=sequence.last {
        let cameras = [frame, frame.saturating_sub(1).max(sequence.first)].map(|frame| sequence.camera(frame));
        let views = Views::new(film.gpu, sequence.size, &sequence.read(frame)?, cameras);
        times.push(expose(film, &views, cameras[0], frame, sequence.in_place)?);
        done(frame, film)?;
    }
    Ok(times)
}

/// A frame's layers on the GPU.
struct Views {
    views: Vec<Option<TextureView>>,
    motion: TextureView,
}

impl Views {
    /// Uploads a frame. Where there is no motion, that of points at rest between the last camera and this one is taken.
    fn new(gpu: &Gpu, size: [u32; 2], pixels: &Pixels, cameras: [Camera; 2]) -> Self {
        let mut views = Layer::ALL.map(|layer| pixels.get(layer).map(|samples| upload(gpu, size, layer, samples)));
        let depth = depths(pixels);
        views[Layer::Depth as usize] = Some(upload(gpu, size, Layer::Depth, &depth));
        let given = views[Layer::Motion as usize].clone();
        let motion = given.unwrap_or_else(|| upload(gpu, size, Layer::Motion, &motion(size, &depth, cameras)));
        Self { views: views.into(), motion }
    }

    fn get(&self, layer: Layer) -> Option<&TextureView> {
        self.views[layer as usize].as_ref()
    }
}

/// Denoises a frame and waits for it.
fn expose(film: &mut Film<'_>, views: &Views, camera: Camera, index: u32, in_place: bool) -> Result<PassTimes, Error> {
    let device = &film.gpu.device;
    film.expose(|denoiser, encoder, target, after| {
        let missing = |view| Error::ViewMissing { view, setting: "a sequence", remedy: "add the layer to its frames" };
        let required = |layer: Layer| views.get(layer).ok_or_else(|| missing(layer.name()));
        let gradient = denoiser.settings().filter.gradient;
        let camera = camera.viewpoint(denoiser.size());
        let (depth, normal) = (required(Layer::Depth)?, required(Layer::Normal)?);
        let surfaces = Surfaces {
            previous_depth: views.get(Layer::PreviousDepth),
            instance: views.get(Layer::Id),
            ..Surfaces::new(camera, index, depth, normal, &views.motion)
        };
        let pairs = views.get(Layer::GradientCurrent).zip(views.get(Layer::GradientPrevious));
        let pairs = pairs.map(|(current, previous)| Pairs { current, previous, in_place });
        let lambda = views.get(Layer::Lambda).map(|view| Lambda { view, block: 1, confidence: false });
        let shading = Shading {
            albedo: views.get(Layer::Albedo),
            emission: views.get(Layer::Emission),
            pairs: pairs.filter(|_| gradient == Gradient::Pairs),
            lambda: lambda.filter(|_| gradient == Gradient::Lambda),
            ..Shading::new(required(Layer::Color)?, target)
        };
        denoiser.begin_frame_stepwise(device, encoder, &surfaces, &mut *after)?;
        denoiser.denoise_stepwise(device, encoder, &shading, after)
    })
}

/// The depths of what is to be filtered. A light that reflects nothing is not: its zeros would darken what lies beside it.
fn depths(pixels: &Pixels) -> Vec<f32> {
    let mut depths = pixels.get(Layer::Depth).unwrap_or_default().to_vec();
    if let (Some(albedo), Some(emission)) = (pixels.get(Layer::Albedo), pixels.get(Layer::Emission)) {
        for ((depth, a), e) in depths.iter_mut().zip(albedo.chunks_exact(3)).zip(emission.chunks_exact(3)) {
            if a == [0.0; 3] && e != [0.0; 3] {
                *depth = 0.0;
            }
        }
    }
    depths
}

/// The motion of points at rest between two cameras, this frame's first.
fn motion(size: [u32; 2], depth: &[f32], [now, before]: [Camera; 2]) -> Vec<f32> {
    let pixel = |i: usize| [i as u32 % size[0], i as u32 / size[0]];
    let motion = |(i, &z): (usize, &f32)| now.motion_to(&before, pixel(i), z.into(), size).map(|m| m as f32);
    depth.iter().enumerate().flat_map(motion).collect()
}

/// A layer as a texture of 32-bit floats. Three channels get a fourth, as there are no textures of three.
fn upload(gpu: &Gpu, size: [u32; 2], layer: Layer, samples: &[f32]) -> TextureView {
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
