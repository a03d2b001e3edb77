//! Nodes and references as shaders/shared/traverse.wgsl reads them.

use bytemuck::{Pod, Zeroable};

/// A node as the shader reads it: the boxes of its two children (Aila and Laine 2009), each with its reference.
///
/// obvhs' own node is never cast: its size depends on a cargo feature that another crate may switch on.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Node {
    pub children: [Child; 2],
}

/// One child of a [`Node`]: its box on the tree's [`Quantization`], two numbers in a word (low x and y; low z and high x; high
/// y and z), and the number of a node, or [`leaf`].
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Child {
    pub bounds: [u32; 3],
    pub reference: u32,
}

impl Child {
    /// A leaf of nothing at the corner of the tree.
    pub const EMPTY: Self = Self { bounds: [0; 3], reference: LEAF | 1 };
}

/// Marks the reference of a leaf, as in shaders/shared/traverse.wgsl.
pub(crate) const LEAF: u32 = 0x8000_0000;
pub(crate) const COUNT_SHIFT: u32 = 27;
/// Rows, or instances, that a leaf's reference can number.
pub(crate) const LARGEST_FIRST: u32 = (1 << COUNT_SHIFT) - 2;
/// Reference to a run of triangles, or to one instance.
pub(crate) fn leaf(first: u32, count: u32) -> u32 {
    LEAF | count << COUNT_SHIFT | first
}
