//! Conversion of polygons to triangles.
//!
//! - Successive corners at the same place count once; the last corner precedes the first.
//! - A quad is split along the diagonal that lies inside. If both do, also in a quad that is not planar, it is split along the shorter
//!   one, or from the first corner if both have the same length.
//! - Larger polygons are clipped ear by ear (`earcut`), as seen along their own normal (Newell's sum over all edges), whatever their
//!   first corner.
//! - Edges that cross bound no area that could be found without new corners. The triangles that the clipping makes of such a polygon
//!   are drawn (a fan for more than [`MANY_CORNERS`] corners), and the caller warns.
//!
//! All computations are in `f64` relative to the first corner, so that a polygon far from the origin keeps all the digits of its
//! positions. The view along a coordinate axis keeps them too, so that corners on one line stay on it.

use earcut::Earcut;
use glam::DVec3;

use super::ring::{cross, insert_left_out, is_convex, is_tangled};

/// Polygons with more corners are examined before they are clipped.
const MANY_CORNERS: usize = 256;
/// Maximum number of corners of a polygon that is clipped. For one that winds like a spiral, the time grows with their square.
const MAX_CORNERS: usize = 1 << 17;
/// Areas below this fraction of a polygon's own are rounding errors.
const NEGLIGIBLE: f64 = 1e-6;

/// The result for a polygon.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Outcome {
    /// The triangles cover the polygon.
    Covered,
    /// Edges cross, so that the triangles cover it only roughly.
    Crossing,
    /// The polygon has no area, and there are no triangles.
    Flat,
    /// The polygon is neither convex nor small enough to be clipped. The triangles are a fan.
    Huge,
}

/// Splits polygons into triangles.
pub(super) struct Triangulator {
    earcut: Earcut<f64>,
    clipped: Vec<u32>,
}

impl Triangulator {
    pub fn new() -> Self {
        Self { earcut: Earcut::new(), clipped: Vec::new() }
    }

    /// Appends the triangles of a polygon as numbers of its corners, wound as the polygon is.
    pub fn split(&mut self, corners: &[[f32; 3]], triangles: &mut Vec<[u32; 3]>) -> Outcome {
        if corners.len() == 3 {
            triangles.push([0, 1, 2]);
            return Outcome::Covered;
        }
        let (numbers, ring) = distinct(corners);
        let numbered = |triangle: [usize; 3]| triangle.map(|at| numbers.get(at).copied().unwrap_or_default());
        match *ring {
            [] | [_] | [_, _] => Outcome::Flat,
            [_, _, _] => {
                triangles.push(numbered([0, 1, 2]));
                Outcome::Covered
            }
            [a, b, c, d] => {
                let Some((halves, outcome)) = split_quad([a, b, c, d]) else { return Outcome::Flat };
                triangles.extend(halves.map(numbered));
                outcome
            }
            _ => {
                let Some((normal, planar)) = normal(&ring) else { return Outcome::Flat };
                let ring: Vec<[f64; 2]> = ring.iter().map(|&corner| seen_along(normal, corner)).collect();
                let many = ring.len() > MANY_CORNERS;
                let outcome = if many && is_convex(&ring) {
                    self.fan(ring.len());
                    Outcome::Covered
                } else if many && is_tangled(&ring) {
                    self.fan(ring.len());
                    Outcome::Crossing
                } else if ring.len() > MAX_CORNERS {
                    self.fan(ring.len());
                    Outcome::Huge
                } else if self.clip(&ring) && planar {
                    Outcome::Covered
                } else {
                    Outcome::Crossing
                };
                let clipped = self.clipped.as_chunks::<3>().0.iter();
                triangles.extend(clipped.map(|triangle| numbered(triangle.map(|at| at as usize))));
                if self.clipped.is_empty() { Outcome::Flat } else { outcome }
            }
        }
    }

    /// Writes the triangles between the first corner and each edge to `clipped`.
    fn fan(&mut self, corners: usize) {
        self.clipped.clear();
        self.clipped.extend((2..corners as u32).flat_map(|corner| [0, corner - 1, corner]));
    }

