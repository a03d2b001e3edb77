//! Skins: the joints of a file, and their shares in each vertex.

use std::collections::{HashMap, HashSet};

use glam::{Affine3A, Mat4, Vec4};
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;
use gltf::json::{Index, Mesh as MeshSource, Skin as SkinSource};

use super::accessor::{Elements, REAL};
use super::attributes::Vertices;
use super::source::{Places, Source};
use super::transform::{separate, transform};
use crate::scene::description::{Influence, Node, Scene, Skin};
use crate::scene::load::common::report::{Fault, Report};

/// Maximum number of sets of four joints of a vertex.
const MOST_SETS: u32 = 8;

/// Least sum of the weights of a vertex that counts as weights.
const LEAST_SUM: f32 = 1e-6;

/// The skins of a file that nodes use.
#[derive(Default)]
pub(super) struct Skins {
    /// Index in [`Scene::skins`] of each skin that was asked for, or `None` for a broken one.
    known: HashMap<usize, Option<usize>>,
}

impl Skins {
    /// The index of a skin in the scene. The joints of skins are nodes of the file until [`Skins::find_joints`] finds them in the scene.
    pub fn get(
        &mut self,
        source: &Source<'_>,
        index: Index<SkinSource>,
        user: &str,
        report: &mut Report,
        scene: &mut Scene,
    ) -> Option<usize> {
        *self.known.entry(index.value()).or_insert_with(|| match read(source, index, user, report) {
            Ok(skin) => {
                scene.skins.push(skin);
                Some(scene.skins.len() - 1)
            }
            Err(fault) => {
                report.replace(fault, "the mesh is drawn without its skin");
                None
            }
        })
    }

    /// Finds the joints among the nodes of the scene. Joints outside of it, and their parents, become nodes that draw nothing.
    pub fn find_joints(
        source: &Source<'_>,
        animated: &HashSet<usize>,
        places: &mut Places,
        report: &mut Report,
        scene: &mut Scene,
    ) {
        let mut skins = std::mem::take(&mut scene.skins);
        let parents = if skins.is_empty() { HashMap::new() } else { parents(source) };
        for joint in skins.iter_mut().flat_map(|skin| &mut skin.joints) {
            let mut way = Vec::new();
            let mut next = Some(*joint);
            // The length ends circles.
            while let Some(node) = next.filter(|node| !places.contains_key(node) && way.len() < source.root.nodes.len())
            {
                way.push(node);
                next = parents.get(&node).copied();
            }
            let mut parent = next.and_then(|node| places.get(&node)).copied();
            for node in way.into_iter().rev() {
                let (element, description) = (format!("nodes[{node}]"), &source.root.nodes[node]);
                let own = transform(description, &element, report);
                let own = if animated.contains(&node) { separate(own, &element, report) } else { own };
                places.insert(node, scene.nodes.len());
                let name = description.name.clone().unwrap_or_default();
                scene.nodes.push(Node { name, parent, transform: own, ..Node::default() });
                parent = places.get(&node).copied();
            }
            *joint = parent.unwrap_or_default();
        }
        scene.skins = skins;
    }
}

/// The parent of each node of the file that has one: the first that lists it.
fn parents(source: &Source<'_>) -> HashMap<usize, usize> {
    let mut parents = HashMap::new();
    for (index, node) in source.root.nodes.iter().enumerate() {
        for child in node.children.iter().flatten() {
            parents.entry(child.value()).or_insert(index);
        }
    }
    parents
}

fn read(source: &Source<'_>, index: Index<SkinSource>, user: &str, report: &mut Report) -> Result<Skin, Fault> {
    let skin = source.get(index, user)?;
    let element = format!("skins[{index}]");
    if skin.joints.is_empty() {
        return Err(Fault::new(element, "has no joints"));
    }
    for (number, joint) in skin.joints.iter().enumerate() {
        source.get(*joint, &format!("{element}.joints[{number}]"))?;
    }
    let joints: Vec<usize> = skin.joints.iter().map(Index::value).collect();
    let mut inverse_bind = vec![Mat4::IDENTITY.to_cols_array_2d(); joints.len()];
    if let Some(accessor) = skin.inverse_bind_matrices {
        let user = format!("{element}.inverseBindMatrices");
        let inverses = Elements::open(source, accessor, Type::Mat4, &[ComponentType::F32], &user)?;
        if inverses.len() < joints.len() {
            return Err(Fault::new(user, format!("{} matrices for {} joints", inverses.len(), joints.len())));
        }
        for (joint, matrix) in inverse_bind.iter_mut().enumerate() {
            let read = Mat4::from_cols_array(&inverses.vector::<16>(joint));
            if !read.is_finite() {
                return Err(Fault::new(user, format!("matrix {joint} is not finite")));
            }
            // Exporters that invert matrices leave rounding errors here.
            if !read.row(3).abs_diff_eq(Vec4::W, 1e-4) {
                let reason = format!("the last row of matrix {joint} is {}, where 0, 0, 0, 1 belongs", read.row(3));
                report.replace(Fault::new(&user, reason), "the rest of it is used");
            }
            *matrix = Mat4::from(Affine3A::from_mat4(read)).to_cols_array_2d();
        }
    }
    Ok(Skin { joints, inverse_bind })
}

