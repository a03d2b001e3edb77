//! The parts of a scene that change the shape of a mesh: morph targets, and skins that follow joints.

use super::node::Matrix;

/// Offsets that are added to some vertices of a [`Mesh`](super::Mesh), times a weight of the node that draws it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MorphTarget {
    /// The vertices that move, each at most once.
    pub vertices: Vec<u32>,
    /// Offset of each of these vertices; empty if none moves.
    pub positions: Vec<[f32; 3]>,
    /// Offset of the shading normal of each of these vertices; empty if none turns.
    pub normals: Vec<[f32; 3]>,
    /// Offset of the tangent of each of these vertices; empty if none turns.
    pub tangents: Vec<[f32; 3]>,
}

/// The part that one joint has in the place of a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Influence {
    /// Index into [`Skin::joints`].
    pub joint: u32,
    /// Share of the joint. Shares are divided by their sum.
    pub weight: f32,
}

/// Nodes that a mesh follows like a skin its bones. A node that draws the mesh refers to it by [`Node::skin`](super::Node::skin).
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// Indices into [`Scene::nodes`](super::Scene::nodes).
    pub joints: Vec<usize>,
    /// For each joint the affine map from the space of the mesh to that of the joint.
    pub inverse_bind: Vec<Matrix>,
}
