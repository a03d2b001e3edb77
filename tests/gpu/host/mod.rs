//! A host's own frames: the path tracer's images handed in again, and those of a tiny renderer.

mod cleaning;
mod copies;
mod far;
mod formats;
mod gloss;
mod gloss_elsewhere;
mod levels;
mod orthographic;
mod pairless;
mod radiance;
mod recording;
mod refusals;
mod renderer;

use crate::common::gpu::{Gpu, gpu};
use crate::common::images::{self, upload, upload_bytes};
use crate::common::stage::Stage;
use crate::common::statistics::Rgb;
use asvgf::{
    Camera, Denoiser, DenoiserDescriptor, FilterSettings, Gradient, Settings, Shading, Surfaces, View, ViewOptions,
};
use wgpu::{TextureFormat, TextureView};

const SIZE: [u32; 2] = [48, 36];

/// One frame of the path tracer in the form of a host's frame, and the denoiser's result.
#[derive(Clone)]
struct Recorded {
    index: u32,
    camera: Camera,
    depth: Vec<f32>,
    normal: Vec<Rgb>,
    motion: Vec<[f32; 2]>,
    previous_depth: Vec<f32>,
    albedo: Vec<Rgb>,
    /// Noisy light without albedo.
    light: Vec<Rgb>,
    denoised: Vec<Rgb>,
}

/// The default settings, with paths that the host repeats.
fn reshading() -> Settings {
    let filter = FilterSettings { gradient: Gradient::Reshade, ..Default::default() };
    Settings { filter, ..Settings::adaptive() }
}

/// Frames of the Cornell box around the one in which its lamp goes out. The camera moves and does not see the lamp.
fn recorded(settings: Settings) -> Vec<Recorded> {
    // A host does not say in which frames nothing changed, so nothing may be left out.
    let mut stage = Stage::built_in("cornell", "blink", SIZE, settings).leaving_nothing_out();
    (stage.index..10)
        .map(|i| {
            let index = 24 + i;
            let x = 0.1 + 0.01 * f64::from(i);
            let camera = Camera { eye: [x, 0.8, 3.0], target: [0.3, 0.5, -1.0], fov_y: 0.4, ..Default::default() };
            (stage.camera, stage.index) = (Some(camera), index);
            let denoised = stage.frame().image();
            let [normal, motion, albedo, noisy] =
                [View::Normal, View::Motion, View::Albedo, View::Noisy].map(|view| stage.view(view));
            let light = noisy.iter().zip(&albedo).map(|(n, a)| [0, 1, 2].map(|c| n[c] / a[c].max(1e-3))).collect();
            Recorded {
                index,
                camera,
                depth: stage.view(View::Depth).iter().map(|d| d[0]).collect(),
                normal,
                previous_depth: motion.iter().map(|m| m[2]).collect(),
                motion: motion.iter().map(|m| [m[0], m[1]]).collect(),
                albedo,
                light,
                denoised,
            }
        })
        .collect()
}

/// A frame's images on the GPU.
struct Uploaded {
    frame: Recorded,
    depth: TextureView,
    normal: TextureView,
    motion: TextureView,
    previous_depth: TextureView,
    albedo: TextureView,
    light: TextureView,
}

impl Uploaded {
    fn new(gpu: &Gpu, frame: &Recorded) -> Self {
        let scalars = |image: &[f32]| upload(gpu, SIZE, &image.iter().map(|&x| [x]).collect::<Vec<_>>());
        Self {
            frame: frame.clone(),
            depth: scalars(&frame.depth),
            normal: upload(gpu, SIZE, &frame.normal),
            motion: upload(gpu, SIZE, &frame.motion),
            previous_depth: scalars(&frame.previous_depth),
            albedo: upload(gpu, SIZE, &frame.albedo),
            light: upload(gpu, SIZE, &frame.light),
        }
    }

    fn surfaces(&self) -> Surfaces<'_> {
        let Recorded { camera, index, .. } = self.frame;
        Surfaces {
            previous_depth: Some(&self.previous_depth),
            ..Surfaces::new(camera, index, &self.depth, &self.normal, &self.motion)
        }
    }

    fn shading<'a>(&'a self, target: &'a TextureView) -> Shading<'a> {
        Shading { albedo: Some(&self.albedo), demodulated: true, ..Shading::new(&self.light, target) }
    }
}

fn denoiser(settings: Settings) -> Denoiser {
    let descriptor = DenoiserDescriptor { size: SIZE, settings, views: true, ..Default::default() };
    Denoiser::new(&gpu().device, &gpu().queue, &descriptor).unwrap()
}

fn target() -> TextureView {
    gpu().target(SIZE, TextureFormat::Rgba32Float)
}

fn colors(view: &TextureView) -> Vec<Rgb> {
    images::colors(gpu(), view)
}

/// An intermediate image as numbers.
fn view(denoiser: &mut Denoiser, view: View) -> Vec<Rgb> {
    let target = gpu().target(denoiser.size(), TextureFormat::Rgba32Float);
    gpu().submit(|e| denoiser.show(&gpu().device, e, view, ViewOptions::default(), &target)).unwrap();
    colors(&target)
}

/// The denoised frames, in order.
fn replay(denoiser: &mut Denoiser, frames: &[Recorded]) -> Vec<Vec<Rgb>> {
    let target = target();
    let mut images = Vec::new();
    for frame in frames {
        let host = Uploaded::new(gpu(), frame);
        gpu().submit(|encoder| {
            denoiser.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
            denoiser.denoise(&gpu().device, encoder, &host.shading(&target)).unwrap();
        });
        images.push(colors(&target));
    }
    images
}

/// Largest and mean difference of two images, relative to the mean of the second.
fn difference(a: &[Rgb], b: &[Rgb]) -> [f64; 2] {
    assert_eq!(a.len(), b.len());
    let each: Vec<f64> = a.iter().flatten().zip(b.iter().flatten()).map(|(x, y)| f64::from((x - y).abs())).collect();
    let level = b.iter().flatten().map(|x| f64::from(*x)).sum::<f64>() / each.len() as f64;
    [each.iter().fold(0.0_f64, |m, x| m.max(*x)) / level, each.iter().sum::<f64>() / each.len() as f64 / level]
}
