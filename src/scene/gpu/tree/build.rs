//! Bounding volume hierarchies, which obvhs builds.

use super::halve::halve;
use super::layout::{Leaves, Tree, lay_out};
use glam::Vec3A;
use obvhs::bvh2::{Bvh2, leaf_collapser::collapse, reinsertion::ReinsertionOptimizer};
use obvhs::{BvhBuildParams, aabb::Aabb, ploc::PlocBuilder};
use std::collections::HashMap;

/// Maximum number of triangles in a leaf. Up to here, a test of each is cheaper than another level.
const LEAF_TRIANGLES: u32 = 2;

/// Maximum number of equal boxes for which obvhs builds the tree. It merges neighbours pair by pair, which takes quadratic time
/// if all are equally near.
const CROWD: usize = 1000;

/// True if more than [`CROWD`] boxes are equal.
fn is_crowded(boxes: &[Aabb]) -> bool {
    let mut crowds = HashMap::<[u32; 6], usize>::new();
    boxes.len() > CROWD
        && boxes.iter().any(|Aabb { min, max }| {
            let crowd = crowds.entry([min.x, min.y, min.z, max.x, max.y, max.z].map(f32::to_bits)).or_default();
            *crowd += 1;
            *crowd > CROWD
        })
}

/// A tree of at most `deepest` levels over boxes, of which a leaf has `most` at most: obvhs' own, or a halving one if obvhs' would be
/// deeper or take too long.
fn within(
    deepest: u32,
    boxes: &[Aabb],
    most: u32,
    build: impl FnOnce() -> Bvh2,
    lay_out: impl Fn(&Bvh2) -> Tree,
) -> Tree {
    let tree = (!is_crowded(boxes)).then(|| lay_out(&build())).filter(|tree| tree.depth <= deepest);
    tree.unwrap_or_else(|| lay_out(&halve(boxes, most as usize)))
}

/// A tree over triangles. Its nodes have numbers from `first_node` on, its triangles rows from `first_row` on.
pub(crate) fn over_triangles(corners: &[[[f32; 3]; 3]], first_node: u32, first_row: u32) -> Tree {
    let boxes = boxes_of(corners);
    let params = BvhBuildParams { max_prims_per_leaf: LEAF_TRIANGLES, ..BvhBuildParams::medium_build() };
    let lay_out = |bvh: &Bvh2| lay_out(bvh, boxes.len(), first_node, Leaves::Triangles(first_row));
    within(DEEPEST, &boxes, LEAF_TRIANGLES, || build(&all_unlike(&boxes), params), lay_out)
}

/// A tree of at most `deepest` levels over triangles, one in each leaf, whose rows are in the order of the triangles. It is built while
/// frames wait for it, in half the time of [`over_triangles`], and costs rays about 1 % more.
pub(crate) fn over_rows(corners: &[[[f32; 3]; 3]], first_node: u32, first_row: u32, deepest: u32) -> Tree {
    let boxes = boxes_of(corners);
    let params = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::fast_build() };
    let lay_out = |bvh: &Bvh2| lay_out(bvh, boxes.len(), first_node, Leaves::Single(first_row));
    within(deepest, &boxes, 1, || build(&all_unlike(&boxes), params), lay_out)
}

fn boxes_of(corners: &[[[f32; 3]; 3]]) -> Vec<Aabb> {
    corners.iter().map(|triangle| Aabb::from_points(&triangle.map(Vec3A::from))).collect()
}

/// The steps of obvhs' `build_bvh2`. That function also measures their time, with a clock that browsers lack.
fn build(boxes: &[Aabb], params: BvhBuildParams) -> Bvh2 {
    let BvhBuildParams { ploc_search_distance, sort_precision, search_depth_threshold, .. } = params;
    let order = (0..boxes.len() as u32).collect();
    let builder = &mut PlocBuilder::with_capacity(boxes.len());
    let mut bvh = builder.build(ploc_search_distance, boxes, order, sort_precision, search_depth_threshold);
    let mut optimizer = ReinsertionOptimizer::default();
    optimizer.run(&mut bvh, params.reinsertion_batch_ratio, None);
    collapse(&mut bvh, params.max_prims_per_leaf, params.collapse_traversal_cost);
    let ratio = params.reinsertion_batch_ratio * params.post_collapse_reinsertion_batch_ratio_multiplier;
    optimizer.run(&mut bvh, ratio, None);
    bvh
}

fn all_unlike(boxes: &[Aabb]) -> Vec<Aabb> {
    (0..).zip(boxes).map(|(number, &b)| unlike(b, number)).collect()
}

