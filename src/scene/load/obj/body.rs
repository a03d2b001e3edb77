//! Bodies of glass. An OBJ file does not say whether faces are the skin of a body, but closed faces are.

use std::collections::HashMap;

use super::text::shortened;
use crate::scene::description::{Interior, Material, Mesh};
use crate::scene::load::common::report::Report;

/// The materials of bodies, by those of panes.
#[derive(Default)]
pub(super) struct Bodies {
    materials: HashMap<usize, usize>,
}

impl Bodies {
    /// Makes a mesh with a refracting material a body, if its faces are closed; else it stays a pane, with a warning.
    pub fn fill(&mut self, mesh: &mut Mesh, materials: &mut Vec<Material>, report: &mut Report) {
        if !close(mesh) {
            let element = format!("object \"{}\"", shortened(&mesh.name));
            let reason = "its glass encloses no body; it is drawn as a pane that does not refract";
            report.warn_once(element, reason);
            return;
        }
        mesh.material = *self.materials.entry(mesh.material).or_insert_with_key(|&pane| {
            materials.push(body(&materials[pane]));
            materials.len() - 1
        });
    }
}

/// The material of the skin of a body. `Tf` is the part of the light that a whole body leaves, and light meets its skin twice.
fn body(pane: &Material) -> Material {
    let [r, g, b, opacity] = pane.base_color;
    let [r, g, b] = [r, g, b].map(f32::sqrt);
    let interior = Interior { absorption: Some([0.0; 3]), ..pane.interior };
    Material { base_color: [r, g, b, opacity], interior, ..pane.clone() }
}

/// True if the faces of a mesh enclose bodies. Turns them outwards if they all look inwards.
fn close(mesh: &mut Mesh) -> bool {
    if !is_closed(mesh) {
        return false;
    }
    if volume(mesh) < 0.0 {
        mesh.triangles.iter_mut().for_each(|[_, b, c]| std::mem::swap(b, c));
    }
    true
}

/// True if each edge is walked as often in one direction as in the other. Corners with one position are one corner.
fn is_closed(mesh: &Mesh) -> bool {
    let mut places = HashMap::new();
    let numbers: Vec<usize> = mesh
        .positions
        .iter()
        .map(|position| {
            // 0 and −0 are one place.
            let next = places.len();
            *places.entry(position.map(|x| (x + 0.0).to_bits())).or_insert(next)
        })
        .collect();
    let mut walks: HashMap<(usize, usize), i64> = HashMap::new();
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|corner| numbers[corner as usize]);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *walks.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
        }
    }
    walks.into_iter().all(|((from, to), balance)| from == to || balance == 0)
}

/// Six times the volume inside, negative if the faces look inwards.
fn volume(mesh: &Mesh) -> f64 {
    let Some(&origin) = mesh.positions.first() else { return 0.0 };
    let from_origin = |corner: u32| {
        let position = mesh.positions[corner as usize];
        [0, 1, 2].map(|axis| f64::from(position[axis]) - f64::from(origin[axis]))
    };
    let determinant = |[a, b, c]: [[f64; 3]; 3]| {
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    mesh.triangles.iter().map(|corners| determinant(corners.map(from_origin))).sum()
}
