//! The shape of a mesh in a pose: morph targets first, then linear blend skinning (Magnenat-Thalmann, Laperrière and Thalmann 1988,
//! "Joint-Dependent Local Deformations for Hand Animation and Object Grasping").
//!
//! A vertex p with morph weights w and influences (j, v) goes to Σ v·Mⱼ·(p + Σ w·offset) / Σ v, with the joint matrices
//! Mⱼ = world(j) · inverse bind(j). All of it is computed in f64: weights and matrices are finite numbers of f32, so no sum overflows.

use glam::{DMat3, DMat4, DVec3, Mat4, Vec3, Vec4};

use super::{Mesh, Pose, Scene, Skin};

/// Least sum of a vertex's influences. A smaller sum is 0 with rounding, and nothing is divided by it.
const LEAST_SUM: f64 = 1e-6;

/// The vertices of a mesh as a node draws it in a [`Pose`], see [`Scene::shape`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Positions. Joints place them in the world; without a skin they are in the space of the node.
    pub positions: Vec<[f64; 3]>,
    /// Shading normals of length 1, or 0 where joints flatten the mesh so that it has none; empty if the mesh has none.
    pub normals: Vec<[f32; 3]>,
    /// Tangents of length 1, or 0; empty if the mesh has none.
    pub tangents: Vec<[f32; 4]>,
    /// Linear part of the blend of joints, for each vertex; empty without a skin.
    pub(crate) turns: Vec<DMat3>,
}

impl Scene {
    /// The shape in which a node draws a mesh, or `None` if an index is out of range or belongs to another scene's pose.
    pub fn shape(&self, pose: &Pose, node: usize, mesh: usize) -> Option<Shape> {
        let (node, weights) = (self.nodes.get(node)?, pose.weights.get(node)?);
        let mesh = self.meshes.get(mesh)?;
        let joints = match node.skin.filter(|_| mesh.is_skinned()) {
            Some(skin) => Some(self.skins.get(skin)?.matrices(pose)?),
            None => None,
        };
        Some(shape(mesh, weights, joints.as_deref()))
    }
}

impl Mesh {
    /// True if joints place the mesh wherever a node has a skin.
    pub(crate) fn is_skinned(&self) -> bool {
        !self.influences.is_empty()
    }
}

impl Skin {
    /// The map from the space of the mesh to the world, for each joint. `None` if a joint is not a node of the pose.
    pub(crate) fn matrices(&self, pose: &Pose) -> Option<Vec<DMat4>> {
        let matrix = |(&joint, inverse): (&usize, _)| {
            let world = DMat4::from_cols_array_2d(pose.world.get(joint)?);
            Some(world * Mat4::from_cols_array_2d(inverse).as_dmat4())
        };
        self.joints.iter().zip(&self.inverse_bind).map(matrix).collect()
    }
}

/// The shape of a mesh with these weights of its morph targets and these joint matrices. Indices out of range are skipped.
pub(crate) fn shape(mesh: &Mesh, weights: &[f32], joints: Option<&[DMat4]>) -> Shape {
    let mut positions: Vec<DVec3> = mesh.positions.iter().map(|p| p.map(f64::from).into()).collect();
    let mut normals: Vec<DVec3> = mesh.normals.iter().map(|n| n.map(f64::from).into()).collect();
    let mut tangents: Vec<DVec3> = mesh.tangents.iter().map(|&[x, y, z, _]| Vec3::new(x, y, z).as_dvec3()).collect();
    for (target, &weight) in mesh.targets.iter().zip(weights) {
        if weight != 0.0 {
            let weight = f64::from(weight);
            add(&mut positions, weight, &target.vertices, &target.positions);
            add(&mut normals, weight, &target.vertices, &target.normals);
            add(&mut tangents, weight, &target.vertices, &target.tangents);
        }
    }
    let mut shape = Shape::default();
    let mut signs = vec![1.0; tangents.len()];
    if let Some(joints) = joints.filter(|_| mesh.is_skinned()) {
        let each = mesh.influences.len() / mesh.positions.len().max(1);
        for (vertex, influences) in mesh.influences.chunks(each.max(1)).enumerate() {
            let blend = blend(influences.iter().map(|i| (i.joint as usize, f64::from(i.weight))), joints);
            let turn = DMat3::from_mat4(blend);
            if let Some(position) = positions.get_mut(vertex) {
                *position = blend.transform_point3(*position);
            }
            if let Some(normal) = normals.get_mut(vertex) {
                *normal = turned_normal(&turn, *normal);
            }
            if let (Some(tangent), Some(sign)) = (tangents.get_mut(vertex), signs.get_mut(vertex)) {
                *tangent = turn * *tangent;
                *sign = turn.determinant().signum();
            }
            shape.turns.push(turn);
        }
    }
    shape.positions = positions.into_iter().map(|p| p.to_array()).collect();
    // Joints in centimetres make normals short, and one far from length 1 would count as having no direction.
    shape.normals = normals.into_iter().map(|n| n.normalize_or_zero().as_vec3().to_array()).collect();
    let tangent = |((t, sign), [.., w]): ((DVec3, f64), &[f32; 4])| {
        t.normalize_or_zero().as_vec3().extend(*w * sign as f32).to_array()
    };
    shape.tangents = tangents.into_iter().zip(signs).zip(&mesh.tangents).map(tangent).collect();
    shape
}

/// A tangent and its handedness after a linear map. The bitangent is moved like the tangent, but a map that mirrors turns their cross
/// product over.
pub(crate) fn turned_tangent(turn: &DMat3, tangent: Vec4) -> Vec4 {
    let direction = (*turn * tangent.truncate().as_dvec3()).normalize_or_zero().as_vec3();
    direction.extend(tangent.w * turn.determinant().signum() as f32)
}

/// A normal of any length after a linear map: by the transpose of its inverse, of which the cofactors are a multiple. A singular map
/// has cofactors too: those of a map onto a plane lead to the plane's normal.
fn turned_normal(turn: &DMat3, normal: DVec3) -> DVec3 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = *turn;
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * normal * turn.determinant().signum()
}

/// The mean of joint matrices by their weights. Without weights, a vertex follows the first joint that is listed for it.
fn blend(influences: impl Iterator<Item = (usize, f64)> + Clone, joints: &[DMat4]) -> DMat4 {
    let known = influences.filter_map(|(joint, weight)| Some((joints.get(joint)?, weight)));
    let sum: f64 = known.clone().map(|(_, weight)| weight).sum();
    if sum.abs() < LEAST_SUM {
        return known.map(|(joint, _)| *joint).next().unwrap_or(DMat4::IDENTITY);
    }
    known.filter(|(_, weight)| *weight != 0.0).fold(DMat4::ZERO, |mean, (joint, weight)| mean + *joint * (weight / sum))
}

fn add(vectors: &mut [DVec3], weight: f64, vertices: &[u32], offsets: &[[f32; 3]]) {
    for (&vertex, offset) in vertices.iter().zip(offsets) {
        if let Some(vector) = vectors.get_mut(vertex as usize) {
            *vector += weight * DVec3::from(offset.map(f64::from));
        }
    }
}