    /// Clips a polygon in the plane into `clipped`. Returns true if the triangles cover its area.
    fn clip(&mut self, ring: &[[f64; 2]]) -> bool {
        self.clipped.clear();
        self.earcut.earcut(ring.iter().copied(), &[], &mut self.clipped);
        let area = |&[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a, b, c].map(|at| ring.get(at as usize).copied().unwrap_or_default());
            cross(a, b, c)
        };
        let mut covered = 0.0;
        for triangle in self.clipped.as_chunks_mut::<3>().0 {
            let signed = area(triangle);
            if signed < 0.0 {
                triangle.swap(1, 2);
            }
            covered += signed.abs();
        }
        insert_left_out(ring, &mut self.clipped);
        let first = ring.first().copied().unwrap_or_default();
        let own: f64 = ring.array_windows::<2>().map(|&[a, b]| cross(first, a, b)).sum();
        (covered - own).abs() <= 1e-4 * own
    }
}

/// The numbers and places of the corners that differ in place from the corner before, relative to the first.
fn distinct(corners: &[[f32; 3]]) -> (Vec<u32>, Vec<DVec3>) {
    let mut before = None;
    let mut kept: Vec<(u32, &[f32; 3])> =
        (0..).zip(corners).filter(|&(_, corner)| before.replace(corner) != Some(corner)).collect();
    while kept.len() > 1 && kept.first().map(|kept| kept.1) == kept.last().map(|kept| kept.1) {
        kept.pop();
    }
    let place = |corner: &[f32; 3]| DVec3::from(corner.map(f64::from));
    let first = corners.first().map(place).unwrap_or_default();
    kept.into_iter().map(|(number, corner)| (number, place(corner) - first)).unzip()
}

/// Twice the vector area of a polygon, and true if that tells the front. If the area cancels out, as in a bow tie, its largest part
/// replaces it. `None` if there is no area beyond rounding errors.
fn normal(ring: &[DVec3]) -> Option<(DVec3, bool)> {
    /// The area that a line of `f32` positions may have, as a fraction of its squared length.
    const LINE: f64 = 1e-7;
    let parts = || ring.array_windows::<2>().map(|[a, b]| a.cross(*b));
    let sum: DVec3 = parts().sum();
    let whole: f64 = parts().map(DVec3::length).sum();
    let square = ring.iter().map(|corner| corner.length_squared()).fold(0.0, f64::max);
    if whole <= LINE * square {
        return None;
    }
    if sum.length() > NEGLIGIBLE * whole {
        return Some((sum, true));
    }
    let largest = parts().max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?;
    Some((largest, false))
}

/// Drops the coordinate along which the plane is seen most squarely. The front is counter-clockwise.
fn seen_along(normal: DVec3, corner: DVec3) -> [f64; 2] {
    let size = normal.abs();
    let [u, v, facing] = if size.z >= size.x && size.z >= size.y {
        [corner.x, corner.y, normal.z]
    } else if size.x >= size.y {
        [corner.y, corner.z, normal.x]
    } else {
        [corner.z, corner.x, normal.y]
    };
    if facing < 0.0 { [v, u] } else { [u, v] }
}

/// The two triangles of a quad. `None` if it has no area.
fn split_quad(quad: [DVec3; 4]) -> Option<([[usize; 3]; 2], Outcome)> {
    const FROM_FIRST: [[usize; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
    const FROM_SECOND: [[usize; 3]; 2] = [[1, 2, 3], [1, 3, 0]];
    let [a, b, c, d] = quad;
    let (normal, _) = normal(&quad)?;
    // The smaller triangle on either side of each diagonal. Facing away from the front, its area is negative.
    let smaller = |halves: [[usize; 3]; 2]| {
        let area = |triangle: [usize; 3]| {
            let [a, b, c] = triangle.map(|at| quad.get(at).copied().unwrap_or_default());
            (b - a).cross(c - a).dot(normal) / normal.length_squared()
        };
        halves.map(area).into_iter().fold(f64::INFINITY, f64::min)
    };
    let [first, second] = [smaller(FROM_FIRST), smaller(FROM_SECOND)];
    if first > NEGLIGIBLE && second > NEGLIGIBLE {
        let [along_first, along_second] = [a.distance(c), b.distance(d)];
        let shorter = along_second < along_first * (1.0 - NEGLIGIBLE);
        return Some((if shorter { FROM_SECOND } else { FROM_FIRST }, Outcome::Covered));
    }
    let outcome = if first.max(second) < -NEGLIGIBLE { Outcome::Crossing } else { Outcome::Covered };
    Some((if second > first { FROM_SECOND } else { FROM_FIRST }, outcome))
}
