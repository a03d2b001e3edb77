//! Morph targets and skins. They are applied when a file is read, which gives the shape at rest.

use std::hash::{Hash, Hasher};
use std::rc::Rc;

use glam::{DMat4, Mat3, Mat4, Vec3, Vec4};
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index, Mesh as MeshSource, Skin as SkinSource};

use super::accessor::{Elements, REAL};
use super::attributes::Vertices;
use super::source::Source;
use crate::scene::description::Mesh;
use crate::scene::load::common::report::{Fault, Report};

/// Maximum number of sets of four joints of a vertex.
const MOST_SETS: u32 = 8;

/// The shape in which a node draws its mesh.
#[derive(Clone, Default)]
pub(super) struct Deformation {
    /// Weights of the morph targets. Missing weights are 0.
    pub weights: Vec<f32>,
    pub skin: Option<Rc<Skin>>,
}

impl PartialEq for Deformation {
    fn eq(&self, other: &Self) -> bool {
        let bits = |deformation: &Self| deformation.weights.iter().map(|weight| weight.to_bits()).collect::<Vec<_>>();
        let skin = |deformation: &Self| deformation.skin.as_ref().map(|skin| skin.index);
        bits(self) == bits(other) && skin(self) == skin(other)
    }
}

impl Eq for Deformation {}

impl Hash for Deformation {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.weights.iter().for_each(|weight| weight.to_bits().hash(state));
        self.skin.as_ref().map(|skin| skin.index).hash(state);
    }
}

/// A skin whose joints are at rest.
pub(super) struct Skin {
    index: usize,
    /// The map from the space of the mesh to that of the scene, for each joint.
    joints: Vec<Mat4>,
}

impl Skin {
    /// Reads a skin. `world` has the matrix of each node of the file.
    pub fn read(source: &Source<'_>, index: Index<SkinSource>, world: &[DMat4], user: &str) -> Result<Self, Fault> {
        let skin = source.get(index, user)?;
        let element = format!("skins[{index}]");
        if skin.joints.is_empty() {
            return Err(Fault::new(element, "has no joints"));
        }
        let inverses = match skin.inverse_bind_matrices {
            Some(accessor) => {
                let user = format!("{element}.inverseBindMatrices");
                let inverses = Elements::open(source, accessor, Type::Mat4, &[ComponentType::F32], &user)?;
                if inverses.len() < skin.joints.len() {
                    let reason = format!("{} matrices for {} joints", inverses.len(), skin.joints.len());
                    return Err(Fault::new(user, reason));
                }
                Some(inverses)
            }
            None => None,
        };
        let mut joints = Vec::new();
        for (number, joint) in skin.joints.iter().enumerate() {
            let element = format!("{element}.joints[{number}]");
            source.get(*joint, &element)?;
            let inverse = inverses.as_ref().map_or([0.0; 16], |inverses| inverses.vector::<16>(number));
            let inverse = if inverses.is_some() { Mat4::from_cols_array(&inverse) } else { Mat4::IDENTITY };
            let matrix = (world.get(joint.value()).copied().unwrap_or_default() * inverse.as_dmat4()).as_mat4();
            if !matrix.is_finite() {
                return Err(Fault::new(element, "its matrix is not finite"));
            }
            joints.push(matrix);
        }
        Ok(Self { index: index.value(), joints })
    }
}

impl Deformation {
    /// Moves the vertices of a mesh: morph targets first, then the skin.
    pub fn apply(&self, vertices: &Vertices<'_>, mesh: &mut Mesh, report: &mut Report) {
        for (number, &weight) in self.weights.iter().enumerate() {
            if weight != 0.0 {
                morph(vertices, number, weight, mesh, report);
            }
        }
        if let Some(skin) = &self.skin {
            match Influences::open(vertices, report) {
                Ok(influences) => influences.bend(skin, vertices, mesh, report),
                // The node of a skinned mesh does not place it.
                Err(fault) => report.replace(fault, "the primitive is drawn where its first joint is"),
            }
        }
    }
}

/// True if all primitives of a mesh have joints and weights that can be read. Otherwise the mesh is drawn where its node is.
pub(super) fn check_influences(source: &Source<'_>, mesh: &MeshSource, element: &str) -> Result<(), Fault> {
    for (number, primitive) in mesh.primitives.iter().enumerate() {
        let position = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
        let Some(accessor) = position.and_then(|&position| source.get(position, "").ok()) else { continue };
        let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        let element = format!("{element}.primitives[{number}]");
        Influences::set(&Vertices { source, primitive, count, kept: &[], element: &element }, 0)?;
    }
    Ok(())
}

