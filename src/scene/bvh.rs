//! Bounding volume hierarchies: obvhs builds them, this module lays them out for shaders/shared/traverse.wgsl.

use bytemuck::{Pod, Zeroable};
use glam::Vec3A;
use obvhs::{BvhBuildParams, aabb::Aabb, bvh2::Bvh2, bvh2::builder, triangle::Triangle};
use std::time::Duration;

/// A node as the shader reads it: the boxes of its two children (Aila and Laine 2009).
///
/// obvhs' own node is never cast: its size depends on a cargo feature that another crate may switch on.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Node {
    pub children: [Child; 2],
}

/// One child of a [`Node`].
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Child {
    pub low: [f32; 3],
    /// The number of a node, or [`leaf`].
    pub reference: u32,
    pub high: [f32; 3],
    pub pad: u32,
}

impl Child {
    /// A box that rays miss: a point so far away that only one direction in 10¹² leads there, to a leaf of nothing. An inverted
    /// box would not do, as a slab test that sorts its two distances takes it for everything.
    const UNREACHABLE: Self = Self { low: FAR, reference: LEAF, high: FAR, pad: 0 };
}

const FAR: [f32; 3] = [1.37e30, -0.71e30, 0.53e30];

/// Marks the reference of a leaf, as in shaders/shared/traverse.wgsl.
const LEAF: u32 = 0x8000_0000;
const COUNT_SHIFT: u32 = 27;
/// Rows, or instances, that a leaf's reference can number.
pub(crate) const LARGEST_FIRST: u32 = (1 << COUNT_SHIFT) - 2;
/// Triangles in a leaf: up to here a test of each is cheaper than another level.
const LEAF_TRIANGLES: u32 = 4;

/// Reference to a run of triangles, or to one instance.
fn leaf(first: u32, count: u32) -> u32 {
    LEAF | count << COUNT_SHIFT | first
}

/// A tree and the order in which its leaves list the primitives.
pub(crate) struct Tree {
    pub nodes: Vec<Node>,
    /// Primitive of each place in leaf order.
    pub order: Vec<u32>,
    /// Nodes on the longest way down: what a traversal's stack must hold.
    pub depth: u32,
    pub bounds: [[f32; 3]; 2],
}

/// What a tree's leaves refer to.
enum Leaves {
    /// Runs of triangles from this row on.
    Triangles(u32),
    /// Single instances.
    Instances,
}

/// A tree over triangles. Its nodes refer to each other from `first_node` on, to triangles from `first_row` on.
pub(crate) fn over_triangles(corners: &[[[f32; 3]; 3]], first_node: u32, first_row: u32) -> Tree {
    let triangles: Vec<Triangle> = corners
        .iter()
        .map(|t| Triangle { v0: Vec3A::from(t[0]), v1: Vec3A::from(t[1]), v2: Vec3A::from(t[2]) })
        .collect();
    // Without pre-splitting, so that each triangle has one row and one id.
    let params = BvhBuildParams { max_prims_per_leaf: LEAF_TRIANGLES, ..BvhBuildParams::medium_build() };
    let bvh = builder::build_bvh2_from_tris(&triangles, params, &mut Duration::default());
    lay_out(&bvh, triangles.len(), first_node, Leaves::Triangles(first_row))
}

/// A tree over the world-space boxes of instances, one per leaf.
pub(crate) fn over_instances(boxes: &[[[f32; 3]; 2]]) -> Tree {
    let boxes: Vec<Aabb> = boxes.iter().map(|b| Aabb::new(b[0].into(), b[1].into())).collect();
    let params = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::fast_build() };
    let bvh = builder::build_bvh2(&boxes, params, &mut Duration::default());
    lay_out(&bvh, boxes.len(), 0, Leaves::Instances)
}

