//! Sizes of a scene in world space.

use glam::{DMat4, DVec3};

use crate::scene::description::{Pose, Scene};

impl Scene {
    /// Number of triangles that are drawn. A mesh counts once for each node that places it.
    pub fn triangle_count(&self) -> usize {
        self.nodes
            .iter()
            .flat_map(|node| &node.meshes)
            .filter_map(|&mesh| self.meshes.get(mesh))
            .map(|mesh| mesh.triangles.len())
            .sum()
    }

    /// Area of all placed triangles in square metres, one side counted.
    pub fn surface_area(&self, pose: &Pose) -> f64 {
        let mut twice = 0.0;
        self.for_each_triangle(pose, |[a, b, c]| twice += (b - a).cross(c - a).length());
        0.5 * twice
    }

    /// Smallest and largest corner of the box around all placed triangles; `None` without triangles.
    pub fn bounds(&self, pose: &Pose) -> Option<[[f64; 3]; 2]> {
        let mut bounds: Option<[DVec3; 2]> = None;
        self.for_each_triangle(pose, |corners| {
            let [low, high] = bounds.unwrap_or([corners[0]; 2]);
            bounds = Some(corners.iter().fold([low, high], |[low, high], &corner| [low.min(corner), high.max(corner)]));
        });
        bounds.map(|corners| corners.map(|corner| corner.to_array()))
    }

    /// Calls `visit` with the world-space corners of every placed triangle. Indices out of range are skipped.
    fn for_each_triangle(&self, pose: &Pose, mut visit: impl FnMut([DVec3; 3])) {
        for (number, (node, world)) in self.nodes.iter().zip(&pose.world).enumerate() {
            for &index in &node.meshes {
                let (Some(mesh), Some(shape)) = (self.meshes.get(index), self.shape(pose, number, index)) else {
                    continue;
                };
                // Sums of many small areas and products of large coordinates need double precision.
                let in_world = node.skin.is_some() && mesh.is_skinned();
                let world = if in_world { DMat4::IDENTITY } else { DMat4::from_cols_array_2d(world) };
                let position = |vertex: u32| shape.positions.get(vertex as usize).copied().map(DVec3::from);
                let corner = |vertex: u32| Some(world.transform_point3(position(vertex)?));
                for &[a, b, c] in &mesh.triangles {
                    if let (Some(a), Some(b), Some(c)) = (corner(a), corner(b), corner(c)) {
                        visit([a, b, c]);
                    }
                }
            }
        }
    }
}