/// A box grown by up to a 4096th of its longest side, by a hash of its number. obvhs merges nearest neighbours. In regular grids all
/// are equally near, so that it would merge across the grid, and rays would meet five times as many boxes.
fn unlike(Aabb { min, max }: Aabb, number: u32) -> Aabb {
    let most = (max - min).max_element() / 4096.0;
    // A number of 24 bits for each side, by Knuth's multiplicative hash (The Art of Computer Programming 3, 6.4).
    let part =
        |side: u32| (number.wrapping_mul(6).wrapping_add(side).wrapping_mul(2_654_435_761) >> 8) as f32 / 16_777_216.0;
    let parts = |first: u32| Vec3A::new(part(first), part(first + 1), part(first + 2));
    Aabb { min: min - most * parts(0), max: max + most * parts(3) }
}

/// Maximum number of levels of a tree of obvhs. A deeper one is replaced by [`halve`]. Real geometry needs some thirty levels, and a traversal's
/// stack holds 64.
pub(crate) const DEEPEST: u32 = 48;

/// A tree over the world-space boxes of instances, one per leaf. Its nodes have numbers from `first_node` on.
///
/// Shaders are compiled with a stack for the trees of one pose. In another pose instances may gather at one place, of which obvhs
/// makes a chain: rays would run over the end of the stack and miss what lies there. A tree of more than `deepest` levels is therefore
/// replaced by [`halve`], which needs no more levels than any tree over as many instances.
pub(crate) fn over_instances(boxes: &[[[f32; 3]; 2]], first_node: u32, deepest: u32) -> Tree {
    let boxes: Vec<Aabb> = boxes.iter().map(|b| Aabb::new(b[0].into(), b[1].into())).collect();
    let build = || build(&boxes, BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::fast_build() });
    let lay_out = |bvh: &Bvh2| lay_out(bvh, boxes.len(), first_node, Leaves::Single(0));
    within(deepest, &boxes, 1, build, lay_out)
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::node::rows_of_leaf;
    use super::super::quantization::Quantization;
    use super::*;
    use obvhs::bvh2::builder;
    use std::time::Duration;

    fn grid(count: u32) -> Vec<[[f32; 3]; 3]> {
        (0..count)
            .map(|i| {
                let x = i as f32;
                [[x, 0.0, 0.0], [x + 0.9, 0.0, 0.0], [x, 1.0, (i % 7) as f32]]
            })
            .collect()
    }

    fn unquantize(grid: Quantization, words: [u32; 3]) -> ([f64; 3], [f64; 3]) {
        let number = |i: usize| f64::from(words[i / 2] >> (16 * (i % 2)) & 0xffff);
        let at = |i: usize| f64::from(grid.base[i % 3]) + number(i) * f64::from(grid.step[i % 3]);
        ([at(0), at(1), at(2)], [at(3), at(4), at(5)])
    }

    /// Visits the whole tree and checks that each child's box holds all that is below it.
    pub fn check(tree: &Tree, corners: &[[[f32; 3]; 3]], first_node: u32, first_row: u32) {
        let mut seen = vec![0; corners.len()];
        let mut pending = vec![0_usize];
        while let Some(index) = pending.pop() {
            for child in tree.nodes[index].children {
                let (low, high) = unquantize(tree.grid, child.bounds);
                if let Some(rows) = rows_of_leaf(child.reference) {
                    for row in rows {
                        let triangle = tree.order[(row - first_row) as usize] as usize;
                        seen[triangle] += 1;
                        for corner in corners[triangle] {
                            let inside = |axis: usize| (low[axis]..=high[axis]).contains(&f64::from(corner[axis]));
                            assert!([0, 1, 2].into_iter().all(inside), "{corner:?} is outside {low:?}…{high:?}");
                        }
                    }
                } else {
                    pending.push((child.reference - first_node) as usize);
                }
            }
        }
        // Each primitive is seen once; a tree of one leaf has it on both sides of its root.
        assert!(seen.iter().all(|&s| s == seen[0] && s <= 2));
    }

    #[test]
    fn every_triangle_is_in_one_leaf_inside_its_boxes() {
        for count in [1, 2, 3, 5, 1000] {
            let corners = grid(count);
            check(&over_triangles(&corners, 40, 7), &corners, 40, 7);
        }
    }

    #[test]
    fn trees_are_those_of_obvhs() {
        let boxes: Vec<Aabb> =
            grid(1000).iter().map(|[a, b, c]| Aabb::from_points(&[*a, *b, *c].map(Vec3A::from))).collect();
        for params in [BvhBuildParams::medium_build(), BvhBuildParams::fast_build()] {
            let [ours, theirs] = [build(&boxes, params), builder::build_bvh2(&boxes, params, &mut Duration::default())];
            assert_eq!(ours.primitive_indices, theirs.primitive_indices);
            let bytes = |bvh: &Bvh2| bytemuck::cast_slice::<_, u8>(&bvh.nodes).to_vec();
            assert!(bytes(&ours) == bytes(&theirs));
        }
    }

    #[test]
    fn instances_that_gather_make_a_tree_that_the_stack_of_another_pose_can_hold() {
        let at = |x: f32| [[x, 0.0, 0.0], [x + 0.5, 0.5, 0.5]];
        let apart: Vec<_> = (0..1000).map(|i| at(i as f32)).collect();
        let gathered = vec![at(7.0); 1000];
        let rest = over_instances(&apart, 0, DEEPEST).depth;
        assert!(over_instances(&gathered, 0, u32::MAX).depth > 64, "obvhs makes a chain of them");
        for boxes in [gathered, vec![at(7.0); 1001], apart] {
            let depth = over_instances(&boxes, 0, rest).depth;
            assert!(depth <= rest, "{depth} levels, {rest} at rest");
        }
    }

    #[test]
    fn a_tree_of_nothing_has_a_root_whose_leaves_are_empty() {
        let tree = over_triangles(&[], 0, 0);
        assert_eq!(tree.nodes.len(), 1);
        assert!(tree.nodes[0].children.iter().all(|c| rows_of_leaf(c.reference).is_some_and(|rows| rows.is_empty())));
    }

    /// The number of boxes that a ray through the root is expected to visit: the sum of their areas over the root's.
    fn cost(tree: &Tree) -> f64 {
        let area = |[low, high]: [[f64; 3]; 2]| {
            let [x, y, z] = [0, 1, 2].map(|axis| high[axis] - low[axis]);
            x * y + y * z + z * x
        };
        let children = tree.nodes.iter().flat_map(|node| node.children);
        let boxes = children.map(|child| unquantize(tree.grid, child.bounds)).map(|(low, high)| area([low, high]));
        boxes.sum::<f64>() / area(tree.bounds.map(|corner| corner.map(f64::from)))
    }

    /// The box of Cornell with each triangle cut into n², all of one shape.
    fn cut_box(n: u32) -> Vec<[[f32; 3]; 3]> {
        let scene = crate::scene::builtin::scene("cornell", "static").unwrap();
        let whole = scene.meshes.iter().flat_map(|m| m.triangles.iter().map(|t| t.map(|v| m.positions[v as usize])));
        let cut = |t: [[f32; 3]; 3]| {
            let at = move |i: u32, j: u32| {
                let weights = [n - i - j, i, j].map(|part| part as f32 / n as f32);
                [0, 1, 2].map(|axis| (0..3).map(|k| t[k][axis] * weights[k]).sum())
            };
            let upright = move |i, j| [at(i, j), at(i + 1, j), at(i, j + 1)];
            let turned = move |i, j| [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            let places = |rows: u32| (0..rows).flat_map(move |j| (0..rows - j).map(move |i| (i, j)));
            places(n).map(move |(i, j)| upright(i, j)).chain(places(n - 1).map(move |(i, j)| turned(i, j)))
        };
        whole.flat_map(cut).collect()
    }

    #[test]
    fn regular_grids_get_a_good_tree_however_they_are_cut() {
        // Ties between neighbours made the trees of 50² and 64² four and five times as costly as those of 51².
        let [usual, few, many] = [51, 50, 64].map(|n| {
            let corners = cut_box(n);
            let tree = over_triangles(&corners, 0, 0);
            check(&tree, &corners, 0, 0);
            cost(&tree)
        });
        println!("{usual:.1}; {few:.1}, {many:.1}");
        assert!(few < 1.2 * usual && many < 1.2 * usual, "{few}, {many} instead of {usual}");
    }

    #[test]
    fn a_million_triangles_at_one_point_make_a_tree_too() {
        let tree = over_triangles(&vec![[[1.0, 2.0, 3.0]; 3]; 1_000_000], 0, 0);
        assert!(tree.depth <= 30 && tree.order.len() == 1_000_000, "{}", tree.depth);
    }

    #[test]
    fn a_thousand_triangles_at_one_point_make_a_tree_that_a_stack_can_hold() {
        let corners = vec![[[1.0, 2.0, 3.0]; 3]; 1000];
        let tree = over_triangles(&corners, 0, 0);
        check(&tree, &corners, 0, 0);
        assert!(tree.depth <= 60, "{}", tree.depth);
    }
}
