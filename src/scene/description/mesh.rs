//! Triangles.

/// Triangles that share a material. Indices address all the vertex arrays alike.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Name for messages and debugging; may be empty.
    pub name: String,
    /// Vertex positions in object space.
    pub positions: Vec<[f32; 3]>,
    /// Shading normals, one per vertex, or empty: then the geometric normal of each triangle is used.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, one per vertex, or empty: set 0 and set 1.
    pub uvs: [Vec<[f32; 2]>; 2],
    /// Linear colour and opacity, each 0…1, one per vertex, or empty: then white. They multiply the base colour.
    pub colors: Vec<[f32; 4]>,
    /// Vertex indices, three per triangle, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// Index into [`Scene::materials`].
    pub material: usize,
}
