//! Normals that a file lacks, or has as zeros.

use glam::Vec3;

use crate::scene::description::Mesh;

/// Makes all normals unit vectors. Normals without a direction get the mean of the triangles around, weighted by area. Returns the number
/// of these.
pub(super) fn repair_normals(mesh: &mut Mesh) -> usize {
    let mut replaced = 0;
    let mut around: Option<Vec<Vec3>> = None;
    for vertex in 0..mesh.normals.len() {
        let Some(&normal) = mesh.normals.get(vertex) else { break };
        let unit = Vec3::from(normal).try_normalize().unwrap_or_else(|| {
            replaced += 1;
            let around = around.get_or_insert_with(|| geometric_normals(mesh));
            around.get(vertex).and_then(|sum| sum.try_normalize()).unwrap_or(Vec3::Z)
        });
        if let Some(normal) = mesh.normals.get_mut(vertex) {
            *normal = unit.to_array();
        }
    }
    replaced
}

/// For each vertex, the sum of the (not normalised) normals of the triangles around.
fn geometric_normals(mesh: &Mesh) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    let position = |corner: u32| mesh.positions.get(corner as usize).map_or(Vec3::ZERO, |&position| position.into());
    for &corners in &mesh.triangles {
        let [a, b, c] = corners.map(position);
        let normal = (b - a).cross(c - a);
        for corner in corners {
            if let Some(sum) = sums.get_mut(corner as usize) {
                *sum += normal;
            }
        }
    }
    sums
}
