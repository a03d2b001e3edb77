//! The lights that the Blinn–Phong gradient evaluates.

use super::record::GpuLight;
use crate::scene::gpu::emission::luminance::luminance;
use bytemuck::{Pod, Zeroable};

/// Maximum number of lights that the gradient evaluates. The strongest are kept.
const MOST: usize = 64;

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

/// The strongest of the lights, each with their number. An empty list gets one entry, because a binding is never empty.
pub(crate) fn strongest(mut lights: Vec<AnalyticLight>) -> Vec<AnalyticLight> {
    lights.sort_by(|a, b| luminance(b.intensity).total_cmp(&luminance(a.intensity)));
    lights.truncate(MOST);
    let count = lights.len() as u32;
    lights.resize(lights.len().max(1), AnalyticLight::default());
    lights.iter_mut().for_each(|light| light.count = count);
    lights
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::passes::{Feature, Features, gradient};
    use crate::twins::layout::{assert_layout_in, fields};

    #[test]
    fn a_light_lies_where_the_gradient_reads_it() {
        let fields = fields!(AnalyticLight: position, kind, axis, range, intensity, spot_scale, spot_offset, count);
        let blinn_phong = Features::of(&[Feature::BlinnPhong]);
        assert_layout_in(&gradient::PASS, blinn_phong, "AnalyticLight", fields, size_of::<AnalyticLight>());
    }

    #[test]
    fn the_strongest_lights_are_kept_and_counted() {
        let light = |strength: usize| AnalyticLight { intensity: [strength as f32; 3], ..Default::default() };
        let kept = strongest((0..100).map(light).collect());
        assert!(kept.iter().all(|light| light.count == 64));
        let strengths: Vec<f32> = kept.iter().map(|light| light.intensity[0]).collect();
        assert_eq!(strengths, (36..100).rev().map(|strength| strength as f32).collect::<Vec<_>>());
        assert!(matches!(strongest(Vec::new())[..], [AnalyticLight { count: 0, .. }]));
    }
}
