//! Gathers meshes into trees and into the rows of the visibility lookup table.

use super::bvh::{self, Tree};
use super::centre;
use super::folded::Texel;
use super::{Alpha, Material, Mesh, Scene, WorldMatrix};
use crate::plan::Traits;
use glam::{DMat3, DMat4, DVec3, Vec2, Vec3};
use std::collections::BTreeMap;

/// A static mesh that is used several times is still copied into the static geometry, where it costs no second level of
/// the tree, as long as the copies have fewer triangles than this.
const COPIED_TRIANGLES: usize = 4096;

/// Geometry that shares a tree, in the tree's space.
pub(super) struct Group {
    /// The nodes that place it, or none for the static geometry, which is in world space already.
    pub nodes: Vec<usize>,
    /// Where in that space the corners count from.
    pub centre: DVec3,
    pub faces: Vec<Face>,
}

/// A triangle of a [`Group`].
#[derive(Clone, Copy)]
pub(super) struct Face {
    pub mesh: usize,
    pub triangle: usize,
    pub corners: [Vec3; 3],
    /// The linear map that was applied to the corners, and that the normals follow.
    placement: DMat3,
}

impl Face {
    /// Half the cross product of the edges: as long as the area.
    pub fn area_normal(&self) -> Vec3 {
        0.5 * (self.corners[1] - self.corners[0]).cross(self.corners[2] - self.corners[0])
    }
}

/// Sorts the scene's meshes into groups: all that stands still first (in world space, where its nodes are `world`, relative to `centre`), then
/// one group for each mesh that moves or repeats.
pub(super) fn groups(scene: &Scene, world: &[WorldMatrix], centre: DVec3) -> Vec<Group> {
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
        // A mirroring placement turns the winding over; turned back here, the front stays the front.
        let corners = if mirrored { [a, c, b] } else { [a, b, c] };
        Face { mesh: index, triangle, corners, placement }
    })
}

/// All trees and rows of a scene, as they go to the GPU.
pub(super) struct Geometry {
    /// Number of the first of `nodes`.
    pub first_node: u32,
    pub nodes: Vec<bvh::Node>,
    /// Three vertices with one word each: material, number among its instance's emitters + 1, unused.
    pub rows: Vec<[Texel; 3]>,
    /// See [`Layout`].
    pub attributes: Vec<u32>,
    pub layout: Layout,
    /// Deepest of the trees.
    pub depth: u32,
}

/// Where a triangle's words lie in the attributes: three normals, then three (u, v) per set, then three
/// colours, each only if the scene needs it.
#[derive(Clone, Copy, Default)]
pub(super) struct Layout {
    pub stride: usize,
    pub normals: bool,
    pub uv: [Option<usize>; 2],
    /// Four numbers of 16 bits a corner.
    pub color: Option<usize>,
}

/// A group after its tree was built.
pub(super) struct Built {
    pub root: u32,
    pub first_row: u32,
    pub bounds: [[f32; 3]; 2],
    pub grid: bvh::Quantization,
    /// Faces of the group that emit, in the order of their numbers, with their row.
    pub emitters: Vec<(u32, Face)>,
}

impl Geometry {
    pub fn new(scene: &Scene, first_node: u32) -> Self {
        let used = |set: usize| {
            let reads = |m: &Material| m.textures().any(|(_, texture)| texture.uv_set == set);
            scene.meshes.iter().any(|mesh| reads(&scene.materials[mesh.material]))
        };
        let mut layout = Layout { normals: scene.meshes.iter().any(|m| !m.normals.is_empty()), ..Default::default() };
        layout.stride = if layout.normals { 3 } else { 0 };
        for set in 0..2 {
            if used(set) {
                layout.uv[set] = Some(layout.stride);
                layout.stride += 6;
            }
        }
        if scene.meshes.iter().any(|mesh| !mesh.colors.is_empty()) {
            layout.color = Some(layout.stride);
            layout.stride += 6;
        }
        Self { first_node, nodes: Vec::new(), rows: Vec::new(), attributes: Vec::new(), layout, depth: 0 }
    }

