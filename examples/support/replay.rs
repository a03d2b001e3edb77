//! Frames of a sequence on a film, as a host with a renderer of its own hands them in.

use crate::camera::Camera;
use crate::film::Film;
use crate::gpu::Gpu;
use crate::layers::Layer;
use crate::sequence::{Pixels, Sequence};
use crate::times::PassTimes;
use asvgf::wgpu::{self, TextureFormat, TextureUsages, TextureView};
use asvgf::{Error, Gradient, Lambda, Pairs, Shading, Surfaces};

/// What denoising a sequence told.
pub struct Denoised {
    /// Of each frame.
    pub times: Vec<PassTimes>,
    /// The first frame that was denoised by itself, as it had the noise of the one before.
    pub repeated: Option<u32>,
}

/// Whether a renderer takes the same random numbers in each frame, as those with a fixed seed do. One frame that is held tells
/// nothing; two in a row do, until two in a row differ: a light may change in between.
#[derive(Default)]
struct FixedSeed {
    fixed: bool,
    same: u32,
    other: u32,
}

impl FixedSeed {
    fn observe(&mut self, repeats: bool) -> bool {
        (self.same, self.other) = if repeats { (self.same + 1, 0) } else { (0, self.other + 1) };
        self.fixed = if self.fixed { self.other < 2 } else { self.same >= 2 };
        self.fixed
    }
}

/// Denoises a sequence, calling back after each frame.
pub fn denoise(
    film: &mut Film<'_>,
    sequence: &Sequence,
    mut done: impl FnMut(u32, &mut Film<'_>) -> Result<(), Box<dyn std::error::Error>>,
) -> Result<Denoised, Box<dyn std::error::Error>> {
    let mut denoised = Denoised { times: Vec::new(), repeated: None };
    let (mut last, mut seed) = (None::<Pixels>, FixedSeed::default());
    for frame in sequence.first..=sequence.last {
        let cameras = [frame, frame.saturating_sub(1).max(sequence.first)].map(|frame| sequence.camera(frame));
        let pixels = sequence.read(frame)?;
        let views = Views::new(film.gpu, sequence.size, &pixels, cameras);
        let repeats = last.is_some_and(|last| repeats_noise(&last, &pixels, sequence.size[0], cameras));
        // Such frames are one sample, however many there are: an average of them is no better, and looks as if it were.
        if seed.observe(repeats) {
            denoised.repeated.get_or_insert(frame);
            film.denoiser.reset();
        }
        denoised.times.push(expose(film, &views, cameras[0], frame, sequence.in_place)?);
        done(frame, film)?;
        last = Some(pixels);
    }
    Ok(denoised)
}

/// Pixels at rest that have to show the same noise, of those with light, before it is taken to be repeated.
const REPEATED: f32 = 0.5;

/// Fewest pixels at rest that tell anything.
const FEWEST: usize = 64;

/// Difference of a pixel to the mean of its neighbours, over that mean, from which on it is noise.
const NOISY: f32 = 0.05;

/// Whether a frame has the random numbers of the last one, as those of renderers with a fixed seed have: then what is at rest shows
/// the same noise to the last bit.
fn repeats_noise(last: &Pixels, now: &Pixels, width: u32, [camera, before]: [Camera; 2]) -> bool {
    let radiance = |pixels| Pixels::get(pixels, Layer::Color).unwrap_or_default();
    let (was, is) = (radiance(last), radiance(now));
    let depth = now.get(Layer::Depth).unwrap_or_default();
    let motion = now.get(Layer::Motion);
    let rests = |i: usize| match motion {
        Some(motion) => motion[2 * i].abs().max(motion[2 * i + 1].abs()) < 1e-3,
        None => camera == before,
    };
    let brightness = |i: usize| is[3 * i..3 * i + 3].iter().sum::<f32>();
    // Between two neighbours in a row; an image without noise may well stay what it is.
    let is_noisy = |i: usize| {
        let column = i as u32 % width;
        let inside = column > 0 && column + 1 < width;
        let around = if inside { 0.5 * (brightness(i - 1) + brightness(i + 1)) } else { brightness(i) };
        (brightness(i) - around).abs() > NOISY * around
    };
    let (mut counted, mut same, mut noisy) = (0, 0, 0);
    for (i, (a, b)) in was.chunks_exact(3).zip(is.chunks_exact(3)).enumerate() {
        if depth[i] > 0.0 && rests(i) && b.iter().any(|x| *x != 0.0) {
            counted += 1;
            same += usize::from(a == b);
            noisy += usize::from(is_noisy(i));
        }
    }
    let most = REPEATED * counted as f32;
    counted >= FEWEST && same as f32 > most && noisy as f32 > most
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
        let (depth, albedo) = surfaces(pixels, size);
        views[Layer::Depth as usize] = Some(upload(gpu, size, Layer::Depth, &depth));
        views[Layer::Albedo as usize] = albedo.map(|albedo| upload(gpu, size, Layer::Albedo, &albedo));
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

/// The depths and albedos of what is to be filtered. A light that reflects nothing is not: its zeros would darken what lies beside
/// it. What glows and is lit although its albedo is 0, as a mirror is where that is the diffuse one, is filtered undivided.
fn surfaces(pixels: &Pixels, [width, height]: [u32; 2]) -> (Vec<f32>, Option<Vec<f32>>) {
    let mut depths = pixels.get(Layer::Depth).unwrap_or_default().to_vec();
    let layers = (pixels.get(Layer::Albedo), pixels.get(Layer::Emission), pixels.get(Layer::Color));
    let (Some(albedo), Some(emission), Some(color)) = layers else {
        return (depths, layers.0.map(<[f32]>::to_vec));
    };
    let mut albedos = albedo.to_vec();
    let black = |i: usize| albedo[3 * i..3 * i + 3] == [0.0; 3];
    let sum = |image: &[f32], i: usize| image[3 * i..3 * i + 3].iter().sum::<f32>();
    for i in (0..depths.len()).filter(|&i| black(i) && sum(emission, i) != 0.0) {
        // Of pixels like it around, as one path alone may have found nothing.
        let (x, y) = ((i as u32 % width) as i32, (i as u32 / width) as i32);
        let near = |at: i32, size: u32| (at - AROUND).max(0)..=(at + AROUND).min(size as i32 - 1);
        let (mut light, mut emitted) = (0.0, 0.0);
        for j in near(y, height).flat_map(|y| near(x, width).map(move |x| (y * width as i32 + x) as usize)) {
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
const AROUND: i32 = 2;

/// Part of the emission beyond which what comes with it is light, not rounding.
const REFLECTED: f32 = 0.02;

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
