//! Trees over triangles that move: boxes are fitted to the triangles for each pose, and the tree is built anew once that has made it bad.

use super::build::{DEEPEST, over_rows};
use super::layout::Tree;
use super::node::{Child, Node, rows_of_leaf};
use super::quantization::Quantization;
use glam::Vec3A;
use obvhs::aabb::Aabb;

/// Growth of a tree's cost from which on it is built anew (compare Lauterbach et al. 2006, "RT-DEFORM: Interactive Ray Tracing of Dynamic
/// Scenes using BVHs"). Frames took 1.09 times as long at this growth, and 1.38 times at 2.5: docs/performance.md has the table.
const WORST_GROWTH: f32 = 1.5;

/// Levels that a later tree may have more than the first. A deeper one is replaced by one of the least depth.
const MORE_LEVELS: u32 = 4;

/// A tree over the rows of a mesh that changes its shape. Each leaf has one triangle, so that rows stay where they are.
#[derive(Debug)]
pub(crate) struct Fitted {
    pub nodes: Vec<Node>,
    pub first_node: u32,
    first_row: u32,
    /// Most levels that the tree may ever have.
    pub deepest: u32,
    pub bounds: [[f32; 3]; 2],
    pub grid: Quantization,
    /// Cost of the tree when it was built.
    cost: f32,
}

impl Fitted {
    /// A tree over triangles, of which there is one at least. Its nodes have numbers from `first_node` on, its triangles rows from
    /// `first_row` on.
    pub fn over(corners: &[[[f32; 3]; 3]], first_node: u32, first_row: u32) -> Self {
        let Tree { nodes, depth, bounds, grid, .. } = over_rows(corners, first_node, first_row, DEEPEST - MORE_LEVELS);
        let mut tree = Self { nodes, first_node, first_row, deepest: depth + MORE_LEVELS, bounds, grid, cost: 0.0 };
        tree.cost = tree.refit(corners);
        tree
    }

    /// Fits the tree to the same triangles in other places. Returns true if another tree took its place.
    pub fn fit(&mut self, corners: &[[[f32; 3]; 3]]) -> bool {
        let rebuilt = self.refit(corners) > WORST_GROWTH * self.cost;
        if rebuilt {
            self.nodes = over_rows(corners, self.first_node, self.first_row, self.deepest).nodes;
            self.cost = self.refit(corners);
        }
        rebuilt
    }

    /// Gives each box its new size, from the leaves to the root. Returns the tree's cost: the expected number of boxes that a ray
    /// through the root meets, which is the sum of their areas over the root's (Goldsmith and Salmon 1987). It is not a number if all
    /// triangles are at one point.
    fn refit(&mut self, corners: &[[[f32; 3]; 3]]) -> f32 {
        let leaf_box = |row: u32| {
            let triangle = corners[(row - self.first_row) as usize];
            Aabb::from_points(&triangle.map(Vec3A::from))
        };
        let mut boxes = vec![[Aabb::empty(); 2]; self.nodes.len()];
        let mut areas = 0.0;
        // A node has a smaller number than its children.
        for place in (0..self.nodes.len()).rev() {
            for (side, child) in self.nodes[place].children.into_iter().enumerate() {
                let bounds = match rows_of_leaf(child.reference) {
                    Some(mut rows) => rows.next().map_or(Aabb::empty(), leaf_box),
                    None => {
                        let [left, right] = boxes[(child.reference - self.first_node) as usize];
                        left.union(&right)
                    }
                };
                areas += bounds.half_area();
                boxes[place][side] = bounds;
            }
        }
        let root = boxes[0][0].union(&boxes[0][1]);
        self.bounds = [root.min.to_array(), root.max.to_array()];
        self.grid = Quantization::over(self.bounds);
        for (node, boxes) in self.nodes.iter_mut().zip(&boxes) {
            for (Child { bounds, .. }, Aabb { min, max }) in node.children.iter_mut().zip(boxes) {
                *bounds = self.grid.quantize(min.to_array(), max.to_array());
            }
        }
        areas / root.half_area()
    }
}

#[cfg(test)]
mod tests {
    use super::super::build::tests::check;
    use super::*;

    /// Triangles at places that follow from their numbers.
    fn strip(count: u32, place: impl Fn(u32) -> [f32; 3]) -> Vec<[[f32; 3]; 3]> {
        let at = |i: u32, corner: [f32; 3]| [0, 1, 2].map(|axis| place(i)[axis] + corner[axis]);
        (0..count).map(|i| [at(i, [0.0; 3]), at(i, [0.9, 0.0, 0.1]), at(i, [0.0, 1.0, 0.3])]).collect()
    }

    fn row(i: u32) -> [f32; 3] {
        [i as f32, 0.0, 0.0]
    }

    /// Neighbours far apart: the bits of the number reversed.
    fn mixed(i: u32) -> [f32; 3] {
        [(i.reverse_bits() >> 22) as f32, 0.0, 0.0]
    }

    fn as_tree(fitted: &Fitted, triangles: usize) -> Tree {
        let &Fitted { ref nodes, bounds, grid, .. } = fitted;
        Tree { nodes: nodes.clone(), order: (0..triangles as u32).collect(), depth: 0, bounds, grid }
    }

    #[test]
    fn boxes_hold_their_triangles_in_every_pose() {
        for count in [1, 2, 3, 1000] {
            let mut tree = Fitted::over(&strip(count, row), 40, 7);
            for step in 0..5 {
                let turned = |i: u32| {
                    let angle = step as f32 * 0.01 * i as f32;
                    [i as f32 * angle.cos(), i as f32 * angle.sin(), 3.0 * step as f32]
                };
                let corners = strip(count, turned);
                tree.fit(&corners);
                check(&as_tree(&tree, count as usize), &corners, 40, 7);
            }
        }
    }

    #[test]
    fn a_tree_is_built_anew_once_its_boxes_overlap() {
        let (rest, apart) = (strip(1024, row), strip(1024, mixed));
        let mut tree = Fitted::over(&rest, 0, 0);
        let nodes = tree.nodes.len();
        // A shift and a stretch are no reason.
        assert!(!tree.fit(&strip(1024, |i| [2.0 * i as f32, 5.0, 0.0])));
        let best = Fitted::over(&apart, 0, 0).cost;
        assert!(tree.refit(&apart) > 10.0 * best);
        assert!(tree.fit(&apart) && tree.cost < 1.05 * best, "{} instead of {best}", tree.cost);
        check(&as_tree(&tree, 1024), &apart, 0, 0);
        assert!(!tree.fit(&apart), "one new tree for a shape");
        assert_eq!(tree.nodes.len(), nodes, "the place of the nodes is of one size");
    }

    #[test]
    fn triangles_at_one_point_keep_their_tree() {
        let mut tree = Fitted::over(&strip(100, row), 0, 0);
        let gathered = vec![[[1.0, 2.0, 3.0]; 3]; 100];
        assert!(!tree.fit(&gathered));
        check(&as_tree(&tree, 100), &gathered, 0, 0);
        let mut tree = Fitted::over(&gathered, 0, 0);
        let rest = strip(100, row);
        tree.fit(&rest);
        check(&as_tree(&tree, 100), &rest, 0, 0);
    }
}
