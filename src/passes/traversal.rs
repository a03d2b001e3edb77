//! Numbers that are compiled into shaders that follow rays.

/// The way in which rays find triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Traversal {
    /// Rays descend trees.
    Tree {
        /// Slots of the traversal's stack.
        stack: u32,
    },
    /// Rays test each triangle, see [`Feature::FewTriangles`](super::Feature::FewTriangles).
    Every {
        /// Number of triangles, a multiple of 8.
        triangles: u32,
    },
}

impl Default for Traversal {
    fn default() -> Self {
        Self::Tree { stack: 4 }
    }
}
