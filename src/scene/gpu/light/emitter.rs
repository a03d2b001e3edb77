//! Triangles that emit, as the Blinn–Phong gradient sees them.

use super::analytic::AnalyticLight;
use super::punctual::LONGEST_RANGE;
use super::record::{EMITTER, POINT};
use crate::scene::description::{Material, Pose};
use glam::{Mat4, Vec3};

/// The triangles of one instance that share an emitting material, as one light.
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
    /// Replaces the triangles by others, each with its three corners.
    pub fn reshape(&mut self, triangles: impl Iterator<Item = [Vec3; 3]>) {
        *self = Self { instance: self.instance, material: self.material, ..Default::default() };
        triangles.for_each(|[a, b, c]| self.add([a, b, c], 0.5 * (b - a).cross(c - a)));
    }

    pub fn add(&mut self, corners: [Vec3; 3], normal: Vec3) {
        let area = normal.length();
        self.centre += area * (corners[0] + corners[1] + corners[2]) / 3.0;
        self.normal += normal;
        self.area += area;
    }

    /// The light after the instance's placement. A flat emitter is a cosine lobe of radiance times area. A closed one shows a quarter
    /// of its area in every direction (Cauchy), like a point light.
    pub fn analytic(&self, materials: &[Material], pose: &Pose, placement: Mat4) -> AnalyticLight {
        let scale = placement.determinant().abs().powf(2.0 / 3.0);
        let (emissive, factor) = (materials[self.material].emissive, pose.emission[self.material]);
        let flat = self.normal.length() > 0.5 * self.area;
        let shown = if flat { self.normal.length() } else { self.area / 4.0 };
        AnalyticLight {
            position: placement.transform_point3(self.centre / self.area.max(f32::MIN_POSITIVE)).to_array(),
            kind: if flat { EMITTER } else { POINT },
            axis: placement.transform_vector3(self.normal).normalize_or(Vec3::NEG_Y).to_array(),
            range: LONGEST_RANGE,
            intensity: [0, 1, 2].map(|c| emissive[c] * factor[c] * scale * shown),
            spot_scale: 0.0,
            spot_offset: 1.0,
            ..Default::default()
        }
    }
}
