//! Tessellation: more triangles, the same picture.

use asvgf::scene::{Mesh, Scene};

/// Cuts each triangle that does not emit into n² triangles of one shape. Lights stay as they are, because more of them
/// would be another scene.
pub fn tessellated(scene: &Scene, n: u32) -> Scene {
    let mut scene = scene.clone();
    for mesh in &mut scene.meshes {
        if scene.materials[mesh.material].emissive == [0.0; 3] {
            *mesh = cut(mesh, n);
        }
    }
    scene
}

/// Cuts a mesh. The original triangles share no vertices, because the sides of a block meet in different normals.
fn cut(mesh: &Mesh, n: u32) -> Mesh {
    let mut out = Mesh {
        positions: Vec::new(),
        normals: Vec::new(),
        uvs: Default::default(),
        triangles: Vec::new(),
        ..mesh.clone()
    };
    for triangle in &mesh.triangles {
        let first = out.positions.len() as u32;
        let corners = triangle.map(|vertex| vertex as usize);
        // Row j has n − j + 1 vertices, and begins after the vertices of all rows before it.
        for (i, j) in (0..=n).flat_map(|j| (0..=n - j).map(move |i| (i, j))) {
            let weights = [n - i - j, i, j].map(|part| part as f32 / n as f32);
            out.positions.push(mix(&mesh.positions, corners, weights));
            if !mesh.normals.is_empty() {
                out.normals.push(mix(&mesh.normals, corners, weights));
            }
            for (new, old) in out.uvs.iter_mut().zip(&mesh.uvs).filter(|(_, old)| !old.is_empty()) {
                new.push(mix(old, corners, weights));
            }
        }
        let at = |i: u32, j: u32| first + j * (n + 1) - j * j.saturating_sub(1) / 2 + i;
        for (i, j) in (0..n).flat_map(|j| (0..n - j).map(move |i| (i, j))) {
            out.triangles.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
            if i + j + 1 < n {
                out.triangles.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }
    out
}

fn mix<const N: usize>(values: &[[f32; N]], corners: [usize; 3], weights: [f32; 3]) -> [f32; N] {
    std::array::from_fn(|axis| corners.iter().zip(weights).map(|(&corner, weight)| weight * values[corner][axis]).sum())
}
