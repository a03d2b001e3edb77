//! A tree of obvhs, laid out for shaders/shared/traverse.wgsl.

use super::node::{Child, Node, leaf};
use super::quantization::Quantization;
use obvhs::bvh2::Bvh2;

/// A tree and the order in which its leaves list the primitives.
pub(crate) struct Tree {
    pub nodes: Vec<Node>,
    /// Primitive of each place in leaf order.
    pub order: Vec<u32>,
    /// Nodes on the longest way down, which a traversal's stack must hold.
    pub depth: u32,
    pub bounds: [[f32; 3]; 2],
    pub grid: Quantization,
}

/// The primitives of a tree's leaves.
pub(crate) enum Leaves {
    /// Runs of triangles, whose rows begin here.
    Triangles(u32),
    /// Single instances, or single triangles whose rows begin here in the order of the primitives.
    Single(u32),
}

pub(crate) fn lay_out(bvh: &Bvh2, primitives: usize, first_node: u32, leaves: Leaves) -> Tree {
    if primitives == 0 || bvh.nodes.is_empty() {
        let nodes = vec![Node { children: [Child::EMPTY; 2] }];
        let bounds = [[0.0; 3]; 2];
        return Tree { nodes, order: Vec::new(), depth: 1, bounds, grid: Quantization::over(bounds) };
    }
    let root = bvh.nodes[0];
    let bounds = [root.aabb().min.to_array(), root.aabb().max.to_array()];
    let grid = Quantization::over(bounds);
    let mut tree = Tree { nodes: Vec::new(), order: Vec::with_capacity(primitives), depth: 1, bounds, grid };
    tree.nodes.push(Node { children: [Child::EMPTY; 2] });
    // (node of obvhs, our node and side that get its box, depth)
    let mut pending: Vec<(usize, usize, usize, u32)> = if root.is_leaf() {
        vec![(0, 0, 0, 1)]
    } else {
        let first = root.first_index as usize;
        vec![(first, 0, 0, 1), (first + 1, 0, 1, 1)]
    };
    while let Some((index, parent, side, depth)) = pending.pop() {
        let node = bvh.nodes[index];
        tree.depth = tree.depth.max(depth);
        let mut child = Child {
            bounds: grid.quantize(node.aabb().min.to_array(), node.aabb().max.to_array()),
            reference: first_node + tree.nodes.len() as u32,
        };
        if node.is_leaf() {
            let run = node.first_index as usize..(node.first_index + node.prim_count) as usize;
            let primitives = &bvh.primitive_indices[run];
            match leaves {
                Leaves::Triangles(first_row) => {
                    child.reference = leaf(first_row + tree.order.len() as u32, node.prim_count);
                }
                Leaves::Single(first) => child.reference = leaf(first + primitives[0], 1),
            }
            tree.order.extend_from_slice(primitives);
        } else {
            let ours = tree.nodes.len();
            tree.nodes.push(Node { children: [Child::EMPTY; 2] });
            let first = node.first_index as usize;
            pending.push((first, ours, 0, depth + 1));
            pending.push((first + 1, ours, 1, depth + 1));
        }
        tree.nodes[parent].children[side] = child;
    }
    if root.is_leaf() {
        // A ray may reach the other child too, and the same leaf again does no harm.
        tree.nodes[0].children[1] = tree.nodes[0].children[0];
    }
    tree
}
