//! Polygons in the plane.

use std::collections::{HashMap, HashSet};

/// Twice the area of a triangle, positive counter-clockwise.
pub(super) fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// True if a polygon of many corners is convex, and so can be a fan.
pub(super) fn is_convex(ring: &[[f64; 2]]) -> bool {
    let Some(&first) = ring.first() else { return false };
    let next = ring.iter().cycle();
    let corners = ring.iter().zip(next.clone().skip(1)).zip(next.skip(2));
    // All turns and all triangles of the fan are to the left, and no place occurs twice, so there is just one round.
    places(ring) == ring.len()
        && corners.into_iter().all(|((&a, &b), &c)| cross(a, b, c) >= 0.0)
        && ring.array_windows::<2>().all(|&[a, b]| cross(first, a, b) >= 0.0)
}

/// True if a polygon of many corners is surely not simple. Clipping ears would take very long to find that out.
pub(super) fn is_tangled(ring: &[[f64; 2]]) -> bool {
    places(ring) * 2 < ring.len() || has_crossing(ring)
}

/// Number of different places of the corners.
fn places(ring: &[[f64; 2]]) -> usize {
    ring.iter().map(|corner| corner.map(f64::to_bits)).collect::<HashSet<_>>().len()
}

/// Searches for crossing edges in a sweep along the first coordinate, which ends after some time.
fn has_crossing(ring: &[[f64; 2]]) -> bool {
    const TESTS_PER_EDGE: usize = 64;
    let mut left = ring.len() * TESTS_PER_EDGE;
    let mut edges: Vec<[[f64; 2]; 2]> = ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| [a, b]).collect();
    edges.sort_by(|a, b| a[0][0].min(a[1][0]).total_cmp(&b[0][0].min(b[1][0])));
    let mut active: Vec<[[f64; 2]; 2]> = Vec::new();
    for edge in edges {
        let start = edge[0][0].min(edge[1][0]);
        active.retain(|other| other[0][0].max(other[1][0]) >= start);
        left = left.saturating_sub(active.len());
        if left == 0 {
            return false;
        }
        if active.iter().any(|&other| cross_each_other(edge, other)) {
            return true;
        }
        active.push(edge);
    }
    false
}

/// True if two edges cross at a point that is an end of neither.
fn cross_each_other([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    cross(a, b, c) * cross(a, b, d) < 0.0 && cross(c, d, a) * cross(c, d, b) < 0.0
}

/// Restores corners that `earcut` leaves out because they lie on an edge, in the triangle at that edge. Neighbours may have a corner
/// there, and the corner may have texture coordinates of its own.
pub(super) fn insert_left_out(ring: &[[f64; 2]], triangles: &mut Vec<u32>) {
    let mut used = vec![false; ring.len()];
    for &corner in triangles.iter() {
        if let Some(used) = used.get_mut(corner as usize) {
            *used = true;
        }
    }
    let Some(start) = used.iter().position(|&used| used) else { return };
    if used.iter().all(|&used| used) {
        return;
    }
    let edges = |(number, triangle): (usize, &[u32; 3])| {
        let [a, b, c] = *triangle;
        [([a, b], number), ([b, c], number), ([c, a], number)]
    };
    let mut at_edge: HashMap<[u32; 2], usize> =
        triangles.as_chunks::<3>().0.iter().enumerate().flat_map(edges).collect();

    let count = ring.len();
    let mut run: Vec<u32> = Vec::new();
    let mut from = start as u32;
    for corner in (start + 1..=start + count).map(|corner| corner % count) {
        if used.get(corner) == Some(&false) {
            run.push(corner as u32);
            continue;
        }
        let to = corner as u32;
        if !run.is_empty()
            && in_order(ring, from, &run, to)
            && let Some(number) = at_edge.get(&[from, to]).copied()
        {
            split_at_edge(triangles, number, [from, to], &run, &mut at_edge);
        }
        run.clear();
        from = to;
    }
}

/// True if the corners between two lie between them in order.
fn in_order(ring: &[[f64; 2]], from: u32, run: &[u32], to: u32) -> bool {
    let place = |at: u32| ring.get(at as usize).copied().unwrap_or_default();
    let [a, b] = [place(from), place(to)];
    let along = |at: u32| (place(at)[0] - a[0]) * (b[0] - a[0]) + (place(at)[1] - a[1]) * (b[1] - a[1]);
    let order: Vec<f64> = std::iter::once(from).chain(run.iter().copied()).chain([to]).map(along).collect();
    order.is_sorted_by(|before, after| before < after)
}

/// Replaces the triangle at an edge by a fan over the corners on the edge.
fn split_at_edge(
    triangles: &mut Vec<u32>,
    number: usize,
    [from, to]: [u32; 2],
    run: &[u32],
    at_edge: &mut HashMap<[u32; 2], usize>,
) {
    let Some(triangle) = triangles.as_chunks_mut::<3>().0.get_mut(number) else { return };
    let Some(&apex) = triangle.iter().find(|&&corner| corner != from && corner != to) else { return };
    let stops: Vec<u32> = std::iter::once(from).chain(run.iter().copied()).chain([to]).collect();
    let mut fan = stops.array_windows::<2>().map(|&[a, b]| [apex, a, b]);
    if let Some(first) = fan.next() {
        *triangle = first;
    }
    for piece in fan {
        // The last piece has the edge of the triangle that the first had before.
        at_edge.insert([piece[2], apex], triangles.len() / 3);
        triangles.extend(piece);
    }
}
