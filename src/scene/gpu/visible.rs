//! The part of a pose that paths can see.

use super::geometry::drawn::ShapeSource;
use crate::scene::description::{Pose, WorldMatrix};

/// The part of a pose that paths can see. A camera that moves changes nothing here.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Visible {
    placed: Vec<WorldMatrix>,
    /// Joints and weights of the meshes that change their shape.
    shapes: Vec<(Vec<WorldMatrix>, Vec<f32>)>,
    emission: Vec<[f32; 3]>,
    intensity: Vec<[f32; 3]>,
}

impl Visible {
    /// The visible part of a pose, given the nodes that hold something visible, and the sources of shapes that change.
    pub fn new<'a>(
        pose: &Pose,
        nodes: impl Iterator<Item = usize>,
        shapes: impl Iterator<Item = &'a ShapeSource>,
    ) -> Self {
        Self {
            placed: nodes.map(|node| pose.world[node]).collect(),
            shapes: shapes.map(|shape| shape.inputs(pose)).collect(),
            emission: pose.emission.clone(),
            intensity: pose.intensity.clone(),
        }
    }

    /// True if everything stands in the same place.
    pub fn is_placed_as(&self, other: &Self) -> bool {
        self.placed == other.placed
    }

    /// True if everything has the same shape.
    pub fn is_shaped_as(&self, other: &Self) -> bool {
        self.shapes == other.shapes
    }

    /// True if all materials emit the same.
    pub fn emits_as(&self, other: &Self) -> bool {
        self.emission == other.emission
    }
}
