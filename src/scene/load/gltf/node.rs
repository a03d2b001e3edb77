//! The node hierarchy of the default scene.

use std::collections::HashSet;

use gltf::json::{Index, Node as NodeSource};
use serde_json::Value;

use super::instancing::instances;
use super::mesh::Meshes;
use super::skin::{Skins, check_influences};
use super::source::{Places, Source, lookup};
use super::transform::{separate, transform};
use super::{camera, light};
use crate::scene::description::{Node, Scene};
use crate::scene::load::common::report::Report;

/// A node and its parent, if it has one.
type Link = (Index<NodeSource>, Option<Index<NodeSource>>);

/// Reads the nodes of the default scene, and the meshes, lights and cameras that they place. Returns the index in the scene of each node
/// and of each light of the file.
pub(super) fn read_all(source: &Source<'_>, report: &mut Report, scene: &mut Scene) -> (Places, Vec<Option<usize>>) {
    let lights = light::read_all(source, report, scene);
    let cameras = camera::read_all(source, report, scene);
    let animated = animated(source);
    let mut shapes = Shapes { source, meshes: Meshes::new(source), skins: Skins::default() };
    let mut places = Places::new();
    let mut placed = 0;
    let mut hidden = HashSet::new();

    for (index, parent) in ordered(source, report) {
        let element = format!("nodes[{index}]");
        let Ok(node) = source.get(index, &element) else { continue };
        let is_hidden = is_hidden(node, &element, report) || parent.is_some_and(|p| hidden.contains(&p.value()));
        if is_hidden {
            hidden.insert(index.value());
        }
        let light = node.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref());
        let light = light.filter(|_| !is_hidden);
        let light = light.and_then(|light| {
            let found = lookup(light::listed(source), light.light, &format!("{element}.light"));
            found.map_err(|fault| report.replace(fault, "it is left out")).ok()?;
            lights.get(light.light.value()).copied().flatten()
        });
        let camera = node.camera.and_then(|camera| {
            let found = source.get(camera, &format!("{element}.camera"));
            found.map_err(|fault| report.replace(fault, "it is left out")).ok()?;
            cameras.get(camera.value()).copied().flatten()
        });
        let transform = transform(node, &element, report);
        let transform =
            if animated.contains(&index.value()) { separate(transform, &element, report) } else { transform };
        let Shaped { meshes, weights, skin } =
            if is_hidden { Shaped::default() } else { shapes.of(node, &element, report, scene) };
        let place = scene.nodes.len();
        places.insert(index.value(), place);
        let name = node.name.clone().unwrap_or_default();
        let parent = parent.and_then(|parent| places.get(&parent.value())).copied();
        let own = Node { name: name.clone(), parent, transform, light, camera, ..Node::default() };
        if skin.is_some() {
            let others = node.extensions.as_ref().map(|extensions| &extensions.others);
            if others.is_some_and(|others| others.contains_key("EXT_mesh_gpu_instancing")) {
                report.warn(
                    format!("{element}.EXT_mesh_gpu_instancing"),
                    "is not read beside a skin; the mesh is drawn once",
                );
            }
            scene.nodes.push(Node { meshes, weights, skin, ..own });
        } else if let Some(transforms) = instances(source, node, &element, &mut placed, report) {
            scene.nodes.push(own);
            let instance = |transform| Node {
                name: name.clone(),
                parent: Some(place),
                transform,
                meshes: meshes.clone(),
                weights: weights.clone(),
                ..Node::default()
            };
            scene.nodes.extend(transforms.into_iter().map(instance));
        } else {
            scene.nodes.push(Node { meshes, weights, ..own });
        }
    }
    Skins::find_joints(source, &animated, &mut places, report, scene);
    (places, lights)
}

/// True if a node says that it and all below it are not drawn (KHR_node_visibility).
fn is_hidden(node: &NodeSource, element: &str, report: &mut Report) -> bool {
    let others = node.extensions.as_ref().map(|extensions| &extensions.others);
    let Some(extension) = others.and_then(|others| others.get("KHR_node_visibility")) else { return false };
    match extension.get("visible") {
        None => false,
        Some(Value::Bool(visible)) => !visible,
        Some(other) => {
            let reason = format!("{other} is neither true nor false; the node is drawn");
            report.warn(format!("{element}.KHR_node_visibility.visible"), reason);
            false
        }
    }
}

/// The meshes of a node, and the weights and the skin that shape them.
#[derive(Default)]
struct Shaped {
    meshes: Vec<usize>,
    weights: Vec<f32>,
    skin: Option<usize>,
}

/// The meshes and skins that nodes use.
struct Shapes<'a> {
    source: &'a Source<'a>,
    meshes: Meshes<'a>,
    skins: Skins,
}

