//! Lights without area.

use super::record::{DIRECTIONAL, GpuLight, POINT};
use crate::scene::description::{Light, LightKind};
use crate::scene::gpu::emission::luminance::luminance;
use glam::{Mat4, Vec3};
use std::f64::consts::PI;

/// Longest range in metres. Shaders square it, and the square stays within f32. A light with this range does not fade within 10¹⁶ m.
pub(super) const LONGEST_RANGE: f32 = 1e18;

/// Least difference of the cosines between which a spot fades; cosines of f32 resolve a hundredth of it. The 10⁻³ of the extension's
/// sample code darkens spots whose half angle is below 2.6°, although the intensity is that inside the inner angle.
const LEAST_FADE: f64 = 1e-5;

/// A light without area and the node that places it.
#[derive(Debug)]
pub(crate) struct Punctual {
    pub node: usize,
    pub index: usize,
    pub light: Light,
}

/// The light after its node's placement, `factor` times as strong as described.
pub(crate) fn placed(light: &Light, placement: Mat4, factor: [f32; 3]) -> GpuLight {
    let axis = placement.transform_vector3(Vec3::NEG_Z).normalize_or(Vec3::NEG_Z);
    // KHR_lights_punctual: intensity · saturate(cos·scale + offset)².
    let (kind, scale, offset) = match light.kind {
        LightKind::Directional => (DIRECTIONAL, 0.0, 1.0),
        LightKind::Point => (POINT, 0.0, 1.0),
        LightKind::Spot { inner, outer } => {
            let [full, none] = [inner, outer].map(|angle| f64::from(angle).cos());
            let scale = 1.0 / (full - none).max(LEAST_FADE);
            (POINT, scale as f32, (-none * scale) as f32)
        }
    };
    GpuLight {
        kind,
        position: placement.w_axis.truncate().to_array(),
        axis: axis.to_array(),
        intensity: [0, 1, 2].map(|c| light.intensity[c] * factor[c]),
        range: light.range.clamp(1e-6, LONGEST_RANGE),
        spot_scale: scale,
        spot_offset: offset,
        ..Default::default()
    }
}

/// Power of the light in a scene of this radius. Its probability is proportional to it.
pub(crate) fn power(light: &Light, radius: f64) -> f64 {
    let intensity = luminance(light.intensity);
    match light.kind {
        LightKind::Directional => intensity * PI * radius * radius,
        LightKind::Point => intensity * 4.0 * PI,
        LightKind::Spot { outer, .. } => intensity * 2.0 * PI * (1.0 - f64::from(outer).cos()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(given: f32) -> f32 {
        let light = Light { kind: LightKind::Point, intensity: [1.0; 3], range: given };
        placed(&light, Mat4::IDENTITY, [1.0; 3]).range
    }

    #[test]
    fn a_light_without_a_range_does_not_fade() {
        let range = range(f32::INFINITY);
        for distance in [1.0_f32, 1e6, 1e10, 1e15] {
            // The formulas of light.wgsl and blinn_phong.wgsl.
            let paths = distance / range;
            let gradient = distance * distance / (range * range);
            assert!((range * range).is_finite());
            assert_eq!((1.0 - paths * paths * paths * paths, 1.0 - gradient * gradient), (1.0, 1.0), "{distance}");
        }
    }

    #[test]
    fn a_range_of_its_own_is_kept() {
        for given in [0.5, 3e9, 1e15] {
            assert_eq!(range(given), given);
        }
    }
}
