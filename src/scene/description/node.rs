//! The hierarchy that places everything.

/// A column-major 4×4 matrix: `m[column][row]`, multiplying column vectors from the left.
pub type Matrix = [[f32; 4]; 4];

/// A [`Matrix`] in double precision. It places to a micrometre even thousands of kilometres from the origin.
pub type WorldMatrix = [[f64; 4]; 4];

/// The identity [`Matrix`].
pub const IDENTITY: Matrix = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// An element of the hierarchy.
#[derive(Clone, Debug, Default)]
pub struct Node {
    /// Name for messages and debugging; may be empty.
    pub name: String,
    /// Index of the parent node, smaller than this node's own; `None` for a root.
    pub parent: Option<usize>,
    /// Placement relative to the parent.
    pub transform: Transform,
    /// Meshes placed here (indices into [`Scene::meshes`](super::Scene::meshes)).
    pub meshes: Vec<usize>,
    /// Joints that place those meshes which have [`influences`](super::Mesh::influences), instead of this node (index into
    /// [`Scene::skins`](super::Scene::skins)).
    pub skin: Option<usize>,
    /// Weights of the morph targets of the meshes at rest. Missing ones are 0.
    pub weights: Vec<f32>,
    /// Light placed here, shining along −Z (index into [`Scene::lights`](super::Scene::lights)).
    pub light: Option<usize>,
    /// Camera placed here, looking along −Z with +Y up (index into [`Scene::cameras`](super::Scene::cameras)).
    pub camera: Option<usize>,
    /// True if the host moves this node, or changes its weights, although no animation does. Such a node is kept out of the static
    /// geometry.
    pub movable: bool,
}

/// Placement of a node relative to its parent. No variant will be added, because every affine placement is one of these.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transform {
    /// `translation · rotation · scale`; only these can be animated.
    Trs {
        /// Offset.
        translation: [f32; 3],
        /// Unit quaternion `[x, y, z, w]`.
        rotation: [f32; 4],
        /// Scale along the node's own axes; may be negative.
        scale: [f32; 3],
    },
    /// Any affine matrix, shear included.
    Matrix(Matrix),
}

impl Default for Transform {
    fn default() -> Self {
        Self::Trs { translation: [0.0; 3], rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] }
    }
}