/// Adds a weighted morph target. A target that the primitive lacks is 0.
fn morph(vertices: &Vertices<'_>, number: usize, weight: f32, mesh: &mut Mesh, report: &mut Report) {
    let targets = vertices.primitive.targets.as_deref().unwrap_or_default();
    let Some(target) = targets.get(number) else { return };
    let element = format!("{}.targets[{number}]", vertices.element);
    let mut add = |name: &str, accessor: Option<Index<Accessor>>, moved: &mut dyn Iterator<Item = &mut [f32]>| {
        let Some(accessor) = accessor else { return };
        match vertices.open(accessor, Type::Vec3, REAL, &format!("{element}.{name}")) {
            Ok(offsets) => {
                for (&vertex, moved) in vertices.kept.iter().zip(moved) {
                    let offset: [f32; 3] = offsets.vector(vertex as usize);
                    moved.iter_mut().zip(offset).for_each(|(coordinate, offset)| *coordinate += weight * offset);
                }
            }
            Err(fault) => report.replace(fault, "it is left out"),
        }
    };
    add("POSITION", target.positions, &mut mesh.positions.iter_mut().map(|position| &mut position[..]));
    add("NORMAL", target.normals, &mut mesh.normals.iter_mut().map(|normal| &mut normal[..]));
    if !mesh.tangents.is_empty() {
        // w stays.
        add("TANGENT", target.tangents, &mut mesh.tangents.iter_mut().map(|tangent| &mut tangent[..3]));
    }
}

/// The joints of each vertex, and their weights.
struct Influences<'a> {
    sets: Vec<(Elements<'a>, Elements<'a>)>,
}

impl<'a> Influences<'a> {
    fn open(vertices: &Vertices<'a>, report: &mut Report) -> Result<Self, Fault> {
        let mut sets = vec![Self::set(vertices, 0)?];
        for set in 1..MOST_SETS {
            if vertices.attribute(Semantic::Joints(set)).is_none() {
                break;
            }
            match Self::set(vertices, set) {
                Ok(opened) => sets.push(opened),
                Err(fault) => report.replace(fault, "these joints are left out"),
            }
        }
        Ok(Self { sets })
    }

    /// Joints and weights of one set.
    fn set(vertices: &Vertices<'a>, set: u32) -> Result<(Elements<'a>, Elements<'a>), Fault> {
        const JOINT: &[ComponentType] = &[ComponentType::U8, ComponentType::U16];
        let user = |name: &str| format!("{}.attributes.{name}_{set}", vertices.element);
        let open = |name: &str, semantic: Semantic, components: &[ComponentType]| {
            let accessor = vertices.attribute(semantic);
            let accessor = accessor.ok_or_else(|| Fault::new(user(name), "is not there, and the mesh has a skin"))?;
            vertices.open(accessor, Type::Vec4, components, &user(name))
        };
        Ok((open("JOINTS", Semantic::Joints(set), JOINT)?, open("WEIGHTS", Semantic::Weights(set), REAL)?))
    }

    /// Linear blend skinning (Magnenat-Thalmann et al. 1988): Σ wⱼ Mⱼ p, with weights normalised to a sum of 1. A vertex without weights
    /// follows its first joint. If the joints mirror, triangles are reversed, so that their front stays the front.
    fn bend(&self, skin: &Skin, vertices: &Vertices<'_>, mesh: &mut Mesh, report: &mut Report) {
        let mut foreign = 0;
        let mut unweighted = 0;
        let mut mirrored = 0;
        for (place, &vertex) in vertices.kept.iter().enumerate() {
            let mut sum = Mat4::ZERO;
            let mut total = 0.0;
            let mut first = None;
            for (joints, weights) in &self.sets {
                let joints: [u32; 4] = joints.integers(vertex as usize);
                let weights = Vec4::from(weights.normalized::<4>(vertex as usize));
                for (joint, weight) in joints.into_iter().zip(weights.to_array()) {
                    if first.is_none() {
                        first = skin.joints.get(joint as usize);
                    }
                    if weight == 0.0 || !weight.is_finite() {
                        continue;
                    }
                    match skin.joints.get(joint as usize) {
                        Some(&matrix) => {
                            sum += matrix * weight;
                            total += weight;
                        }
                        None => foreign += 1,
                    }
                }
            }
            let matrix = if total > 1e-6 {
                sum * (1.0 / total)
            } else {
                unweighted += 1;
                first.copied().unwrap_or(skin.joints[0])
            };
            mirrored += usize::from(matrix.determinant() < 0.0);
            if let Some(position) = mesh.positions.get_mut(place) {
                *position = matrix.transform_point3((*position).into()).to_array();
            }
            let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(Vec4::truncate);
            let sign = Mat3::from_cols(x, y, z).determinant().signum();
            if let Some(tangent) = mesh.tangents.get_mut(place) {
                let [right, up, front, w] = *tangent;
                let direction = (x * right + y * up + z * front).normalize_or_zero();
                // The bitangent is moved like the tangent, but joints that mirror turn the cross product over.
                *tangent = direction.extend(w * sign).to_array();
            }
            if let Some(normal) = mesh.normals.get_mut(place) {
                // Normals transform by the transpose of the inverse. Its scale does not matter here, so the cofactors will do.
                let cofactors = Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign;
                // Joints in centimetres make normals short, and one far from length 1 would count as having no direction.
                *normal = (cofactors * Vec3::from(*normal)).normalize_or_zero().to_array();
            }
        }
        if 2 * mirrored > vertices.kept.len() {
            mesh.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        }
        if unweighted > 0 {
            let reason = format!("{unweighted} vertices have no weights above 0; they follow their first joints");
            report.warn(format!("{}.attributes.WEIGHTS_0", vertices.element), reason);
        }
        if foreign > 0 {
            let joints = skin.joints.len();
            let reason = format!("{foreign} joints are not among the {joints} of the skin; they are left out");
            report.warn(format!("{}.attributes.JOINTS_0", vertices.element), reason);
        }
    }
}
