//! The numbered vectors of an OBJ file.

/// The vectors of a file, by their numbers in faces.
#[derive(Default)]
pub(super) struct Vectors {
    /// Positions relative to `offset`. NaN if the statement cannot be read.
    pub positions: Vec<[f32; 3]>,
    /// Origin of positions, once there is one. Without it, steps of f32 at survey coordinates (500 000, 4 500 000) would be as large as
    /// bricks.
    pub offset: Option<[f32; 3]>,
    /// Texture coordinates as in the file, where v grows upwards. 0 if the statement cannot be read.
    pub uvs: Vec<[f32; 2]>,
    /// Unit normals, or 0 if the statement cannot be read.
    pub normals: Vec<[f32; 3]>,
}
