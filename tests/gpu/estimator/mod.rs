//! The path tracer's mean against closed forms.

mod agreement;
mod area;
#[cfg(feature = "gltf")]
mod blinking;
mod clearcoat;
mod emissive_images;
mod furnace;
mod glass;
mod large;
mod materials;
mod normals;
mod paths;
mod punctual;

use crate::common::plane::{Pinhole, V, add, scale};
use crate::common::stage::Stage;
use crate::common::statistics::{Estimate, Rgb};
use asvgf::scene::Scene;
use asvgf::{Camera, Mode, Sampling, Settings, TracerSettings};

const SIZE: [u32; 2] = [24, 16];

/// Relative rounding error of some ten operations: arithmetic in f32, an 18-bit mantissa in between, and a normal of 30 bits.
const ROUNDING: f64 = 2e-4;

const SAMPLINGS: [Sampling; 3] = [Sampling::Both, Sampling::Lights, Sampling::Scattered];

/// A camera that looks down on the floor about the origin.
fn from_above() -> Camera {
    Camera { eye: [0.3, 3.0, 0.2], target: [0.3, 0.0, 0.2], up: [0.0, 0.0, -1.0], fov_y: 0.3, jitter: [0.0; 2] }
}

fn tracer(sampling: Sampling, bounces: u32) -> TracerSettings {
    TracerSettings { sampling, bounces, roulette: 1000, ..Default::default() }
}

/// Independent images of a scene at the start of its animation.
fn images(scene: Scene, camera: Camera, tracer: TracerSettings, count: u32) -> Vec<Vec<Rgb>> {
    let settings = Settings { mode: Mode::Noisy, tracer, ..Settings::adaptive() };
    let mut stage = Stage::new(scene, SIZE, settings);
    stage.camera = Some(camera);
    let pose = stage.pose_at(0);
    (0..count).map(|_| stage.frame_in(&pose).image()).collect()
}

/// Mean of a channel over the image, with the standard error from the differences between the images.
fn channel(images: &[Vec<Rgb>], channel: usize) -> Estimate {
    let mean = |image: &Vec<Rgb>| image.iter().map(|c| f64::from(c[channel])).sum::<f64>() / image.len() as f64;
    Estimate::of(&images.iter().map(mean).collect::<Vec<_>>())
}

/// The point of the floor, y = 0, that each pixel of [`from_above`] sees.
fn floor_points() -> Vec<V> {
    let camera = Pinhole::new(&from_above(), SIZE);
    (0..SIZE[1])
        .flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)))
        .map(|(x, y)| {
            let ray = camera.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
            add(camera.eye, scale(ray, -camera.eye[1] / ray[1]))
        })
        .collect()
}

/// Mean of a function over the visible floor.
fn over_floor(f: impl Fn(V) -> f64) -> f64 {
    let points = floor_points();
    points.iter().map(|&p| f(p)).sum::<f64>() / points.len() as f64
}
