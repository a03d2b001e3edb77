//! Meshes whose shape follows the pose: rows, normals and trees that replace those of the last shape.

use super::attributes::{Layout, normal_word};
use super::drawn::{Drawn, Posed, ShapeSource};
use super::groups::{Face, Group, limited};
use super::rows::{Built, Geometry, row};
use super::tangents::Tangents;
use crate::scene::description::{Mesh, Pose, Shape, WorldMatrix};
use crate::scene::gpu::memory::folded::Texel;
use crate::scene::gpu::tree::{Fitted, Node};
use glam::{DMat3, DVec3, Vec3};

/// A mesh whose shape follows the pose, and its shape in the current one.
#[derive(Debug)]
pub(crate) struct Deforming {
    mesh: Mesh,
    /// Joints and weights of the current shape.
    inputs: (Vec<WorldMatrix>, Vec<f32>),
    mirrored: bool,
    pub source: ShapeSource,
    tangents: Option<Tangents>,
    /// Origin of the corners, in the space of the shape.
    centre: DVec3,
    layout: Layout,
    /// Material and number among the emitters, for each row.
    words: Vec<[u32; 2]>,
    pub instance: usize,
    pub first_row: u32,
    pub tree: Fitted,
    /// Corners of each row.
    pub corners: Vec<[Vec3; 3]>,
}

/// The parts of a scene on the GPU that replace those of a mesh's last shape.
pub(crate) struct Reshaped {
    pub first_row: u32,
    pub rows: Vec<[Texel; 3]>,
    /// Attributes of the rows, and the place of the first word. Empty if there are no normals.
    pub attributes: (usize, Vec<u32>),
    pub first_node: u32,
    pub nodes: Vec<Node>,
}

impl Deforming {
    /// The mesh of a group that was built as an instance. `None` if the mesh keeps its shape.
    pub fn of(
        drawn: &[Drawn<'_>],
        pose: &Pose,
        geometry: &Geometry<'_>,
        (group, built): (&Group, Built),
        instance: usize,
    ) -> Option<Self> {
        let (number, tree) = (group.deforms?, built.fitted?);
        let (posed, source) = (drawn[number].posed(), drawn[number].source.clone()?);
        let number_of = |row: usize| geometry.rows[built.first_row as usize + row].map(|texel| texel[3]);
        Some(Self {
            mesh: posed.mesh.clone(),
            inputs: source.inputs(pose),
            mirrored: posed.mirrored,
            source,
            tangents: geometry.tangents[number].clone(),
            centre: group.centre,
            layout: geometry.layout,
            words: (0..group.faces.len()).map(number_of).map(|[material, number, _]| [material, number]).collect(),
            instance,
            first_row: built.first_row,
            tree,
            corners: group.faces.iter().map(|face| face.corners).collect(),
        })
    }

    /// Takes the shape of a pose. `None` if it is the one before.
    pub fn follow(&mut self, pose: &Pose) -> Option<Reshaped> {
        let inputs = self.source.inputs(pose);
        if inputs == self.inputs {
            return None;
        }
        self.inputs = inputs;
        let shape = self.source.shape(&self.mesh, pose);
        // Most vertices are corners of several triangles.
        let places: Vec<Vec3> = shape.positions.iter().map(|&p| limited(DVec3::from(p) - self.centre)).collect();
        let in_order = |[a, b, c]: [Vec3; 3]| if self.mirrored { [a, c, b] } else { [a, b, c] };
        let triangles = self.mesh.triangles.iter();
        self.corners = triangles.map(|corners| in_order(corners.map(|vertex| places[vertex as usize]))).collect();
        self.tree.fit(&self.corners.iter().map(|corners| corners.map(|p| p.to_array())).collect::<Vec<_>>());
        Some(Reshaped {
            first_row: self.first_row,
            rows: self.corners.iter().zip(&self.words).map(|(&corners, &words)| row(corners, words)).collect(),
            attributes: (self.first_row as usize * self.layout.stride, self.attributes(&shape)),
            first_node: self.tree.first_node,
            nodes: self.tree.nodes.clone(),
        })
    }

    /// The attributes of all rows in a shape; empty if they do not depend on it.
    fn attributes(&self, shape: &Shape) -> Vec<u32> {
        let mut attributes = Vec::new();
        if self.layout.normals {
            let posed = Posed { mesh: &self.mesh, shape: Some(shape), mirrored: self.mirrored };
            let normals: Vec<u32> = shape.normals.iter().map(|&normal| normal_word(normal.into())).collect();
            attributes.reserve(self.corners.len() * self.layout.stride);
            for (triangle, &corners) in self.corners.iter().enumerate() {
                let face = Face { mesh: 0, triangle, corners, placement: DMat3::IDENTITY };
                self.layout.push(&mut attributes, &posed, (self.tangents.as_ref(), Some(&normals)), &face);
            }
        }
        attributes
    }

    /// The corners of the rows that emit light.
    pub fn emitters(&self) -> impl Iterator<Item = [Vec3; 3]> {
        let rows = self.corners.iter().zip(&self.words);
        rows.filter(|(_, [_, emitter])| *emitter > 0).map(|(corners, _)| *corners)
    }
}