fn lay_out(bvh: &Bvh2, primitives: usize, first_node: u32, leaves: Leaves) -> Tree {
    if primitives == 0 || bvh.nodes.is_empty() {
        let nodes = vec![Node { children: [Child::UNREACHABLE; 2] }];
        return Tree { nodes, order: Vec::new(), depth: 1, bounds: [[0.0; 3]; 2] };
    }
    let mut tree = Tree { nodes: Vec::new(), order: Vec::with_capacity(primitives), depth: 1, bounds: [[0.0; 3]; 2] };
    let root = bvh.nodes[0];
    tree.bounds = [root.aabb().min.to_array(), root.aabb().max.to_array()];
    tree.nodes.push(Node { children: [Child::UNREACHABLE; 2] });
    // (node of obvhs, where its box belongs: our node and side, depth)
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
            low: node.aabb().min.to_array(),
            high: node.aabb().max.to_array(),
            reference: first_node + tree.nodes.len() as u32,
            pad: 0,
        };
        if node.is_leaf() {
            let run = node.first_index as usize..(node.first_index + node.prim_count) as usize;
            let primitives = &bvh.primitive_indices[run];
            match leaves {
                Leaves::Triangles(first_row) => {
                    child.reference = leaf(first_row + tree.order.len() as u32, node.prim_count);
                }
                Leaves::Instances => child.reference = leaf(primitives[0], 1),
            }
            tree.order.extend_from_slice(primitives);
        } else {
            let ours = tree.nodes.len();
            tree.nodes.push(Node { children: [Child::UNREACHABLE; 2] });
            let first = node.first_index as usize;
            pending.push((first, ours, 0, depth + 1));
            pending.push((first + 1, ours, 1, depth + 1));
        }
        tree.nodes[parent].children[side] = child;
    }
    if root.is_leaf() {
        // Should a ray get to the other child, the same again does no harm: the end of the stack would.
        tree.nodes[0].children[1].reference = tree.nodes[0].children[0].reference;
    }
    tree
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(count: u32) -> Vec<[[f32; 3]; 3]> {
        (0..count)
            .map(|i| {
                let x = i as f32;
                [[x, 0.0, 0.0], [x + 0.9, 0.0, 0.0], [x, 1.0, (i % 7) as f32]]
            })
            .collect()
    }

    /// Visits the whole tree and checks that each child's box holds all that is below it.
    fn check(tree: &Tree, corners: &[[[f32; 3]; 3]], first_node: u32, first_row: u32) {
        let mut seen = vec![false; corners.len()];
        let mut pending = vec![0_usize];
        while let Some(index) = pending.pop() {
            for child in tree.nodes[index].children {
                if child.low == FAR {
                    assert!(child.reference & LEAF != 0, "a ray that gets here must not go round in circles");
                } else if child.reference & LEAF != 0 {
                    let (first, count) =
                        (child.reference & ((1 << COUNT_SHIFT) - 1), child.reference >> COUNT_SHIFT & 15);
                    for row in first..first + count {
                        let triangle = tree.order[(row - first_row) as usize] as usize;
                        assert!(!std::mem::replace(&mut seen[triangle], true));
                        for corner in corners[triangle] {
                            for axis in 0..3 {
                                assert!(child.low[axis] <= corner[axis] && corner[axis] <= child.high[axis]);
                            }
                        }
                    }
                } else {
                    pending.push((child.reference - first_node) as usize);
                }
            }
        }
        assert!(seen.iter().all(|&s| s));
    }

    #[test]
    fn every_triangle_is_in_one_leaf_inside_its_boxes() {
        for count in [1, 2, 3, 5, 1000] {
            let corners = grid(count);
            check(&over_triangles(&corners, 40, 7), &corners, 40, 7);
        }
    }

    #[test]
    fn a_tree_of_nothing_has_a_root_that_no_ray_enters() {
        let tree = over_triangles(&[], 0, 0);
        assert_eq!(tree.nodes.len(), 1);
        assert!(tree.nodes[0].children.iter().all(|c| c.low == FAR && c.reference == leaf(0, 0)));
    }

    #[test]
    fn a_thousand_triangles_at_one_point_make_a_tree_that_a_stack_can_hold() {
        let corners = vec![[[1.0, 2.0, 3.0]; 3]; 1000];
        let tree = over_triangles(&corners, 0, 0);
        check(&tree, &corners, 0, 0);
        assert!(tree.depth <= 60, "{}", tree.depth);
    }
}