impl Shapes<'_> {
    /// The meshes of a node in their shape.
    fn of(&mut self, node: &NodeSource, element: &str, report: &mut Report, scene: &mut Scene) -> Shaped {
        let Some(index) = node.mesh else { return Shaped::default() };
        let mesh = match self.source.get(index, &format!("{element}.mesh")) {
            Ok(mesh) => mesh,
            Err(fault) => {
                report.lose(fault);
                return Shaped::default();
            }
        };
        // An empty list is no list.
        let weights = node.weights.clone().filter(|weights| !weights.is_empty());
        let mut weights = weights.or_else(|| mesh.weights.clone()).unwrap_or_default();
        if weights.iter().any(|weight| !weight.is_finite()) {
            report.warn(format!("{element}.weights"), "a weight is not finite; 0 is used");
            weights.iter_mut().filter(|weight| !weight.is_finite()).for_each(|weight| *weight = 0.0);
        }
        let user = format!("{element}.skin");
        let mut skin = node.skin.and_then(|skin| self.skins.get(self.source, skin, &user, report, scene));
        if skin.is_some()
            && let Err(fault) = check_influences(self.source, mesh, &format!("meshes[{index}]"))
        {
            report.replace(fault, "the mesh is drawn where its node is");
            skin = None;
        }
        let joints = skin.and_then(|skin| scene.skins.get(skin)).map(|skin| skin.joints.len());
        Shaped { meshes: self.meshes.get(index, joints, report, scene), weights, skin }
    }
}

/// The nodes of the default scene, each with its parent, parents first, each once.
fn ordered(source: &Source<'_>, report: &mut Report) -> Vec<Link> {
    let mut roots = roots(source, report);
    roots.retain(|&root| exists(source, root, "scene.nodes", report));
    let children: Vec<Vec<Index<NodeSource>>> = source
        .root
        .nodes
        .iter()
        .enumerate()
        .map(|(node, description)| {
            let user = format!("nodes[{node}].children");
            let listed = description.children.as_deref().unwrap_or_default();
            listed.iter().copied().filter(|&child| exists(source, child, &user, report)).collect()
        })
        .collect();

    // A scene may list a node that is also the child of another one. The node is drawn once, below its parent.
    let mut reachable = HashSet::new();
    let mut below = HashSet::new();
    let mut open = roots.clone();
    while let Some(node) = open.pop() {
        if reachable.insert(node.value()) {
            below.extend(children[node.value()].iter().map(Index::value));
            open.extend(&children[node.value()]);
        }
    }

    let mut order = Vec::with_capacity(reachable.len());
    let mut seen = HashSet::new();
    let mut open: Vec<Link> =
        roots.iter().rev().filter(|root| !below.contains(&root.value())).map(|&root| (root, None)).collect();
    loop {
        while let Some((node, parent)) = open.pop() {
            if seen.insert(node.value()) {
                order.push((node, parent));
                open.extend(children[node.value()].iter().rev().map(|&child| (child, Some(node))));
            } else if parent.is_some() {
                let reason = "is the child of more than one node, or its own ancestor; it is drawn once";
                report.warn(format!("nodes[{node}]"), reason);
            }
        }
        // A circle has no root of its own.
        let Some(&next) = reachable.iter().filter(|node| !seen.contains(node)).min() else { break };
        open.push((Index::new(next as u32), None));
    }
    order
}

/// True if there is such a node. Warns if not.
fn exists(source: &Source<'_>, node: Index<NodeSource>, user: &str, report: &mut Report) -> bool {
    let found = source.get(node, user);
    found.map_err(|fault| report.replace(fault, "it is left out")).is_ok()
}

/// The roots of the default scene: of the scene that the file names, else of its first scene, else all nodes without a parent.
fn roots(source: &Source<'_>, report: &mut Report) -> Vec<Index<NodeSource>> {
    let root = &source.root;
    if let Some(scene) = root.scene {
        match source.get(scene, "scene") {
            Ok(scene) => return scene.nodes.clone(),
            Err(fault) => report.replace(fault, "the first scene is drawn"),
        }
    }
    if let Some(first) = root.scenes.first() {
        return first.nodes.clone();
    }
    if !root.nodes.is_empty() {
        report.warn("scenes", "the file has no scene; all its nodes are drawn");
    }
    let children: HashSet<usize> =
        root.nodes.iter().flat_map(|node| node.children.iter().flatten()).map(Index::value).collect();
    let orphans = (0..root.nodes.len()).filter(|node| !children.contains(node));
    orphans.filter_map(|node| u32::try_from(node).ok()).map(Index::new).collect()
}

/// The nodes that some animation moves.
fn animated(source: &Source<'_>) -> HashSet<usize> {
    let channels = source.root.animations.iter().flat_map(|animation| &animation.channels);
    channels.map(|channel| channel.target.node.value()).collect()
}
