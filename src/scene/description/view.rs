//! The cameras of a scene, placed.

use glam::DMat4;

use super::{Pose, Scene};
use crate::Camera;

impl Scene {
    /// The first node that holds a camera.
    pub fn camera_node(&self) -> Option<usize> {
        self.nodes.iter().position(|node| node.camera.is_some())
    }

    /// The camera of a node in a pose, without jitter. Its target is one metre ahead of the eye, and its `up` is a unit vector
    /// perpendicular to the view. `None` if the node has no camera or its matrix leaves no view direction (a scale of zero).
    pub fn camera_view(&self, pose: &Pose, node: usize) -> Option<Camera> {
        let camera = self.cameras.get(self.nodes.get(node)?.camera?)?;
        let world = DMat4::from_cols_array_2d(pose.world.get(node)?);
        let eye = world.w_axis.truncate();
        let forward = (-world.z_axis.truncate()).try_normalize()?;
        let up = world.y_axis.truncate();
        let up = (up - forward * up.dot(forward)).try_normalize()?;
        Some(Camera {
            eye: eye.to_array(),
            target: (eye + forward).to_array(),
            up: up.as_vec3().to_array(),
            fov_y: camera.fov_y,
            jitter: [0.0; 2],
        })
    }
}