/// Checks that all primitives of a mesh have joints and weights that can be read. Otherwise the mesh is drawn where its node is.
pub(super) fn check_influences(source: &Source<'_>, mesh: &MeshSource, element: &str) -> Result<(), Fault> {
    for (number, primitive) in mesh.primitives.iter().enumerate() {
        let position = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
        let Some(accessor) = position.and_then(|&position| source.get(position, "").ok()) else { continue };
        let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        let element = format!("{element}.primitives[{number}]");
        set(&Vertices { source, primitive, count, kept: &[], element: &element }, 0)?;
    }
    Ok(())
}

/// The shares of a skin's joints in each vertex in use: as many for each vertex, padded with shares of 0.
pub(super) fn influences(vertices: &Vertices<'_>, joints: usize, report: &mut Report) -> Vec<Influence> {
    let sets = sets(vertices, report);
    let (mut foreign, mut unweighted) = (0, 0);
    let mut of_vertex = |&vertex: &u32| {
        let mut known = Vec::new();
        for (numbers, weights) in &sets {
            let numbers: [u32; 4] = numbers.integers(vertex as usize);
            for (joint, weight) in numbers.into_iter().zip(weights.normalized::<4>(vertex as usize)) {
                let is_weighted = weight != 0.0 && weight.is_finite();
                if (joint as usize) < joints {
                    known.push(Influence { joint, weight: if is_weighted { weight } else { 0.0 } });
                } else if is_weighted {
                    foreign += 1;
                }
            }
        }
        let first = Influence { weight: 1.0, ..known.first().copied().unwrap_or_default() };
        known.retain(|influence| influence.weight != 0.0);
        if known.iter().map(|influence| influence.weight).sum::<f32>().abs() < LEAST_SUM {
            unweighted += 1;
            known = vec![first];
        }
        known
    };
    let each: Vec<Vec<Influence>> = vertices.kept.iter().map(&mut of_vertex).collect();
    if unweighted > 0 {
        let reason = format!("{unweighted} vertices have no weights above 0; they follow their first joints");
        report.warn(format!("{}.attributes.WEIGHTS_0", vertices.element), reason);
    }
    if foreign > 0 {
        let reason = format!("{foreign} joints are not among the {joints} of the skin; they are left out");
        report.warn(format!("{}.attributes.JOINTS_0", vertices.element), reason);
    }
    let most = each.iter().map(Vec::len).max().unwrap_or(0);
    let padded = |influences: Vec<Influence>| {
        let none = Influence { weight: 0.0, ..influences[0] };
        influences.into_iter().chain(std::iter::repeat(none)).take(most)
    };
    each.into_iter().flat_map(padded).collect()
}

type Set<'a> = (Elements<'a>, Elements<'a>);

/// The sets of four joints and weights of a primitive.
fn sets<'a>(vertices: &Vertices<'a>, report: &mut Report) -> Vec<Set<'a>> {
    let mut sets = Vec::new();
    for number in 0..MOST_SETS {
        if number > 0 && vertices.attribute(Semantic::Joints(number)).is_none() {
            break;
        }
        match set(vertices, number) {
            Ok(set) => sets.push(set),
            Err(fault) => report.replace(fault, "these joints are left out"),
        }
    }
    sets
}

/// Joints and weights of one set.
fn set<'a>(vertices: &Vertices<'a>, number: u32) -> Result<Set<'a>, Fault> {
    const JOINT: &[ComponentType] = &[ComponentType::U8, ComponentType::U16];
    let user = |name: &str| format!("{}.attributes.{name}_{number}", vertices.element);
    let open = |name: &str, semantic: Semantic, components: &[ComponentType]| {
        let accessor = vertices.attribute(semantic);
        let accessor = accessor.ok_or_else(|| Fault::new(user(name), "is not there, and the mesh has a skin"))?;
        vertices.open(accessor, Type::Vec4, components, &user(name))
    };
    Ok((open("JOINTS", Semantic::Joints(number), JOINT)?, open("WEIGHTS", Semantic::Weights(number), REAL)?))
}