    /// Builds the group's tree and appends its rows in the order of the leaves.
    pub fn add(&mut self, scene: &Scene, group: &Group) -> Built {
        let first_row = self.rows.len() as u32;
        let root = self.first_node + self.nodes.len() as u32;
        let corners: Vec<_> = group.faces.iter().map(|f| f.corners.map(|p| p.to_array())).collect();
        let Tree { nodes, order, depth, bounds, grid } = bvh::over_triangles(&corners, root, first_row);
        let mut emitters = Vec::new();
        for &index in &order {
            let face = group.faces[index as usize];
            let material = scene.meshes[face.mesh].material;
            let mut number = 0;
            if is_emitter(&scene.materials[material]) && face.area_normal() != Vec3::ZERO {
                emitters.push((self.rows.len() as u32, face));
                number = emitters.len() as u32;
            }
            let [a, b, c] = face.corners;
            self.rows.push([texel(a, material as u32), texel(b, number), texel(c, 0)]);
            self.add_attributes(&scene.meshes[face.mesh], &face);
        }
        self.nodes.extend(nodes);
        self.depth = self.depth.max(depth);
        Built { root, first_row, bounds, grid, emitters }
    }

    fn add_attributes(&mut self, mesh: &Mesh, face: &Face) {
        let [a, b, c] = mesh.triangles[face.triangle];
        let corners = if face.placement.determinant() < 0.0 { [a, c, b] } else { [a, b, c] };
        if self.layout.normals {
            // Normals go with the inverse's transpose.
            let map = face.placement.inverse().transpose().as_mat3();
            for corner in corners {
                let normal = mesh.normals.get(corner as usize).map_or(Vec3::ZERO, |&n| map * Vec3::from(n));
                self.attributes.push(normal.try_normalize().map_or(0, pack_octahedral));
            }
        }
        for (set, offset) in self.layout.uv.iter().enumerate() {
            if offset.is_some() {
                for corner in corners {
                    let uv = mesh.uvs[set].get(corner as usize).copied().unwrap_or_default();
                    self.attributes.extend(uv.map(f32::to_bits));
                }
            }
        }
        if self.layout.color.is_some() {
            for corner in corners {
                let [r, g, b, a] = mesh.colors.get(corner as usize).copied().unwrap_or([1.0; 4]);
                self.attributes.extend([pack_unorm([r, g]), pack_unorm([b, a])]);
            }
        }
    }
}

fn texel(v: Vec3, word: u32) -> Texel {
    [v.x.to_bits(), v.y.to_bits(), v.z.to_bits(), word]
}

/// Whether a material's triangles are lights.
fn is_emitter(material: &Material) -> bool {
    !material.unlit && material.emissive.iter().any(|&e| e > 0.0)
}

/// What the materials and meshes in use ask of the shaders.
pub(super) fn traits(scene: &Scene, layout: Layout) -> Traits {
    let used = || {
        let placed: Vec<usize> = scene.nodes.iter().flat_map(|n| n.meshes.iter().copied()).collect();
        scene
            .meshes
            .iter()
            .enumerate()
            .filter(move |(i, _)| placed.contains(i))
            .map(|(_, m)| &scene.materials[m.material])
    };
    Traits {
        textures: used().any(|m| m.textures().next().is_some()),
        shading_normals: layout.normals,
        vertex_colors: layout.color.is_some(),
        specular: used().any(|m| !m.unlit && (m.specular != [0.0; 3] || m.metallic > 0.0)),
        alpha_blend: used().any(|m| m.alpha == Alpha::Blend),
        alpha_mask: used().any(|m| m.alpha != Alpha::Opaque || m.culled),
        emitters: used().any(is_emitter),
        unlit: used().any(|m| m.unlit),
        ..Default::default()
    }
}

/// A unit vector as two 16-bit numbers on the unfolded octahedron (Meyer et al. 2010); never 0, which means none.
fn pack_octahedral(n: Vec3) -> u32 {
    let p = Vec2::new(n.x, n.y) / (n.x.abs() + n.y.abs() + n.z.abs());
    let sign = Vec2::new(1.0_f32.copysign(p.x), 1.0_f32.copysign(p.y));
    let folded = if n.z < 0.0 { (1.0 - Vec2::new(p.y, p.x).abs()) * sign } else { p };
    let q = ((folded * 0.5 + 0.5) * 65535.0).round().clamp(Vec2::ONE, Vec2::splat(65535.0));
    q.x as u32 | (q.y as u32) << 16
}

/// Two numbers within 0…1 as `unpack2x16unorm` of WGSL reads them.
fn pack_unorm(pair: [f32; 2]) -> u32 {
    let [low, high] = pair.map(|x| (x.clamp(0.0, 1.0) * 65535.0).round() as u32);
    low | high << 16
}
