//! Nodes and references as shaders/shared/traverse.wgsl reads them.

use bytemuck::{Pod, Zeroable};
use std::ops::Range;

/// A node as the shader reads it: the boxes of its two children (Aila and Laine 2009), each with its reference.
///
/// A node of obvhs is never cast, because its size depends on a cargo feature that another crate may enable.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Node {
    pub children: [Child; 2],
}

/// One child of a [`Node`]: its box on the tree's [`Quantization`](super::Quantization), and its reference, which is the number of a
/// node or a [`leaf`]. A word of the box holds two numbers: low x and y, low z and high x, high y and z.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Child {
    pub bounds: [u32; 3],
    pub reference: u32,
}

impl Child {
    /// An empty leaf at the corner of the tree.
    pub const EMPTY: Self = Self { bounds: [0; 3], reference: LEAF | 1 };
}

/// The mark of a leaf's reference, as in shaders/shared/traverse.wgsl.
pub(crate) const LEAF: u32 = 0x8000_0000;
pub(crate) const COUNT_SHIFT: u32 = 27;
/// Number of rows, or of instances, that the reference of a leaf can address.
pub(crate) const LARGEST_FIRST: u32 = (1 << COUNT_SHIFT) - 2;

/// The rows of a leaf's reference, or `None` for the reference of an inner node.
pub(crate) fn rows_of_leaf(reference: u32) -> Option<Range<u32>> {
    let first = reference & ((1 << COUNT_SHIFT) - 1);
    (reference & LEAF != 0).then(|| first..first + (reference >> COUNT_SHIFT & 15))
}

/// Reference to a run of triangles, or to one instance.
pub(crate) fn leaf(first: u32, count: u32) -> u32 {
    LEAF | count << COUNT_SHIFT | first
}
