//! A scene, a denoiser and a target, and the frames that go through them.

use super::gpu::{Gpu, gpu};
use super::images::colors;
use super::statistics::Rgb;
use asvgf::scene::{GpuScene, Pose, Scene, builtin};
use asvgf::{Camera, Denoiser, DenoiserDescriptor, Error, Frame, Settings, Specialize, View, ViewOptions};
use wgpu::{CommandEncoder, TextureFormat, TextureView};

/// Frames per second of animations.
pub const RATE: f32 = 30.0;

fn denoiser(gpu: &Gpu, size: [u32; 2], settings: Settings, specialize: Specialize) -> Denoiser {
    let descriptor = DenoiserDescriptor { size, settings, views: true, specialize, ..Default::default() };
    Denoiser::new(&gpu.device, &gpu.queue, &descriptor).unwrap()
}

/// A denoiser at work on a scene.
pub struct Stage {
    pub gpu: &'static Gpu,
    pub scene: Scene,
    pub uploaded: GpuScene,
    pub denoiser: Denoiser,
    pub target: TextureView,
    /// Number of the next frame.
    pub index: u32,
    /// Replaces the scene's camera.
    pub camera: Option<Camera>,
}

impl Stage {
    /// Makes a stage for any scene.
    pub fn new(scene: Scene, size: [u32; 2], settings: Settings) -> Self {
        Self::on(gpu(), scene, size, settings)
    }

    /// Makes a stage for a built-in scene.
    pub fn built_in(name: &str, animation: &str, size: [u32; 2], settings: Settings) -> Self {
        Self::new(builtin::scene(name, animation).expect("a built-in scene"), size, settings)
    }

    /// Makes a stage on another device.
    pub fn on(gpu: &'static Gpu, scene: Scene, size: [u32; 2], settings: Settings) -> Self {
        let uploaded = GpuScene::new(&gpu.device, &gpu.queue, &scene).unwrap();
        let denoiser = denoiser(gpu, size, settings, Specialize::Exactly);
        let target = gpu.target(size, TextureFormat::Rgba32Float);
        Self { gpu, scene, uploaded, denoiser, target, index: 0, camera: None }
    }

    /// Returns the same stage before its first frame, with nothing left out: a scene that stands still is checked for changes too.
    pub fn leaving_nothing_out(self) -> Self {
        let (size, settings) = (self.denoiser.size(), self.denoiser.settings().clone());
        Self { denoiser: denoiser(self.gpu, size, settings, Specialize::Everything), ..self }
    }

    /// The pose of the animation in a frame.
    pub fn pose_at(&self, index: u32) -> Pose {
        self.scene.pose(Some(0), index as f32 / RATE)
    }

    /// The camera in a pose.
    pub fn camera_in(&self, pose: &Pose) -> Camera {
        if let Some(camera) = self.camera {
            return camera;
        }
        let node = self.scene.camera_node().expect("a scene with a camera");
        self.scene.camera_view(pose, node).expect("a camera that sees")
    }

    /// Records the next frame.
    pub fn record(&mut self, encoder: &mut CommandEncoder) -> Result<(), Error> {
        let pose = self.pose_at(self.index);
        self.record_pose(encoder, &pose)
    }

    /// Records the next frame in a pose.
    pub fn record_pose(&mut self, encoder: &mut CommandEncoder, pose: &Pose) -> Result<(), Error> {
        self.uploaded.update(&self.gpu.device, encoder, pose).unwrap();
        let camera = self.camera_in(pose);
        let frame = Frame::new(&self.uploaded, camera, self.index, &self.target);
        self.denoiser.render(&self.gpu.device, encoder, &frame)?;
        self.index += 1;
        Ok(())
    }

    /// Renders the next frame.
    pub fn frame(&mut self) -> &mut Self {
        let pose = self.pose_at(self.index);
        self.frame_in(&pose)
    }

    /// Renders the next frame in a pose.
    pub fn frame_in(&mut self, pose: &Pose) -> &mut Self {
        let gpu = self.gpu;
        gpu.submit(|encoder| self.record_pose(encoder, pose)).unwrap();
        self
    }

    /// Renders several frames.
    pub fn frames(&mut self, count: u32) -> &mut Self {
        for _ in 0..count {
            self.frame();
        }
        self
    }

    /// Changes the size of the image.
    pub fn resize(&mut self, size: [u32; 2]) {
        self.denoiser.resize(&self.gpu.device, size).unwrap();
        self.target = self.gpu.target(size, TextureFormat::Rgba32Float);
    }

    /// The content of the target.
    pub fn image(&self) -> Vec<Rgb> {
        colors(self.gpu, &self.target)
    }

    /// An intermediate image of the last frame, as numbers.
    pub fn view(&mut self, view: View) -> Vec<Rgb> {
        let target = self.gpu.target(self.denoiser.size(), TextureFormat::Rgba32Float);
        let gpu = self.gpu;
        gpu.submit(|encoder| self.denoiser.show(&gpu.device, encoder, view, ViewOptions::default(), &target)).unwrap();
        colors(gpu, &target)
    }

    /// The largest red channel of an intermediate image.
    pub fn largest(&mut self, view: View) -> f32 {
        self.view(view).iter().map(|c| c[0]).fold(f32::NEG_INFINITY, f32::max)
    }
}
