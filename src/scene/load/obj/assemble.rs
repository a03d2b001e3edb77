//! Conversion of parts to meshes. Corners with the same indices become one vertex.

use std::collections::HashMap;

use super::part::{Corner, NONE, Part};
use super::vectors::Vectors;
use crate::scene::description::Mesh;
use crate::scene::load::common::report::Fault;

const WHITE: [f32; 4] = [1.0; 4];

/// The mesh of a part. The caller sets its name and material. `colors` may be shorter than the positions.
pub(super) fn mesh(part: Part, vectors: &Vectors, colors: &[[f32; 4]]) -> Result<Mesh, Fault> {
    let mut mesh = Mesh { triangles: Vec::with_capacity(part.triangles.len()), ..Mesh::default() };
    let mut numbers: HashMap<Corner, u32> = HashMap::with_capacity(part.triangles.len());
    let mut vertices: Vec<Corner> = Vec::new();
    for corners in part.triangles {
        let triangle = corners.map(|corner| {
            *numbers.entry(corner).or_insert_with(|| {
                vertices.push(corner);
                (vertices.len() - 1) as u32
            })
        });
        mesh.triangles.push(triangle);
    }
    drop(numbers);
    u32::try_from(vertices.len()).map_err(|_| Fault::new("faces", "an object has more than 2³² vertices"))?;

    let position = |&[at, ..]: &Corner| vectors.positions.get(at as usize).copied().unwrap_or_default();
    mesh.positions = vertices.iter().map(position).collect();
    if part.uvs {
        let uv = |at: u32| vectors.uvs.get(at as usize).copied().unwrap_or_default();
        // In OBJ, v grows upwards.
        let flipped = |&[_, at, _]: &Corner| if at == NONE { [0.0, 1.0] } else { [uv(at)[0], 1.0 - uv(at)[1]] };
        mesh.uvs[0] = vertices.iter().map(flipped).collect();
    }
    if part.normals {
        let normal = |&[.., at]: &Corner| vectors.normals.get(at as usize).copied().unwrap_or([0.0, 0.0, 1.0]);
        mesh.normals = vertices.iter().map(normal).collect();
    }
    if vertices.iter().any(|&[at, ..]| (at as usize) < colors.len()) {
        let color = |&[at, ..]: &Corner| colors.get(at as usize).copied().unwrap_or(WHITE);
        mesh.colors = vertices.iter().map(color).collect();
    }
    Ok(mesh)
}
