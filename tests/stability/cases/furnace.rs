//! A white furnace: white surfaces under a white sky reflect 1 in every pixel, whatever their shape, as does the sky itself. With
//! rays that are scattered by the cosine there is no noise, so that a single ray that meets the surface it left is seen as dark.

use crate::common::gpu::gpu;
use crate::common::scenes::{lambert, scene};
use crate::common::stage::Stage;
use asvgf::scene::{Environment, Mesh, Scene};
use asvgf::{Camera, Sampling, Settings, TracerSettings};

/// Albedo in f16, radiance in 18 bits, the spatial filter's taps in 10; all of 1 are exact, and weights that sum to 1 are not quite.
pub const ROUNDING: f64 = 1e-3;

/// White meshes under a white sky.
pub fn white(meshes: Vec<Mesh>) -> Scene {
    Scene { environment: Some(Environment::uniform([1.0; 3])), ..scene(vec![lambert([1.0; 3])], meshes) }
}

/// One reflection, by scattered rays alone.
pub fn settings() -> Settings {
    let tracer = TracerSettings { bounces: 0, sampling: Sampling::Scattered, ..Default::default() };
    Settings { tracer, ..Settings::adaptive() }
}

/// The farthest from 1 that any pixel is over frames; `camera` tells where each is seen from.
pub fn darkest(scene: Scene, size: [u32; 2], frames: u32, camera: impl Fn(u32) -> Camera) -> f64 {
    let mut stage = Stage::on(gpu(), scene, size, settings());
    let mut worst = 0.0_f64;
    for frame in 0..frames {
        stage.camera = Some(camera(frame));
        let image = stage.frame().image();
        let away = image.iter().flatten().map(|x| f64::from((x - 1.0).abs()));
        worst = away.fold(worst, |w, d| if d.is_nan() { f64::INFINITY } else { w.max(d) });
    }
    worst
}
