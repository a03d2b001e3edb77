//! Frames of the path tracer on a film.

use crate::film::Film;
use crate::gpu::Gpu;
use crate::times::PassTimes;
use asvgf::scene::GpuScene;
use asvgf::{Camera, Error, Frame, Mode, Settings, TracerSettings};

/// Most paths per pixel in one dispatch of a reference: enough to hide the cost of a dispatch, and far from the seconds
/// after which systems take a GPU for hung.
const BATCH: u32 = 16;

/// Mask that changes a seed, so that references share no random number with the frames that they judge.
const OTHER_PATHS: u32 = 0x5eed_0000;

/// Renders a frame and waits for it.
pub fn render(film: &mut Film<'_>, scene: &GpuScene, camera: Camera, index: u32) -> Result<PassTimes, Error> {
    let device = &film.gpu.device;
    film.expose(|denoiser, encoder, target, after| {
        denoiser.stepwise(after).render(device, encoder, &Frame::new(scene, camera, index, target))
    })
}

/// A film that converges to the truth.
pub struct Reference<'a> {
    film: Film<'a>,
    /// Dispatches so far: each has its own random numbers.
    batches: u32,
}

impl<'a> Reference<'a> {
    /// Makes a reference whose paths share no random number with the paths of these settings.
    pub fn new(gpu: &'a Gpu, size: [u32; 2], settings: &Settings) -> Result<Self, Error> {
        let mut settings = Settings { mode: Mode::Reference, ..settings.clone() };
        settings.tracer.seed ^= OTHER_PATHS;
        Ok(Self { film: Film::new(gpu, size, settings)?, batches: 0 })
    }

    /// Traces the next moment with the random numbers of the first.
    pub fn rewind(&mut self) {
        self.batches = 0;
    }

    /// Traces `paths` per pixel of one moment, and calls back after each batch with its paths.
    pub fn converge(
        &mut self,
        scene: &GpuScene,
        camera: Camera,
        paths: u32,
        mut done: impl FnMut(u32),
    ) -> Result<Vec<[f32; 3]>, Error> {
        let batch = batch(paths);
        let mut settings = self.film.denoiser.settings().clone();
        settings.tracer.samples = batch;
        self.film.denoiser.set_settings(settings)?;
        self.film.denoiser.reset();
        for _ in 0..paths / batch {
            render(&mut self.film, scene, camera, self.batches)?;
            self.batches = self.batches.wrapping_add(1);
            done(batch);
        }
        Ok(self.film.gpu.read_colors(&self.film.target))
    }
}

/// Traces `paths` per pixel of one moment and denoises them, and calls back after each batch with its paths. Nothing
/// changes from batch to batch, so histories are plain means, and the filter removes only their remaining noise.
pub fn converge_denoised(
    gpu: &Gpu,
    size: [u32; 2],
    settings: &Settings,
    scene: &GpuScene,
    camera: Camera,
    paths: u32,
    mut done: impl FnMut(u32),
) -> Result<Vec<[f32; 3]>, Error> {
    let samples = batch(paths);
    let tracer = TracerSettings { samples, seed: settings.tracer.seed ^ OTHER_PATHS, ..settings.tracer.clone() };
    let mut film = Film::new(gpu, size, Settings { tracer, ..Settings::adaptive() })?;
    for index in 0..paths / samples {
        render(&mut film, scene, camera, index)?;
        done(samples);
    }
    Ok(gpu.read_colors(&film.target))
}

/// Returns the largest batch that divides `paths`: all batches count alike in the mean, so all have one size.
fn batch(paths: u32) -> u32 {
    (1..=BATCH).rev().find(|batch| paths.is_multiple_of(*batch)).unwrap_or(1)
}
