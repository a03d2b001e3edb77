//! A furnace: convex surfaces of albedo ½ under a white sky reflect ½ in every pixel, whatever their shape, and the sky
//! is 1. Rays scattered by the cosine have no noise, so a single ray that hits the surface of its origin shows as a
//! dark pixel.

use crate::stability::common::scenes::{lambert, scene};
use crate::stability::common::stage::Stage;
use asvgf::scene::{Environment, GpuScene, Mesh, Scene};
use asvgf::{Camera, Mode, Sampling, Settings, TracerSettings, View};

/// A thousandth: albedo has 10 bits, radiance 18, the spatial filter's taps 10. All represent 1 and ½ exactly; weights
/// that sum to 1 do so only roughly.
pub const ROUNDING: f64 = 1e-3;

/// Returns grey meshes under a white sky.
pub fn grey(meshes: Vec<Mesh>) -> Scene {
    Scene { environment: Some(Environment::uniform([1.0; 3])), ..scene(vec![lambert([0.5; 3])], meshes) }
}

/// One denoiser for many scenes.
pub struct Furnace(Stage);

impl Furnace {
    pub fn new(size: [u32; 2]) -> Self {
        Self::in_mode(Mode::Denoise, size)
    }

    /// Makes a furnace whose images are filtered or not.
    pub fn in_mode(mode: Mode, size: [u32; 2]) -> Self {
        // One reflection, by scattered rays alone.
        let tracer = TracerSettings { bounces: 0, sampling: Sampling::Scattered, ..Default::default() };
        Self(Stage::new(grey(Vec::new()), size, Settings { mode, tracer, ..Settings::adaptive() }))
    }

    pub fn resize(&mut self, size: [u32; 2]) {
        self.0.resize(size);
    }

    /// Returns [`Furnace::farthest`], infinite if no pixel sees a surface.
    pub fn farthest_seen(&mut self, scene: Scene, frames: u32, camera: impl Fn(u32) -> Camera) -> f64 {
        let farthest = self.farthest(scene, frames, camera);
        self.if_seen(farthest)
    }

    /// Returns the largest distance of a pixel from 1 over frames, infinite if no pixel of the last one sees a surface.
    pub fn farthest_from_white(&mut self, scene: Scene, frames: u32, camera: impl Fn(u32) -> Camera) -> f64 {
        let farthest = self.largest(scene, frames, camera, |x| (x - 1.0).abs());
        self.if_seen(farthest)
    }

    /// Returns the number, infinite if no pixel sees a surface.
    fn if_seen(&mut self, farthest: f64) -> f64 {
        let sees = self.0.view(View::Depth).iter().any(|d| d[0] > 0.0);
        if sees { farthest } else { f64::INFINITY }
    }

    /// Returns the largest distance of a pixel from 1 and ½ over frames; `camera` returns the camera of each.
    pub fn farthest(&mut self, scene: Scene, frames: u32, camera: impl Fn(u32) -> Camera) -> f64 {
        self.largest(scene, frames, camera, |x| (x - 1.0).abs().min((x - 0.5).abs()))
    }

    /// Returns the radiance of the brightest pixel over frames.
    pub fn brightest(&mut self, scene: Scene, frames: u32, camera: impl Fn(u32) -> Camera) -> f64 {
        self.largest(scene, frames, camera, |x| x)
    }

    /// Returns the largest of a quantity of the pixels' radiance over frames.
    fn largest(
        &mut self,
        scene: Scene,
        frames: u32,
        camera: impl Fn(u32) -> Camera,
        quantity: impl Fn(f32) -> f32,
    ) -> f64 {
        let Self(stage) = self;
        stage.uploaded = GpuScene::new(&stage.gpu.device, &stage.gpu.queue, &scene).unwrap();
        stage.scene = scene;
        let mut worst = 0.0_f64;
        for frame in 0..frames {
            stage.camera = Some(camera(frame));
            let image = stage.frame().image();
            let each = image.iter().flatten().map(|x| f64::from(quantity(*x)));
            worst = each.fold(worst, |w, d| if d.is_nan() { f64::INFINITY } else { w.max(d) });
        }
        worst
    }
}
