//! Triangles.

use super::{Influence, MorphTarget};

/// Triangles that share a material. One index addresses all vertex arrays.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Name for messages and debugging; may be empty.
    pub name: String,
    /// Vertex positions in object space.
    pub positions: Vec<[f32; 3]>,
    /// Shading normals, one per vertex. If empty, each triangle has its geometric normal.
    pub normals: Vec<[f32; 3]>,
    /// Tangents for normal maps, one per vertex: a direction, and ±1 for the bitangent `w · normal × tangent`, which points upwards in the
    /// image. If empty, MikkTSpace makes them. Meshes without normals ignore them.
    pub tangents: Vec<[f32; 4]>,
    /// Texture coordinates of set 0 and set 1, each one per vertex or empty.
    pub uvs: [Vec<[f32; 2]>; 2],
    /// Linear colour and opacity, each 0…1, one per vertex; white if empty. They multiply the base colour.
    pub colors: Vec<[f32; 4]>,
    /// Shapes that nodes mix into this one with weights of their own, see [`Node::weights`](super::Node::weights).
    pub targets: Vec<MorphTarget>,
    /// Joints that each vertex follows wherever a node has a [`skin`](super::Node::skin): as many for each vertex, those of the first vertex
    /// first, or none. A vertex whose weights are all 0 follows its first joint.
    pub influences: Vec<Influence>,
    /// Vertex indices, three per triangle, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// Index into [`Scene::materials`](super::Scene::materials).
    pub material: usize,
}
