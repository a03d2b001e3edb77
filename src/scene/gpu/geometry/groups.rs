//! Gathers meshes into groups that share a tree.

use super::centre;
use crate::scene::description::{Mesh, Scene, WorldMatrix};
use glam::{DMat3, DMat4, DVec3, Vec3};
use std::collections::BTreeMap;

/// Maximum number of triangles in all copies of a static mesh that is used several times and still copied into the static geometry. A
/// copy saves the second level of trees.
const COPIED_TRIANGLES: usize = 4096;

/// Geometry that shares a tree, in the tree's space.
pub(crate) struct Group {
    /// The nodes that place it. Empty for the static geometry, which is in world space already.
    pub nodes: Vec<usize>,
    /// Origin of the corners, in the space of the tree.
    pub centre: DVec3,
    pub faces: Vec<Face>,
}

impl Group {
    /// The node of each instance. The static geometry is one instance, without a node.
    pub fn placements(&self) -> Vec<Option<usize>> {
        if self.nodes.is_empty() { vec![None] } else { self.nodes.iter().copied().map(Some).collect() }
    }
}

/// A triangle of a [`Group`].
#[derive(Clone, Copy)]
pub(crate) struct Face {
    pub mesh: usize,
    pub triangle: usize,
    pub corners: [Vec3; 3],
    /// The linear map that placed the corners. Normals follow it.
    pub placement: DMat3,
}

impl Face {
    /// Half the cross product of the edges. Its length is the area.
    pub fn area_normal(&self) -> Vec3 {
        0.5 * (self.corners[1] - self.corners[0]).cross(self.corners[2] - self.corners[0])
    }
}

/// Sorts the scene's meshes into groups. The static geometry comes first, in world space as `world` places its nodes, relative to
/// `centre`. One group follows for each mesh that moves or repeats.
pub(crate) fn groups(scene: &Scene, world: &[WorldMatrix], centre: DVec3) -> Vec<Group> {
    let moves = scene.animated_nodes();
    let mut uses: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (node, description) in scene.nodes.iter().enumerate() {
        for &mesh in &description.meshes {
            uses.entry(mesh).or_default().push(node);
        }
    }
    let mut fixed = Group { nodes: Vec::new(), centre, faces: Vec::new() };
    let mut placed = Vec::new();
    for (mesh, nodes) in uses {
        let description = &scene.meshes[mesh];
        let copied = nodes.len() == 1 || nodes.len() * description.triangles.len() <= COPIED_TRIANGLES;
        let (still, moving): (Vec<_>, Vec<_>) = nodes.into_iter().partition(|&n| copied && !moves[n]);
        for node in still {
            fixed.faces.extend(faces(description, mesh, DMat4::from_cols_array_2d(&world[node]), centre));
        }
        if !moving.is_empty() && !description.triangles.is_empty() {
            let centre = own_centre(description);
            let faces = faces(description, mesh, DMat4::IDENTITY, centre).collect();
            placed.push(Group { nodes: moving, centre, faces });
        }
    }
    if !fixed.faces.is_empty() || placed.is_empty() {
        placed.insert(0, fixed);
    }
    placed
}

fn position(mesh: &Mesh, vertex: u32) -> DVec3 {
    mesh.positions[vertex as usize].map(f64::from).into()
}

/// The centre of a mesh in its own space.
fn own_centre(mesh: &Mesh) -> DVec3 {
    let corners = mesh.triangles.iter().flatten().map(|&vertex| position(mesh, vertex));
    centre::bounds(corners).map_or(DVec3::ZERO, centre::centre)
}

fn faces(mesh: &Mesh, index: usize, world: DMat4, centre: DVec3) -> impl Iterator<Item = Face> {
    let placement = DMat3::from_mat4(world);
    let mirrored = placement.determinant() < 0.0;
    mesh.triangles.iter().enumerate().map(move |(triangle, corners)| {
        let [a, b, c] = corners.map(|v| (world.transform_point3(position(mesh, v)) - centre).as_vec3());
        // A mirroring placement reverses the winding. It is reversed again here, so that the front stays the front.
        let corners = if mirrored { [a, c, b] } else { [a, b, c] };
        Face { mesh: index, triangle, corners, placement }
    })
}
