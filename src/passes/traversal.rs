//! The numbers that shaders which follow rays are compiled with.

/// The way in which rays find triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Traversal {
    /// Down the trees.
    Tree {
        /// Slots of the traversal's stack.
        stack: u32,
    },
    /// By a test of each, see [`Feature::FewTriangles`](super::Feature::FewTriangles).
    Every {
        /// Number of the triangles, a multiple of 8.
        triangles: u32,
    },
}

impl Default for Traversal {
    fn default() -> Self {
        Self::Tree { stack: 4 }
    }
}
