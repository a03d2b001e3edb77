//! Bodies of glass. An OBJ file does not say whether faces are the skin of a body, but closed faces are, however the file divides them into
//! objects.

use std::collections::HashSet;

use super::skin::Skins;
use super::text::shortened;
use crate::scene::description::{Interior, Material, Mesh};
use crate::scene::load::common::report::Report;

/// Makes closed faces of each of these refracting materials the skins of bodies, turned outwards, and inwards around what is hollow. Other
/// faces stay panes, with a warning. A mesh of both kinds becomes two.
pub(super) fn fill(
    meshes: &mut Vec<Mesh>,
    materials: &mut Vec<Material>,
    refracting: &HashSet<usize>,
    report: &mut Report,
) {
    let mut users: Vec<usize> = refracting.iter().copied().collect();
    users.sort_unstable();
    for pane in users {
        let of_material: Vec<usize> = (0..meshes.len()).filter(|&mesh| meshes[mesh].material == pane).collect();
        if of_material.is_empty() {
            continue;
        }
        let divided = Skins::new(of_material.iter().map(|&mesh| &meshes[mesh])).divide();
        let closed = materials.len();
        if divided.iter().any(|of_mesh| !of_mesh.closed.is_empty()) {
            materials.push(body(&materials[pane]));
        }
        for (mesh, of_mesh) in of_material.into_iter().zip(divided) {
            if !of_mesh.open.is_empty() {
                let element = format!("object \"{}\"", shortened(&meshes[mesh].name));
                let reason = "faces of its glass enclose no body; they are drawn as panes that do not refract";
                report.warn_once(element, reason);
            }
            if of_mesh.open.is_empty() {
                (meshes[mesh].triangles, meshes[mesh].material) = (of_mesh.closed, closed);
                continue;
            }
            if !of_mesh.closed.is_empty() {
                meshes.push(Mesh { triangles: of_mesh.closed, material: closed, ..meshes[mesh].clone() });
            }
            meshes[mesh].triangles = of_mesh.open;
        }
    }
}

/// The material of the skin of a body. `Tf` is the part of the light that a whole body leaves, and light meets its skin twice.
fn body(pane: &Material) -> Material {
    let [r, g, b, opacity] = pane.base_color;
    let [r, g, b] = [r, g, b].map(f32::sqrt);
    let interior = Interior { absorption: Some([0.0; 3]), ..pane.interior };
    Material { base_color: [r, g, b, opacity], interior, ..pane.clone() }
}
