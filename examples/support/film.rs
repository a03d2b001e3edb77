//! A denoiser with its targets: renders frames, waits for them, and hands out their pixels.

use crate::gpu::Gpu;
use asvgf::scene::GpuScene;
use asvgf::wgpu::{DeviceType, Features, TextureFormat, TextureView};
use asvgf::{Camera, Denoiser, DenoiserDescriptor, Error, Frame, Mode, Settings, View, ViewOptions};
use std::time::Instant;

/// Most paths per pixel in one dispatch of a reference: enough to hide what a dispatch costs, and far from the seconds
/// after which systems take a GPU for hung.
const BATCH: u32 = 16;

/// One frame's passes and their milliseconds, in order.
pub type PassTimes = Vec<(&'static str, f64)>;

/// How the times of passes were taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clock {
    /// By the GPU, at the passes' boundaries.
    Timestamps,
    /// By the CPU, each pass submitted and waited for by itself: software adapters run all passes when they are waited for,
    /// and so stamp them wrongly.
    Waiting,
}

impl Clock {
    /// The honest clock for an adapter.
    pub fn of(gpu: &Gpu) -> Self {
        let stamps = gpu.device.features().contains(Features::TIMESTAMP_QUERY);
        if stamps && gpu.adapter.device_type != DeviceType::Cpu { Self::Timestamps } else { Self::Waiting }
    }
}

pub struct Film<'a> {
    gpu: &'a Gpu,
    pub denoiser: Denoiser,
    clock: Clock,
    target: TextureView,
    numbers: TextureView,
    picture: TextureView,
    /// Dispatches of references so far: each has random numbers of its own.
    batches: u32,
}

impl<'a> Film<'a> {
    pub fn new(gpu: &'a Gpu, size: [u32; 2], settings: Settings) -> Result<Self, Error> {
        let clock = Clock::of(gpu);
        let descriptor =
            DenoiserDescriptor { size, settings, timing: clock == Clock::Timestamps, ..Default::default() };
        Ok(Self {
            gpu,
            denoiser: Denoiser::new(&gpu.device, &gpu.queue, &descriptor)?,
            clock,
            target: gpu.target(size, TextureFormat::Rgba32Float),
            numbers: gpu.target(size, TextureFormat::Rgba32Float),
            picture: gpu.target(size, TextureFormat::Rgba8Unorm),
            batches: 0,
        })
    }

    /// Renders a frame and waits for it.
    pub fn render(&mut self, scene: &GpuScene, camera: Camera, index: u32) -> Result<PassTimes, Error> {
        let gpu = self.gpu;
        let frame = Frame { scene, camera, index, target: &self.target };
        let new_encoder = || gpu.device.create_command_encoder(&Default::default());
        let mut encoder = new_encoder();
        let mut times = PassTimes::new();
        if self.clock == Clock::Timestamps {
            self.denoiser.render(&gpu.device, &mut encoder, &frame)?;
        } else {
            let mut start = Instant::now();
            self.denoiser.render_stepwise(&gpu.device, &mut encoder, &frame, |pass, encoder| {
                gpu.queue.submit([std::mem::replace(encoder, new_encoder()).finish()]);
                gpu.wait();
                times.push((pass.name(), start.elapsed().as_secs_f64() * 1e3));
                start = Instant::now();
            })?;
        }
        gpu.queue.submit([encoder.finish()]);
        gpu.wait();
        if let Some(stamped) = self.denoiser.take_times() {
            times = stamped.passes;
        }
        Ok(times)
    }

    /// Traces `paths` per pixel of one moment, on a film in [`Mode::Reference`], calling back after each batch with its paths.
    pub fn converge(
        &mut self,
        scene: &GpuScene,
        camera: Camera,
        paths: u32,
        mut done: impl FnMut(u32),
    ) -> Result<Vec<[f32; 3]>, Error> {
        // All batches count alike in the mean, so all are of one size.
        let batch = (1..=BATCH).rev().find(|batch| paths.is_multiple_of(*batch)).unwrap_or(1);
        let mut settings = Settings { mode: Mode::Reference, ..self.denoiser.settings().clone() };
        settings.tracer.samples = batch;
        self.denoiser.set_settings(settings)?;
        self.denoiser.reset();
        for _ in 0..paths / batch {
            self.render(scene, camera, self.batches)?;
            self.batches = self.batches.wrapping_add(1);
            done(batch);
        }
        Ok(self.gpu.read_colors(&self.target))
    }

    /// An image of the last frame as numbers.
    pub fn numbers(&mut self, view: View) -> Result<Vec<[f32; 3]>, Error> {
        self.show(view, ViewOptions::default(), &self.numbers.clone())?;
        Ok(self.gpu.read_colors(&self.numbers))
    }

    /// An image of the last frame as a picture.
    pub fn picture(&mut self, view: View, exposure: f32) -> Result<Vec<[u8; 4]>, Error> {
        self.show(view, ViewOptions { exposure, range: view.default_range() }, &self.picture.clone())?;
        Ok(self.gpu.read(&self.picture).as_chunks::<4>().0.to_vec())
    }

    fn show(&mut self, view: View, options: ViewOptions, target: &TextureView) -> Result<(), Error> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.denoiser.show(&self.gpu.device, &mut encoder, view, options, target)?;
        self.gpu.queue.submit([encoder.finish()]);
        Ok(())
    }
}
