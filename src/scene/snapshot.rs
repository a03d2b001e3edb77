//! A scene in one pose, as far as paths can tell.

use super::{Pose, WorldMatrix};
use wgpu::{BindingResource, Buffer};

/// The scene as a denoiser rendered it last, from which it finds out what has moved since. The scene itself knows no last frame, because
/// several denoisers may show it, each in its own time.
#[derive(Debug)]
pub(crate) struct Snapshot {
    /// The scene's number in this process.
    pub scene: u64,
    /// Where what is seen stands, what emits and how strongly.
    pub visible: Visible,
    /// Placements of the instances: three rows of an affine matrix each.
    pub placements: Buffer,
    /// The lights that the Blinn–Phong gradient evaluates.
    pub analytic_lights: Buffer,
}

/// The part of a pose that paths can see. A camera that moves changes nothing here.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Visible {
    placed: Vec<WorldMatrix>,
    emission: Vec<[f32; 3]>,
    intensity: Vec<[f32; 3]>,
}

impl Visible {
    /// `nodes` are those with something to see.
    pub fn new(pose: &Pose, nodes: impl Iterator<Item = usize>) -> Self {
        let placed = nodes.map(|node| pose.world[node]).collect();
        Self { placed, emission: pose.emission.clone(), intensity: pose.intensity.clone() }
    }

    /// Whether everything stands where it stood.
    pub fn is_placed_as(&self, other: &Self) -> bool {
        self.placed == other.placed
    }

    /// Whether materials emit as they did.
    pub fn emits_as(&self, other: &Self) -> bool {
        self.emission == other.emission
    }
}

impl Snapshot {
    /// Whether it is of the same scene in the same pose.
    pub fn shows_the_same_as(&self, other: &Self) -> bool {
        self.scene == other.scene && self.visible == other.visible
    }

    /// What stands behind a binding that reads the last frame's scene.
    pub fn resource(&self, binding: &str) -> Option<BindingResource<'_>> {
        match binding {
            "placements_previous" => Some(self.placements.as_entire_binding()),
            "analytic_lights_previous" => Some(self.analytic_lights.as_entire_binding()),
            _ => None,
        }
    }
}
