//! The numbered vectors of an OBJ file.

/// The vectors of a file, by the number that faces give them.
#[derive(Default)]
pub(super) struct Vectors {
    /// Relative to `offset`; NaN where a statement cannot be read.
    pub positions: Vec<[f32; 3]>,
    /// Where positions count from, once there is one: at survey coordinates (500 000, 4 500 000) steps of f32 are as large as bricks.
    pub offset: Option<[f32; 3]>,
    /// As in the file: v grows upwards. 0 where a statement cannot be read.
    pub uvs: Vec<[f32; 2]>,
    /// Unit vectors, or 0 where a statement cannot be read.
    pub normals: Vec<[f32; 3]>,
}
