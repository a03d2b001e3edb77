//! The rows of the visibility lookup table, and the trees over them.

use super::attributes::Layout;
use super::drawn::Drawn;
use super::groups::{Face, Group};
use super::tangents::{self, Tangents};
use crate::scene::description::{Mesh, Scene};
use crate::scene::gpu::emission::maps::{Emission, EmissionMaps};
use crate::scene::gpu::memory::folded::Texel;
use crate::scene::gpu::tree::{self, Fitted, Quantization, Tree};
use glam::Vec3;

/// All trees and rows of a scene.
pub(crate) struct Geometry<'a> {
    /// Number of the first of `nodes`.
    pub first_node: u32,
    pub nodes: Vec<tree::Node>,
    /// Three vertices with one word each: material, number among its instance's emitters + 1, unused.
    pub rows: Vec<[Texel; 3]>,
    /// Words laid out by [`Layout`].
    pub attributes: Vec<u32>,
    pub layout: Layout,
    /// The tangents of each drawn mesh that has a normal map.
    pub tangents: Vec<Option<Tangents>>,
    pub emission: EmissionMaps<'a>,
    /// Depth of the deepest tree.
    pub depth: u32,
}

/// A group after its tree was built.
pub(crate) struct Built {
    pub root: u32,
    pub first_row: u32,
    pub bounds: [[f32; 3]; 2],
    pub grid: Quantization,
    /// The tree, if its triangles change their shape.
    pub fitted: Option<Fitted>,
    /// The faces that emit, each with its row and its light, in the order of their numbers.
    pub emitters: Vec<(u32, Face, Emission)>,
}

impl<'a> Geometry<'a> {
    pub fn new(scene: &'a Scene, drawn: &[Drawn<'_>], first_node: u32) -> Self {
        let layout = Layout::of(scene);
        let of_mesh = |mesh: &Mesh| tangents::of(mesh, &scene.materials[mesh.material]);
        let tangents = drawn.iter().map(|drawn| of_mesh(drawn.posed().mesh)).collect();
        let emission = EmissionMaps::of(scene);
        let (nodes, rows, attributes) = Default::default();
        Self { first_node, nodes, rows, attributes, layout, tangents, emission, depth: 0 }
    }

    /// Builds the group's tree and appends its rows in the order of the leaves. The rows of a mesh that changes its shape are in the
    /// order of the triangles, so that another tree may take the place of the first.
    pub fn add(&mut self, scene: &Scene, drawn: &[Drawn<'_>], group: &Group) -> Built {
        let first_row = self.rows.len() as u32;
        let root = self.first_node + self.nodes.len() as u32;
        let corners: Vec<_> = group.faces.iter().map(|f| f.corners.map(|p| p.to_array())).collect();
        let fitted = group.deforms.map(|_| Fitted::over(&corners, root, first_row));
        let Tree { nodes, order, depth, bounds, grid } = match &fitted {
            Some(Fitted { nodes, deepest, bounds, grid, .. }) => {
                let order = (0..corners.len() as u32).collect();
                Tree { nodes: nodes.clone(), order, depth: *deepest, bounds: *bounds, grid: *grid }
            }
            None => tree::over_triangles(&corners, root, first_row),
        };
        let mut emitters = Vec::new();
        for &index in &order {
            let face = group.faces[index as usize];
            let posed = drawn[face.mesh].posed();
            let material = posed.mesh.material;
            let mut number = 0;
            if face.area_normal() != Vec3::ZERO
                && let Some(light) = self.emission.over(&scene.materials[material], |set| face.uvs(&posed, set))
            {
                emitters.push((self.rows.len() as u32, face, light));
                number = emitters.len() as u32;
            }
            self.rows.push(row(face.corners, [material as u32, number]));
            let tangents = self.tangents[face.mesh].as_ref();
            self.layout.push(&mut self.attributes, &posed, (tangents, None), &face);
        }
        self.nodes.extend(nodes);
        self.depth = self.depth.max(depth);
        Built { root, first_row, bounds, grid, fitted, emitters }
    }
}

/// A row of the lookup table: three vertices, with the material and the number among the emitters.
pub(crate) fn row([a, b, c]: [Vec3; 3], [material, number]: [u32; 2]) -> [Texel; 3] {
    [texel(a, material), texel(b, number), texel(c, 0)]
}

fn texel(v: Vec3, word: u32) -> Texel {
    [v.x.to_bits(), v.y.to_bits(), v.z.to_bits(), word]
}
