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
    material: usize,
    /// Means of the material's image over the triangles.
    means: Vec<Vec3>,
    /// Σ area · brightness · centre and Σ area · normal, in the space of the instance's tree.
    centre: Vec3,
    normal: Vec3,
    area: f32,
    /// Σ area · mean, and Σ area · brightness.
    light: Vec3,
    weight: f32,
}

impl Emitter {
    /// No triangle yet.
    pub fn new(instance: usize, material: usize) -> Self {
        Self { instance, material, ..Default::default() }
    }

    /// Replaces the triangles by as many others, each with its three corners.
    pub fn reshape(&mut self, triangles: impl Iterator<Item = [Vec3; 3]>) {
        let means = std::mem::take(&mut self.means);
        *self = Self::new(self.instance, self.material);
        let triangles = triangles.zip(means);
        triangles.for_each(|([a, b, c], mean)| self.add([a, b, c], 0.5 * (b - a).cross(c - a), mean));
    }

    /// Adds a triangle over which the material's image has this mean.
    pub fn add(&mut self, corners: [Vec3; 3], normal: Vec3, mean: Vec3) {
        let area = normal.length();
        let weight = area * mean.max_element();
        self.means.push(mean);
        self.centre += weight * (corners[0] + corners[1] + corners[2]) / 3.0;
        self.normal += normal;
        self.area += area;
        self.light += area * mean;
        self.weight += weight;
    }

    /// The light after the instance's placement. A flat emitter is a cosine lobe of mean radiance times area. A closed one shows a
    /// quarter of its area in every direction (Cauchy), like a point light.
    pub fn analytic(&self, materials: &[Material], pose: &Pose, placement: Mat4) -> AnalyticLight {
        let scale = placement.determinant().abs().powf(2.0 / 3.0);
        let (emissive, factor) = (materials[self.material].emissive, pose.emission[self.material]);
        let flat = self.normal.length() > 0.5 * self.area;
        let shown = if flat { self.normal.length() } else { self.area / 4.0 };
        let mean = self.light / self.area.max(f32::MIN_POSITIVE);
        AnalyticLight {
            position: placement.transform_point3(self.centre / self.weight.max(f32::MIN_POSITIVE)).to_array(),
            kind: if flat { EMITTER } else { POINT },
            axis: placement.transform_vector3(self.normal).normalize_or(Vec3::NEG_Y).to_array(),
            range: LONGEST_RANGE,
            intensity: [0, 1, 2].map(|c| emissive[c] * factor[c] * mean[c] * scale * shown),
            spot_scale: 0.0,
            spot_offset: 1.0,
            ..Default::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of area 1 around a place, of two triangles that face +Y.
    fn square([x, z]: [f32; 2]) -> [[Vec3; 3]; 2] {
        let corner = |dx: f32, dz: f32| Vec3::new(x + dx, 0.0, z + dz);
        let [a, b, c, d] = [corner(-0.5, -0.5), corner(-0.5, 0.5), corner(0.5, 0.5), corner(0.5, -0.5)];
        [[a, b, c], [a, c, d]]
    }

    #[test]
    fn the_light_is_the_mean_of_the_image_where_it_is_bright() {
        let materials = [Material { emissive: [4.0, 2.0, 1.0], ..Default::default() }];
        let pose = Pose { emission: vec![[1.0; 3]], ..Default::default() };
        let mut emitter = Emitter::new(0, 0);
        let mut add = |place, mean: Vec3| {
            for corners in square(place) {
                emitter.add(corners, 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]), mean);
            }
        };
        add([0.0, 0.0], Vec3::ZERO);
        add([3.0, 1.0], Vec3::new(0.5, 1.0, 0.0));
        let light = emitter.analytic(&materials, &pose, Mat4::IDENTITY);
        // Radiance times area, summed over both squares.
        assert_eq!(light.intensity, [2.0, 2.0, 0.0]);
        assert!((Vec3::from(light.position) - Vec3::new(3.0, 0.0, 1.0)).length() < 1e-6, "{:?}", light.position);
        assert_eq!(light.axis, [0.0, 1.0, 0.0]);
        // A shape that changes keeps the means of its triangles.
        emitter.reshape([[0.0, 0.0], [5.0, 1.0]].into_iter().flat_map(square));
        let reshaped = emitter.analytic(&materials, &pose, Mat4::IDENTITY);
        assert_eq!(reshaped.intensity, light.intensity);
        assert!((Vec3::from(reshaped.position) - Vec3::new(5.0, 0.0, 1.0)).length() < 1e-6, "{:?}", reshaped.position);
    }
}
