//! Default light for scenes without any.

use asvgf::scene::{Environment, Scene};
use glam::Vec3;

/// True if the whole image would be black.
pub fn is_dark(scene: &Scene) -> bool {
    let placed = |mesh: usize| scene.nodes.iter().any(|node| node.meshes.contains(&mesh));
    let emits = |material: usize| scene.materials.get(material).is_some_and(|m| m.emissive.iter().any(|&x| x > 0.0));
    let emitter = scene.meshes.iter().enumerate().any(|(i, mesh)| emits(mesh.material) && placed(i));
    let lamp = scene.nodes.iter().filter_map(|node| scene.lights.get(node.light?)).any(|l| l.intensity != [0.0; 3]);
    scene.environment.is_none() && !emitter && !lamp
}

/// Returns a cloudy sky: bright above, brightest on one side so that shapes show, and a darker ground.
pub fn sky() -> Environment {
    let (width, height) = (512_u32, 256_u32);
    let brightest = Vec3::new(0.5, 0.7, 0.5).normalize();
    let texel = |i: u32| {
        let azimuth = ((i % width) as f32 + 0.5) / width as f32 * std::f32::consts::TAU - std::f32::consts::PI;
        let polar = ((i / width) as f32 + 0.5) / height as f32 * std::f32::consts::PI;
        let direction = Vec3::new(polar.sin() * azimuth.cos(), polar.cos(), polar.sin() * azimuth.sin());
        let (ground, horizon, zenith) = (Vec3::splat(0.2), Vec3::new(0.5, 0.53, 0.58), Vec3::new(0.7, 0.85, 1.1));
        let above = 1.0 - (1.0 - direction.y.clamp(0.0, 1.0)).powi(2);
        let below = (-direction.y * 4.0).clamp(0.0, 1.0);
        let glow = direction.dot(brightest).max(0.0).powi(8);
        (horizon.lerp(zenith, above).lerp(ground, below) + glow * Vec3::new(2.4, 2.2, 1.9)).to_array()
    };
    Environment { width, height, radiance: (0..width * height).map(texel).collect() }
}
