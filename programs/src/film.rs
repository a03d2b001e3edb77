//! A denoiser with its targets: records frames, waits for them, and hands out their pixels.

use crate::gpu::Gpu;
use crate::times::{Clock, PassTimes, Stopwatch};
use asvgf::wgpu::{CommandEncoder, TextureFormat, TextureView};
use asvgf::{Denoiser, DenoiserDescriptor, Error, Pass, Settings, View, ViewOptions};

/// Callback that the denoiser calls after each pass, so that the caller can submit each pass by itself.
pub type After<'a> = &'a mut dyn FnMut(&Pass, &mut CommandEncoder);

pub struct Film<'a> {
    pub gpu: &'a Gpu,
    pub denoiser: Denoiser,
    pub target: TextureView,
    clock: Clock,
    numbers: TextureView,
    picture: TextureView,
}

impl<'a> Film<'a> {
    pub fn new(gpu: &'a Gpu, size: [u32; 2], settings: Settings) -> Result<Self, Error> {
        Self::of(gpu, DenoiserDescriptor { size, settings, views: true, ..Default::default() })
    }

    /// Makes a film with a denoiser of this descriptor.
    pub fn of(gpu: &'a Gpu, descriptor: DenoiserDescriptor) -> Result<Self, Error> {
        let clock = Clock::of(gpu);
        let size = descriptor.size;
        let descriptor = DenoiserDescriptor { timing: clock == Clock::Timestamps, ..descriptor };
        Ok(Self {
            gpu,
            denoiser: Denoiser::new(&gpu.device, &gpu.queue, &descriptor)?,
            target: gpu.target(size, TextureFormat::Rgba32Float),
            clock,
            numbers: gpu.target(size, TextureFormat::Rgba32Float),
            picture: gpu.target(size, TextureFormat::Rgba8Unorm),
        })
    }

    /// Submits a frame whose recording writes the target, and waits for it.
    pub fn expose(
        &mut self,
        record: impl FnOnce(&mut Denoiser, &mut CommandEncoder, &TextureView, After<'_>) -> Result<(), Error>,
    ) -> Result<PassTimes, Error> {
        let gpu = self.gpu;
        let new_encoder = || gpu.device.create_command_encoder(&Default::default());
        let mut encoder = new_encoder();
        let mut times = PassTimes::new();
        let mut watch = Stopwatch::start(self.clock);
        let mut after = |pass: &Pass, encoder: &mut CommandEncoder| {
            if self.clock != Clock::Timestamps {
                gpu.queue.submit([std::mem::replace(encoder, new_encoder()).finish()]);
                gpu.wait();
                times.push((pass.name(), watch.read()));
                watch = Stopwatch::start(self.clock);
            }
        };
        record(&mut self.denoiser, &mut encoder, &self.target, &mut after)?;
        gpu.queue.submit([encoder.finish()]);
        gpu.wait();
        Ok(self.denoiser.take_times().map_or(times, |stamped| stamped.passes))
    }

    /// Returns an image of the last frame as numbers.
    pub fn numbers(&mut self, view: View) -> Result<Vec<[f32; 3]>, Error> {
        self.show(view, ViewOptions::default(), &self.numbers.clone())?;
        Ok(self.gpu.read_colors(&self.numbers))
    }

    /// Returns an image of the last frame as a picture.
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
