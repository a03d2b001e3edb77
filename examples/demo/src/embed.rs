//! The denoiser inside eframe: everything that a host has to do, from top to bottom.
//!
//! eframe has a device, a queue, and a renderer that draws textures. The demo traces and filters the scene on the same device,
//! into textures that the renderer knows by number: it makes no second device, reads nothing back and waits for nothing. A
//! repaint calls [`Embed::begin`], [`Embed::render`], [`Embed::develop`], [`Embed::submit`], and `painter.image(film.id, …)`.

use crate::state::Source;
use crate::stopwatch::Stopwatch;
use asvgf::scene::{GpuScene, Pose, Scene};
use asvgf::{Camera, Denoiser, DenoiserDescriptor, Frame, Settings, View, ViewOptions};
use eframe::egui::TextureId;
use eframe::egui_wgpu::RenderState;
use std::error::Error;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use wgpu::{CommandEncoder, DeviceType, Features, FilterMode, TextureFormat, TextureUsages, TextureView};

/// A denoiser with the textures that it writes.
pub struct Film {
    pub source: Source,
    pub denoiser: Denoiser,
    /// The denoiser's output in linear radiance.
    pub radiance: TextureView,
    /// The picture in the window, encoded as sRGB.
    pub picture: TextureView,
    /// egui's name for `picture`.
    pub id: TextureId,
}

/// A scene on the GPU, with the films that show it.
pub struct Embed {
    pub gpu: RenderState,
    pub scene: GpuScene,
    pub films: Vec<Film>,
    /// Numbers of an intermediate image, for the probe and the means.
    pub numbers: TextureView,
    pub size: [u32; 2],
    /// Number of the next frame. It decides all random numbers, together with the pixel, so all films have the same noise.
    pub index: u32,
    /// Number of the references' next frame. It differs from frame to frame, and also while a frame stands still.
    pub converged: u32,
    /// True while the GPU works on the last submission.
    working: Arc<AtomicBool>,
}

impl Embed {
    /// Uploads a scene to eframe's device.
    pub fn new(gpu: &RenderState, scene: &Scene) -> Result<Self, Box<dyn Error>> {
        let size = [1, 1];
        Ok(Self {
            scene: GpuScene::new(&gpu.device, &gpu.queue, scene)?,
            films: Vec::new(),
            numbers: target(gpu, size, TextureFormat::Rgba32Float),
            size,
            index: 0,
            converged: 0,
            working: Arc::default(),
            gpu: gpu.clone(),
        })
    }

    /// Replaces the scene. If the other scene cannot be used, this one stays.
    pub fn set_scene(&mut self, scene: &Scene) -> Result<(), Box<dyn Error>> {
        self.scene = GpuScene::new(&self.gpu.device, &self.gpu.queue, scene)?;
        Ok(())
    }

    /// Provides one film of this size for each source, with these settings. A film that is no longer wanted becomes a film of
    /// another source and keeps its history, so that α turns constant without a break.
    pub fn arrange(&mut self, size: [u32; 2], wanted: &[(Source, Settings)]) -> Result<(), Box<dyn Error>> {
        if size != self.size {
            self.numbers = target(&self.gpu, size, TextureFormat::Rgba32Float);
            for film in &mut self.films {
                film.resize(&self.gpu, size)?;
            }
            self.size = size;
        }
        let is_wanted = |film: &Film| wanted.iter().any(|(source, _)| *source == film.source);
        for (source, _) in wanted {
            if self.films.iter().any(|film| film.source == *source) {
                continue;
            }
            match self.films.iter_mut().find(|film| !is_wanted(film)) {
                Some(idle) => idle.source = *source,
                None => self.films.push(Film::new(&self.gpu, size, *source)?),
            }
        }
        let (kept, dropped): (Vec<_>, Vec<_>) = std::mem::take(&mut self.films).into_iter().partition(is_wanted);
        self.films = kept;
        for film in dropped {
            self.gpu.renderer.write().free_texture(&film.id);
        }
        for film in &mut self.films {
            let settings = wanted.iter().find(|(source, _)| *source == film.source).map(|(_, settings)| settings);
            if let Some(settings) = settings.filter(|settings| *settings != film.denoiser.settings()) {
                film.denoiser.set_settings(settings.clone())?;
            }
        }
        Ok(())
    }

    /// The film of a source.
    pub fn film(&self, source: Source) -> Option<&Film> {
        self.films.iter().find(|film| film.source == source)
    }

    /// Forgets all history.
    pub fn reset(&mut self) {
        self.films.iter_mut().for_each(|film| film.denoiser.reset());
    }

    /// Returns true while the GPU works on the last frame. Recording another frame meanwhile would only delay the picture.
    pub fn is_working(&self) -> bool {
        self.working.load(Ordering::Acquire)
    }

    /// Makes an encoder to record into.
    pub fn begin(&self) -> CommandEncoder {
        self.gpu.device.create_command_encoder(&Default::default())
    }

