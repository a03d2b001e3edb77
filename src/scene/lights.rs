//! The list of everything that shines, in a fixed order with fixed probabilities.
//!
//! The temporal gradient compares paths that share their random numbers. A light must therefore keep its number and its
//! probability while it moves, dims or is switched off: both follow from the scene at rest with every light at its
//! nominal strength, and momentary strengths only enter the radiance.

use super::{Light, LightKind, Material, Pose};
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3};

/// Light kinds, as in shaders/shared/light.wgsl.
pub(crate) const EMITTER: u32 = 0;
pub(crate) const POINT: u32 = 1;
pub(crate) const DIRECTIONAL: u32 = 2;
pub(crate) const ENVIRONMENT: u32 = 3;

/// `Light` of shaders/shared/scene.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct GpuLight {
    pub kind: u32,
    pub alias: u32,
    pub threshold: f32,
    pub pmf: f32,
    pub position: [f32; 3],
    pub triangle: u32,
    pub axis: [f32; 3],
    pub instance: u32,
    pub intensity: [f32; 3],
    pub range: f32,
    pub spot_scale: f32,
    pub spot_offset: f32,
    pub pad: [u32; 2],
}

/// `AnalyticLight` of shaders/shared/blinn_phong.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct AnalyticLight {
    pub position: [f32; 3],
    pub kind: u32,
    pub axis: [f32; 3],
    pub range: f32,
    pub intensity: [f32; 3],
    pub spot_scale: f32,
    pub spot_offset: f32,
    pub count: u32,
    pub pad: [u32; 2],
}

impl From<GpuLight> for AnalyticLight {
    fn from(light: GpuLight) -> Self {
        Self {
            position: light.position,
            kind: light.kind,
            axis: light.axis,
            range: light.range,
            intensity: light.intensity,
            spot_scale: light.spot_scale,
            spot_offset: light.spot_offset,
            ..Default::default()
        }
    }
}

/// Relative luminance of linear Rec. 709 colour (ITU-R BT.709-6).
pub(crate) fn luminance(c: [f32; 3]) -> f64 {
    0.2126 * f64::from(c[0]) + 0.7152 * f64::from(c[1]) + 0.0722 * f64::from(c[2])
}

/// A light without area where its node's placement puts it, `factor` times as strong as described.
pub(crate) fn punctual(light: &Light, placement: Mat4, factor: [f32; 3]) -> GpuLight {
    let axis = placement.transform_vector3(Vec3::NEG_Z).normalize_or(Vec3::NEG_Z);
    // KHR_lights_punctual: intensity · saturate(cos·scale + offset)².
    let (kind, scale, offset) = match light.kind {
        LightKind::Directional => (DIRECTIONAL, 0.0, 1.0),
        LightKind::Point => (POINT, 0.0, 1.0),
        LightKind::Spot { inner, outer } => {
            let scale = 1.0 / (inner.cos() - outer.cos()).max(1e-3);
            (POINT, scale, -outer.cos() * scale)
        }
    };
    GpuLight {
        kind,
        position: placement.w_axis.truncate().to_array(),
        axis: axis.to_array(),
        intensity: [0, 1, 2].map(|c| light.intensity[c] * factor[c]),
        // Beyond 10¹⁸ its fourth power would overflow; there it never fades.
        range: light.range.clamp(1e-6, 1e9),
        spot_scale: scale,
        spot_offset: offset,
        ..Default::default()
    }
}

/// Power of a light without area, in a scene of this radius: what its probability is proportional to.
pub(crate) fn punctual_power(light: &Light, radius: f64) -> f64 {
    use std::f64::consts::PI;
    let intensity = luminance(light.intensity);
    match light.kind {
        LightKind::Directional => intensity * PI * radius * radius,
        LightKind::Point => intensity * 4.0 * PI,
        LightKind::Spot { outer, .. } => intensity * 2.0 * PI * (1.0 - f64::from(outer).cos()),
    }
}

/// Adds probabilities to a list of lights by their powers. A tenth is shared out evenly, so that a light that is weak
/// but near somewhere is not starved there.
pub(crate) fn assign_probabilities(lights: &mut [GpuLight], powers: &[f64]) {
    let total: f64 = powers.iter().sum();
    let count = lights.len() as f64;
    let weights: Vec<f64> =
        powers.iter().map(|p| if total > 0.0 { 0.9 * p / total + 0.1 / count } else { 1.0 }).collect();
    for (light, entry) in lights.iter_mut().zip(super::alias::table(&weights)) {
        light.alias = entry.alias;
        light.threshold = entry.threshold;
        light.pmf = entry.pmf;
    }
}

/// The triangles of one instance that share an emitting material, as the analytic gradient sees them.
#[derive(Debug, Default)]
pub(crate) struct Emitter {
    pub instance: usize,
    pub material: usize,
    /// Σ area · centre and Σ area · normal, in the space of the instance's tree.
    pub centre: Vec3,
    pub normal: Vec3,
    pub area: f32,
}

impl Emitter {
    pub fn add(&mut self, corners: [Vec3; 3], normal: Vec3) {
        let area = normal.length();
        self.centre += area * (corners[0] + corners[1] + corners[2]) / 3.0;
        self.normal += normal;
        self.area += area;
    }

    /// A flat emitter is a cosine lobe of radiance times area; one that is closed shows a quarter of its area from
    /// everywhere (Cauchy), like a point light. `placement` is the instance's.
    pub fn analytic(&self, materials: &[Material], pose: &Pose, placement: Mat4) -> AnalyticLight {
        let scale = placement.determinant().abs().powf(2.0 / 3.0);
        let (emissive, factor) = (materials[self.material].emissive, pose.emission[self.material]);
        let flat = self.normal.length() > 0.5 * self.area;
        let shown = if flat { self.normal.length() } else { self.area / 4.0 };
        AnalyticLight {
            position: placement.transform_point3(self.centre / self.area).to_array(),
            kind: if flat { EMITTER } else { POINT },
            axis: placement.transform_vector3(self.normal).normalize_or(Vec3::NEG_Y).to_array(),
            range: 1e9,
            intensity: [0, 1, 2].map(|c| emissive[c] * factor[c] * scale * shown),
            spot_scale: 0.0,
            spot_offset: 1.0,
            ..Default::default()
        }
    }
}
