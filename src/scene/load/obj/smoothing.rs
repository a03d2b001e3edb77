//! Normals that a file leaves to the reader.
//!
//! Faces of one smoothing group share a vertex if they share its index, as the format says, also across materials and names. The normal
//! at the corner of a face is the mean over the faces there that meet this one at less than [`SPLIT`]. Each is weighted by its angle
//! at the vertex, so that the division of polygons into triangles does not matter (Thürmer and Wüthrich, "Computing vertex normals
//! from polygonal facets", Journal of Graphics Tools 3 (1), 1998).
//!
//! The format has no such angle, and three.js and Blender use none. Many exporters, however, put whole models into one group, and
//! without the angle boxes in them would look like pillows. Assimp's viewer uses 80° too. A cube keeps its edges, and a prism of five
//! or more sides is round.

use glam::DVec3;

use super::part::{Corner, NONE, Part};
use crate::scene::load::common::report::Fault;

/// Cosine of 80°: faces that meet at a larger angle have an edge between them.
const SPLIT: f64 = 0.173_648_177_666_930_35;
/// Maximum number of faces at a vertex that are compared with each other. With more, which would take too long, all faces of a group
/// count.
const MAX_COMPARED: usize = 128;

/// A corner of a face at a vertex.
struct Around {
    /// Number, counted over all parts.
    corner: u32,
    group: u32,
    /// Unit normal of the triangle, or 0 if it has no area.
    normal: DVec3,
    /// Angle of the triangle at the vertex.
    angle: f64,
}

/// Appends normals to `normals` for all corners of `parts` that need one and have none. Corners of faces without a smoothing group get the
/// normal of their triangle.
pub(super) fn fill(parts: &mut [Part], positions: &[[f32; 3]], normals: &mut Vec<[f32; 3]>) -> Result<(), Fault> {
    let too_many = || Fault::new("faces", "there are more than 2³² corners");
    let mut firsts = Vec::with_capacity(parts.len());
    let mut total = 0_usize;
    for part in parts.iter() {
        firsts.push(total as u32);
        total += if part.normals { part.triangles.len() * 3 } else { 0 };
        u32::try_from(total).map_err(|_| too_many())?;
    }
    let Open { starts, corners } = Open::of(parts, &firsts, positions.len());
    let mut around = Vec::new();
    let mut made = Vec::new();
    for vertex in starts.array_windows::<2>() {
        let [start, end] = vertex.map(|at| at as usize);
        let Some(corners) = corners.get(start..end).filter(|corners| !corners.is_empty()) else { continue };
        around.clear();
        around.extend(corners.iter().filter_map(|&corner| look(corner, parts, &firsts, positions)));
        around.sort_by_key(|around| (around.group, around.corner));
        for group in around.chunk_by(|a, b| a.group == b.group) {
            smooth(group, &mut made);
            for &(corner, normal) in &made {
                let unit = normal.as_vec3().to_array();
                // Neighbours have the same one.
                if normals.last() != Some(&unit) {
                    normals.push(unit);
                }
                let number = u32::try_from(normals.len() - 1).map_err(|_| too_many())?;
                if let Some(corner) = corner_mut(corner, parts, &firsts) {
                    corner[2] = number;
                }
            }
        }
    }
    Ok(())
}

/// Corners without normals, by vertex: those of vertex `i` are `corners[starts[i]..starts[i + 1]]`.
struct Open {
    starts: Vec<u32>,
    corners: Vec<u32>,
}

impl Open {
    fn of(parts: &[Part], firsts: &[u32], vertices: usize) -> Self {
        let open = || {
            let parts = std::iter::zip(parts, firsts).filter(|(part, _)| part.normals);
            parts.flat_map(|(part, &first)| (first..).zip(part.triangles.as_flattened()))
        };
        let open =
            || open().filter(|(_, corner)| corner[2] == NONE).map(|(number, corner)| (number, corner[0] as usize));
        let mut starts = Vec::new();
        for (_, vertex) in open() {
            if starts.is_empty() {
                starts = vec![0_u32; vertices + 1];
            }
            starts[vertex] += 1;
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        // Each start is at its end now and is counted down, so the last corners come first.
        let mut corners = vec![0; sum as usize];
        for (number, vertex) in open() {
            starts[vertex] -= 1;
            corners[starts[vertex] as usize] = number;
        }
        Self { starts, corners }
    }
}

/// The part and the triangle of a corner, and its number in the triangle.
fn place(corner: u32, firsts: &[u32]) -> (usize, usize, usize) {
    // Among parts that start at the same corner, all but the last are empty.
    let part = firsts.partition_point(|&first| first <= corner) - 1;
    let within = (corner - firsts[part]) as usize;
    (part, within / 3, within % 3)
}

fn corner_mut<'a>(corner: u32, parts: &'a mut [Part], firsts: &[u32]) -> Option<&'a mut Corner> {
    let (part, triangle, which) = place(corner, firsts);
    parts.get_mut(part)?.triangles.get_mut(triangle)?.get_mut(which)
}

fn look(corner: u32, parts: &[Part], firsts: &[u32], positions: &[[f32; 3]]) -> Option<Around> {
    let (part, triangle, which) = place(corner, firsts);
    let part = parts.get(part)?;
    let corners = part.triangles.get(triangle)?;
    let position = |which: usize| {
        let corner = corners.get(which % 3).and_then(|corner| positions.get(corner[0] as usize));
        corner.map_or(DVec3::ZERO, |corner| DVec3::from(corner.map(f64::from)))
    };
    let own = position(which);
    let [next, last] = [position(which + 1) - own, position(which + 2) - own];
    let area = next.cross(last);
    Some(Around {
        corner,
        group: part.smoothing.get(triangle).copied().unwrap_or(0),
        normal: area.try_normalize().unwrap_or(DVec3::ZERO),
        angle: area.length().atan2(next.dot(last)),
    })
}

/// The normals of corners of one group at one vertex.
fn smooth(group: &[Around], made: &mut Vec<(u32, DVec3)>) {
    made.clear();
    let mean = |counts: &dyn Fn(&Around) -> bool| -> DVec3 {
        group.iter().filter(|other| counts(other)).map(|other| other.normal * other.angle).sum()
    };
    let all = mean(&|_| true);
    for own in group {
        let sum = match own.group {
            0 => own.normal,
            _ if group.len() > MAX_COMPARED || own.normal == DVec3::ZERO => all,
            _ => mean(&|other| own.normal.dot(other.normal) > SPLIT),
        };
        let unit = sum.try_normalize().or_else(|| own.normal.try_normalize()).unwrap_or(DVec3::Z);
        made.push((own.corner, unit));
    }
}
