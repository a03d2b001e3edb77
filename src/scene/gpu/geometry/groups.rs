//! Gathers meshes into groups that share a tree.

use super::centre;
use super::drawn::{Drawn, Posed};
use crate::scene::description::WorldMatrix;
use glam::{DMat3, DMat4, DVec3, Vec3};

/// Maximum number of triangles in all copies of a static mesh that is used several times and still copied into the static geometry. A
/// copy saves the second level of trees.
const COPIED_TRIANGLES: usize = 4096;

/// Geometry that shares a tree, in the tree's space.
pub(crate) struct Group {
    /// The nodes that place it. Empty if it is in world space already: for the static geometry, and for meshes that joints place.
    pub nodes: Vec<usize>,
    /// Origin of the corners, in the space of the tree.
    pub centre: DVec3,
    pub faces: Vec<Face>,
    /// Number of the mesh among those drawn, if the mesh changes its shape.
    pub deforms: Option<usize>,
}

impl Group {
    /// The node of each instance. Geometry in world space is one instance, without a node.
    pub fn placements(&self) -> Vec<Option<usize>> {
        if self.nodes.is_empty() { vec![None] } else { self.nodes.iter().copied().map(Some).collect() }
    }
}

/// A triangle of a [`Group`].
#[derive(Clone, Copy)]
pub(crate) struct Face {
    /// Number of the mesh among those drawn.
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

    /// Values of the triangle's vertices in the order of the corners.
    pub fn in_order<T>(&self, posed: &Posed<'_>, [a, b, c]: [T; 3]) -> [T; 3] {
        let mirrored = self.placement.determinant() < 0.0;
        if mirrored != posed.mirrored { [a, c, b] } else { [a, b, c] }
    }

    /// Texture coordinates of the corners in a set; 0 where the mesh has none.
    pub fn uvs(&self, posed: &Posed<'_>, set: usize) -> [[f32; 2]; 3] {
        let vertices = self.in_order(posed, posed.mesh.triangles[self.triangle]);
        vertices.map(|vertex| posed.mesh.uvs[set].get(vertex as usize).copied().unwrap_or_default())
    }
}

/// Sorts meshes into groups. The static geometry comes first, in world space as `world` places its nodes, relative to `centre`. One
/// group follows for each mesh that moves or repeats, or changes its shape. `moves` tells for each node if it may ever move.
pub(crate) fn groups(drawn: &[Drawn<'_>], world: &[WorldMatrix], moves: &[bool], centre: DVec3) -> Vec<Group> {
    let mut fixed = Group { nodes: Vec::new(), centre, faces: Vec::new(), deforms: None };
    let mut placed = Vec::new();
    for (number, drawn) in drawn.iter().enumerate() {
        let (posed, nodes) = (drawn.posed(), &drawn.nodes);
        let triangles = posed.mesh.triangles.len();
        let deforms = drawn.source.is_some().then_some(number);
        if drawn.is_in_world() && deforms.is_none() {
            fixed.faces.extend(faces(&posed, number, DMat4::IDENTITY, centre));
        }
        let copied = nodes.len() == 1 || nodes.len() * triangles <= COPIED_TRIANGLES;
        let is_still = |node: usize| copied && !moves[node] && deforms.is_none();
        let (still, moving): (Vec<_>, Vec<_>) = nodes.iter().copied().partition(|&node| is_still(node));
        for node in still {
            fixed.faces.extend(faces(&posed, number, DMat4::from_cols_array_2d(&world[node]), centre));
        }
        if triangles > 0 && (deforms.is_some() || !moving.is_empty()) {
            let centre = if drawn.is_in_world() { centre } else { own_centre(&posed) };
            let faces = faces(&posed, number, DMat4::IDENTITY, centre).collect();
            placed.push(Group { nodes: moving, centre, faces, deforms });
        }
    }
    if !fixed.faces.is_empty() || placed.is_empty() {
        placed.insert(0, fixed);
    }
    placed
}

/// The centre of a mesh in its own space.
fn own_centre(posed: &Posed<'_>) -> DVec3 {
    let corners = posed.mesh.triangles.iter().flatten().map(|&vertex| posed.position(vertex));
    centre::bounds(corners).map_or(DVec3::ZERO, centre::centre)
}

/// The largest coordinate of a mesh that changes its shape, in metres. The fourth power of an edge between two such points is a number
/// of f32, so that areas and weights in shaders are finite.
const FARTHEST: f64 = 1e9;

/// A vertex of a mesh that changes its shape.
pub(crate) fn limited(place: DVec3) -> Vec3 {
    place.clamp(DVec3::splat(-FARTHEST), DVec3::splat(FARTHEST)).as_vec3()
}

/// The faces of a mesh with this number, relative to `centre`.
fn faces(posed: &Posed<'_>, number: usize, world: DMat4, centre: DVec3) -> impl Iterator<Item = Face> {
    let placement = DMat3::from_mat4(world);
    // A mirroring placement reverses the winding. It is reversed again here, so that the front stays the front.
    let mirrored = (placement.determinant() < 0.0) != posed.mirrored;
    posed.mesh.triangles.iter().enumerate().map(move |(triangle, corners)| {
        let [a, b, c] = corners.map(|vertex| {
            let place = world.transform_point3(posed.position(vertex)) - centre;
            if posed.shape.is_some() { limited(place) } else { place.as_vec3() }
        });
        let corners = if mirrored { [a, c, b] } else { [a, b, c] };
        Face { mesh: number, triangle, corners, placement }
    })
}