    /// Records a frame of every film. A stopwatch measures the passes of its source.
    pub fn render(
        &mut self,
        encoder: &mut CommandEncoder,
        pose: &Pose,
        camera: Camera,
        mut stopwatch: Option<&mut Stopwatch>,
    ) -> Result<(), Box<dyn Error>> {
        let device = &self.gpu.device;
        self.scene.update(device, encoder, pose)?;
        for film in &mut self.films {
            let index = if film.converges() { self.converged } else { self.index };
            let frame = Frame::new(&self.scene, camera, index, &film.radiance);
            match stopwatch.as_mut().filter(|watch| watch.source == film.source) {
                Some(watch) => film.denoiser.stepwise(|pass, e| watch.stop(pass, e)).render(device, encoder, &frame)?,
                None => film.denoiser.render(device, encoder, &frame)?,
            }
        }
        self.index = self.index.wrapping_add(1);
        self.converged = self.converged.wrapping_add(1);
        Ok(())
    }

    /// Records more paths of the references while the frame stands still.
    pub fn converge(&mut self, encoder: &mut CommandEncoder, camera: Camera) -> Result<(), Box<dyn Error>> {
        for film in self.films.iter_mut().filter(|film| film.converges()) {
            let frame = Frame::new(&self.scene, camera, self.converged, &film.radiance);
            film.denoiser.render(&self.gpu.device, encoder, &frame)?;
        }
        self.converged = self.converged.wrapping_add(1);
        Ok(())
    }

    /// Records the picture of each film: a view of its last frame or, if the film has no such view, the denoised picture. Returns
    /// the reason in that case.
    pub fn develop(
        &mut self,
        encoder: &mut CommandEncoder,
        view: View,
        options: ViewOptions,
    ) -> Result<Option<String>, Box<dyn Error>> {
        let mut missing = None;
        for film in &mut self.films {
            let device = &self.gpu.device;
            let asked = film.source.view(view);
            match film.denoiser.show(device, encoder, asked, options, &film.picture) {
                Err(error @ asvgf::Error::NoView { .. }) => {
                    missing = Some(error.to_string());
                    let picture = film.source.view(View::Denoised);
                    film.denoiser.show(device, encoder, picture, options, &film.picture)?;
                }
                result => result?,
            }
        }
        Ok(missing)
    }

    /// Records the numbers of a view of a source's last frame into [`Embed::numbers`]. Returns false if there is no such view.
    pub fn show_numbers(
        &mut self,
        encoder: &mut CommandEncoder,
        source: Source,
        view: View,
    ) -> Result<bool, Box<dyn Error>> {
        let Some(film) = self.films.iter_mut().find(|film| film.source == source) else { return Ok(false) };
        let view = source.view(view);
        match film.denoiser.show(&self.gpu.device, encoder, view, ViewOptions::default(), &self.numbers) {
            Err(asvgf::Error::NoView { .. }) => Ok(false),
            result => Ok(result.map(|()| true)?),
        }
    }

    /// Submits everything to the GPU.
    pub fn submit(&mut self, encoder: CommandEncoder) {
        self.working.store(true, Ordering::Release);
        self.gpu.queue.submit([encoder.finish()]);
        let working = Arc::clone(&self.working);
        self.gpu.queue.on_submitted_work_done(move || working.store(false, Ordering::Release));
    }
}

impl Film {
    fn new(gpu: &RenderState, size: [u32; 2], source: Source) -> Result<Self, asvgf::Error> {
        // Timestamps of software adapters do not cover the work.
        let honest = gpu.device.adapter_info().device_type != DeviceType::Cpu;
        let timing = honest && gpu.device.features().contains(Features::TIMESTAMP_QUERY);
        let descriptor = DenoiserDescriptor { size, timing, views: true, ..Default::default() };
        let picture = target(gpu, size, TextureFormat::Rgba8Unorm);
        Ok(Self {
            source,
            denoiser: Denoiser::new(&gpu.device, &gpu.queue, &descriptor)?,
            radiance: target(gpu, size, TextureFormat::Rgba32Float),
            id: gpu.renderer.write().register_native_texture(&gpu.device, &picture, FilterMode::Nearest),
            picture,
        })
    }

    fn resize(&mut self, gpu: &RenderState, size: [u32; 2]) -> Result<(), asvgf::Error> {
        self.denoiser.resize(&gpu.device, size)?;
        self.radiance = target(gpu, size, TextureFormat::Rgba32Float);
        self.picture = target(gpu, size, TextureFormat::Rgba8Unorm);
        let mut renderer = gpu.renderer.write();
        renderer.update_egui_texture_from_wgpu_texture(&gpu.device, &self.picture, FilterMode::Nearest, self.id);
        Ok(())
    }

    fn converges(&self) -> bool {
        matches!(self.source, Source::Reference | Source::Witness)
    }
}

/// Makes a texture that the denoiser writes, egui or a shader samples, and a screenshot copies.
fn target(gpu: &RenderState, [width, height]: [u32; 2], format: TextureFormat) -> TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("demo target"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: TextureUsages::STORAGE_BINDING | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}
