//! The rows of the visibility lookup table, and the trees over them.

use super::attributes::Layout;
use super::groups::{Face, Group};
use super::tangents::{self, Tangents};
use crate::scene::description::Scene;
use crate::scene::gpu::memory::folded::Texel;
use crate::scene::gpu::tree::{self, Quantization, Tree};
use glam::Vec3;

/// All trees and rows of a scene.
pub(crate) struct Geometry {
    /// Number of the first of `nodes`.
    pub first_node: u32,
    pub nodes: Vec<tree::Node>,
    /// Three vertices with one word each: material, number among its instance's emitters + 1, unused.
    pub rows: Vec<[Texel; 3]>,
    /// Words laid out by [`Layout`].
    pub attributes: Vec<u32>,
    pub layout: Layout,
    /// The tangents of each mesh that has a normal map.
    tangents: Vec<Option<Tangents>>,
    /// Depth of the deepest tree.
    pub depth: u32,
}

/// A group after its tree was built.
pub(crate) struct Built {
    pub root: u32,
    pub first_row: u32,
    pub bounds: [[f32; 3]; 2],
    pub grid: Quantization,
    /// The faces that emit, each with its row, in the order of their numbers.
    pub emitters: Vec<(u32, Face)>,
}

impl Geometry {
    pub fn new(scene: &Scene, first_node: u32) -> Self {
        let layout = Layout::of(scene);
        let tangents = scene.meshes.iter().map(|mesh| tangents::of(mesh, &scene.materials[mesh.material])).collect();
        Self { first_node, nodes: Vec::new(), rows: Vec::new(), attributes: Vec::new(), layout, tangents, depth: 0 }
    }

    /// Builds the group's tree and appends its rows in the order of the leaves.
    pub fn add(&mut self, scene: &Scene, group: &Group) -> Built {
        let first_row = self.rows.len() as u32;
        let root = self.first_node + self.nodes.len() as u32;
        let corners: Vec<_> = group.faces.iter().map(|f| f.corners.map(|p| p.to_array())).collect();
        let Tree { nodes, order, depth, bounds, grid } = tree::over_triangles(&corners, root, first_row);
        let mut emitters = Vec::new();
        for &index in &order {
            let face = group.faces[index as usize];
            let material = scene.meshes[face.mesh].material;
            let mut number = 0;
            if scene.materials[material].is_emitter() && face.area_normal() != Vec3::ZERO {
                emitters.push((self.rows.len() as u32, face));
                number = emitters.len() as u32;
            }
            let [a, b, c] = face.corners;
            self.rows.push([texel(a, material as u32), texel(b, number), texel(c, 0)]);
            let tangents = self.tangents[face.mesh].as_ref();
            self.layout.push(&mut self.attributes, &scene.meshes[face.mesh], tangents, &face);
        }
        self.nodes.extend(nodes);
        self.depth = self.depth.max(depth);
        Built { root, first_row, bounds, grid, emitters }
    }
}

fn texel(v: Vec3, word: u32) -> Texel {
    [v.x.to_bits(), v.y.to_bits(), v.z.to_bits(), word]
}
