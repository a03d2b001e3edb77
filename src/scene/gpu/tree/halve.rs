//! A tree for boxes that obvhs handles badly.

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::{Bvh2, node::Bvh2Node};

/// A tree that halves its boxes at each level, at the median of their centres along the longest side of the box around these. Its
/// depth is the least that so many leaves can have. obvhs makes a chain of boxes that coincide, and too deep a tree of some regular
/// grids. A leaf has `most` boxes at most.
pub(crate) fn halve(boxes: &[Aabb], most: usize) -> Bvh2 {
    let centers: Vec<Vec3A> = boxes.iter().map(Aabb::center).collect();
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    let bounds = |run: &[u32]| run.iter().fold(Aabb::empty(), |all, &i| all.union(&boxes[i as usize]));
    let mut nodes = vec![Bvh2Node::new(bounds(&order), order.len() as u32, 0)];
    let mut pending = vec![0];
    while let Some(index) = pending.pop() {
        let (first, count) = (nodes[index].first_index as usize, nodes[index].prim_count as usize);
        if count <= most {
            continue;
        }
        nodes[index].prim_count = 0;
        nodes[index].first_index = nodes.len() as u32;
        let run = &mut order[first..first + count];
        let [low, high] = run.iter().fold([Vec3A::INFINITY, Vec3A::NEG_INFINITY], |[low, high], &i| {
            [low.min(centers[i as usize]), high.max(centers[i as usize])]
        });
        let axis = (high - low).max_position();
        run.select_nth_unstable_by(count / 2, |&a, &b| centers[a as usize][axis].total_cmp(&centers[b as usize][axis]));
        let middle = first + count / 2;
        for run in [first..middle, middle..first + count] {
            pending.push(nodes.len());
            nodes.push(Bvh2Node::new(bounds(&order[run.clone()]), run.len() as u32, run.start as u32));
        }
    }
    Bvh2 { nodes, primitive_indices: order, ..Default::default() }
}
