//! The connected, closed surfaces among triangles.
//!
//! Corners with one position are one corner. A surface is closed if each edge is walked as often in one direction as in the other, and no
//! triangle is there twice, as in a sheet with two faces.

use std::collections::{HashMap, HashSet};
use std::f64::consts::PI;

use crate::scene::description::Mesh;

/// The triangles of a mesh by what they enclose.
#[derive(Default)]
pub(super) struct Divided {
    /// Triangles of skins, turned away from what the skin encloses.
    pub closed: Vec<[u32; 3]>,
    pub open: Vec<[u32; 3]>,
}

/// The triangles of several meshes.
pub(super) struct Skins {
    /// The corners of each mesh's triangles.
    triangles: Vec<Vec<[u32; 3]>>,
    /// The same as numbers of places, for all meshes.
    corners: Vec<[usize; 3]>,
    places: Vec<[f64; 3]>,
}

/// A connected surface.
#[derive(Default)]
struct Surface {
    triangles: Vec<usize>,
    is_closed: bool,
    /// Six times the volume inside, negative if the triangles look inwards.
    volume: f64,
    low: [f64; 3],
    high: [f64; 3],
}

impl Skins {
    pub fn new<'a>(meshes: impl Iterator<Item = &'a Mesh>) -> Self {
        let mut numbers = HashMap::new();
        let mut skins = Self { triangles: Vec::new(), corners: Vec::new(), places: Vec::new() };
        for mesh in meshes {
            let mut place = |position: &[f32; 3]| {
                // 0 and −0 are one place.
                *numbers.entry(position.map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
                    skins.places.push(position.map(f64::from));
                    skins.places.len() - 1
                })
            };
            let of_mesh: Vec<usize> = mesh.positions.iter().map(&mut place).collect();
            skins.corners.extend(mesh.triangles.iter().map(|corners| corners.map(|corner| of_mesh[corner as usize])));
            skins.triangles.push(mesh.triangles.clone());
        }
        skins
    }

    /// The triangles of each mesh.
    pub fn divide(&self) -> Vec<Divided> {
        let surfaces = self.surfaces();
        let mut turned = vec![None; self.corners.len()];
        for (index, surface) in surfaces.iter().enumerate().filter(|(_, surface)| surface.is_closed) {
            // A surface inside an odd number of others is the wall of something hollow.
            let around =
                surfaces.iter().enumerate().filter(|&(other, outer)| other != index && self.holds(outer, surface));
            let looks_outwards = around.count() % 2 == 0;
            let turns = looks_outwards != (surface.volume > 0.0);
            surface.triangles.iter().for_each(|&triangle| turned[triangle] = Some(turns));
        }
        let mut turned = turned.into_iter();
        let mut divided = Vec::new();
        for triangles in &self.triangles {
            let mut of_mesh = Divided::default();
            for (&[a, b, c], turns) in triangles.iter().zip(turned.by_ref()) {
                match turns {
                    None => of_mesh.open.push([a, b, c]),
                    Some(false) => of_mesh.closed.push([a, b, c]),
                    Some(true) => of_mesh.closed.push([a, c, b]),
                }
            }
            divided.push(of_mesh);
        }
        divided
    }

    /// The connected surfaces.
    fn surfaces(&self) -> Vec<Surface> {
        let mut parents: Vec<usize> = (0..self.places.len()).collect();
        for &[a, b, c] in &self.corners {
            for other in [b, c] {
                let (from, to) = (root(&mut parents, a), root(&mut parents, other));
                parents[from] = to;
            }
        }
        let mut numbers = HashMap::new();
        let mut surfaces: Vec<Surface> = Vec::new();
        for (triangle, &[a, ..]) in self.corners.iter().enumerate() {
            let number = *numbers.entry(root(&mut parents, a)).or_insert_with(|| {
                surfaces.push(Surface::default());
                surfaces.len() - 1
            });
            surfaces[number].triangles.push(triangle);
        }
        surfaces.iter_mut().for_each(|surface| self.measure(surface));
        surfaces
    }

    fn measure(&self, surface: &mut Surface) {
        let corners = || surface.triangles.iter().map(|&triangle| self.corners[triangle]);
        let origin = corners().next().map_or([0.0; 3], |[a, ..]| self.places[a]);
        let mut walks: HashMap<(usize, usize), i64> = HashMap::new();
        let mut seen = HashSet::new();
        let mut is_closed = true;
        let mut volume = 0.0;
        let (mut low, mut high) = (origin, origin);
        for [a, b, c] in corners() {
            if a == b || b == c || c == a {
                continue;
            }
            let mut sorted = [a, b, c];
            sorted.sort_unstable();
            is_closed &= seen.insert(sorted);
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *walks.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
            }
            let from_origin = [a, b, c].map(|place| [0, 1, 2].map(|axis| self.places[place][axis] - origin[axis]));
            volume += determinant(from_origin);
            for place in [a, b, c] {
                for axis in 0..3 {
                    low[axis] = low[axis].min(self.places[place][axis]);
                    high[axis] = high[axis].max(self.places[place][axis]);
                }
            }
        }
        surface.is_closed = is_closed && volume != 0.0 && walks.into_values().all(|balance| balance == 0);
        (surface.volume, surface.low, surface.high) = (volume, low, high);
    }

    /// True if a closed surface lies around another one.
    fn holds(&self, outer: &Surface, inner: &Surface) -> bool {
        let surrounds = |axis: usize| outer.low[axis] <= inner.low[axis] && inner.high[axis] <= outer.high[axis];
        if !outer.is_closed || !(0..3).all(surrounds) {
            return false;
        }
        let Some(&first) = inner.triangles.first() else { return false };
        let point = self.places[self.corners[first][0]];
        // The solid angle of all triangles is ±4π from inside and 0 from outside (Van Oosterom and Strackee 1983).
        let angles = outer.triangles.iter().map(|&triangle| {
            let [a, b, c] =
                self.corners[triangle].map(|place| [0, 1, 2].map(|axis| self.places[place][axis] - point[axis]));
            let [la, lb, lc] = [a, b, c].map(|v| dot(v, v).sqrt());
            2.0 * determinant([a, b, c]).atan2(la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)
        });
        angles.sum::<f64>().abs() > 2.0 * PI
    }
}

/// The representative of a place's surface, found by halving paths.
fn root(parents: &mut [usize], mut place: usize) -> usize {
    while parents[place] != place {
        parents[place] = parents[parents[place]];
        place = parents[place];
    }
    place
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}
