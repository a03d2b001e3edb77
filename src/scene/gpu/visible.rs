//! The part of a pose that paths can see.

use crate::scene::description::{Pose, WorldMatrix};

/// The part of a pose that paths can see. A camera that moves changes nothing here.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Visible {
    placed: Vec<WorldMatrix>,
    emission: Vec<[f32; 3]>,
    intensity: Vec<[f32; 3]>,
}

impl Visible {
    /// The visible part of a pose, given the nodes that hold something visible.
    pub fn new(pose: &Pose, nodes: impl Iterator<Item = usize>) -> Self {
        let placed = nodes.map(|node| pose.world[node]).collect();
        Self { placed, emission: pose.emission.clone(), intensity: pose.intensity.clone() }
    }

    /// True if everything stands in the same place.
    pub fn is_placed_as(&self, other: &Self) -> bool {
        self.placed == other.placed
    }

    /// True if all materials emit the same.
    pub fn emits_as(&self, other: &Self) -> bool {
        self.emission == other.emission
    }
}
