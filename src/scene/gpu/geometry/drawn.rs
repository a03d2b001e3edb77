//! The meshes of a scene in the shapes in which nodes draw them at rest.

use crate::scene::description::{Mesh, Node, Pose, Scene, Shape, Skin, WorldMatrix, shape};
use glam::DVec3;
use std::collections::BTreeMap;

/// A mesh in one shape, and the nodes that draw it.
pub(crate) struct Drawn<'a> {
    mesh: &'a Mesh,
    /// `None` for the mesh as it is.
    shape: Option<Shape>,
    mirrored: bool,
    /// Nodes that place it. Empty if joints have placed it in the world.
    pub nodes: Vec<usize>,
    /// The node and the joints that change the shape, if it may ever change.
    pub source: Option<ShapeSource>,
}

/// The parts of a pose from which a shape follows.
#[derive(Clone, Debug)]
pub(crate) struct ShapeSource {
    /// The node with the weights of the morph targets.
    pub node: usize,
    pub skin: Option<Skin>,
}

impl ShapeSource {
    /// The shape of the mesh in a pose of its scene.
    pub fn shape(&self, mesh: &Mesh, pose: &Pose) -> Shape {
        let joints = self.skin.as_ref().and_then(|skin| skin.matrices(pose));
        shape(mesh, &pose.weights[self.node], joints.as_deref())
    }

    /// The joints and weights of a pose from which the shape follows.
    pub fn inputs(&self, pose: &Pose) -> (Vec<WorldMatrix>, Vec<f32>) {
        (self.joints().map(|joint| pose.world[joint]).collect(), pose.weights[self.node].clone())
    }

    /// The nodes of the joints.
    fn joints(&self) -> impl Iterator<Item = usize> {
        self.skin.iter().flat_map(|skin| skin.joints.iter().copied())
    }
}

/// A mesh and its shape at one moment.
#[derive(Clone, Copy)]
pub(crate) struct Posed<'a> {
    pub mesh: &'a Mesh,
    /// `None` for the mesh as it is.
    pub shape: Option<&'a Shape>,
    /// True if joints mirror the mesh, which reverses the winding of its triangles. It is reversed again, so that the front stays the
    /// front.
    pub mirrored: bool,
}

impl Drawn<'_> {
    pub fn posed(&self) -> Posed<'_> {
        Posed { mesh: self.mesh, shape: self.shape.as_ref(), mirrored: self.mirrored }
    }

    /// True if joints have placed the mesh in the world.
    pub fn is_in_world(&self) -> bool {
        self.nodes.is_empty()
    }
}

impl Posed<'_> {
    pub fn position(&self, vertex: u32) -> DVec3 {
        match self.shape {
            Some(shape) => shape.positions[vertex as usize].into(),
            None => self.mesh.positions[vertex as usize].map(f64::from).into(),
        }
    }

    pub fn normals(&self) -> &[[f32; 3]] {
        self.shape.map_or(&self.mesh.normals, |shape| &shape.normals)
    }
}

/// The meshes that nodes draw, each in each of its shapes at rest.
pub(crate) fn drawn<'a>(scene: &'a Scene, pose: &Pose) -> Vec<Drawn<'a>> {
    let (moves, morphs) = (scene.animated_nodes(), scene.morphing_nodes());
    let mut uses: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (node, description) in scene.nodes.iter().enumerate() {
        for &mesh in &description.meshes {
            uses.entry(mesh).or_default().push(node);
        }
    }
    let mut drawn = Vec::new();
    for (mesh, nodes) in uses {
        let description = &scene.meshes[mesh];
        let mut shared: BTreeMap<Vec<u32>, Vec<usize>> = BTreeMap::new();
        let mut own = Vec::new();
        for node in nodes {
            let skin = scene.nodes[node].skin.filter(|_| description.is_skinned()).map(|skin| &scene.skins[skin]);
            let follows = skin.is_some_and(|skin| skin.joints.iter().any(|&joint| moves[joint]))
                || !description.targets.is_empty() && morphs[node];
            if skin.is_some() || follows {
                let source = follows.then(|| ShapeSource { node, skin: skin.cloned() });
                own.push(of_node(scene, pose, mesh, node, source));
            } else {
                shared.entry(lasting_weights(&scene.nodes[node], description)).or_default().push(node);
            }
        }
        for (weights, nodes) in shared {
            let shape = (!weights.is_empty()).then(|| scene.shape(pose, nodes[0], mesh)).flatten();
            drawn.push(Drawn { mesh: description, shape, mirrored: false, nodes, source: None });
        }
        drawn.extend(own);
    }
    drawn
}

/// A mesh in a shape that no other node has.
fn of_node<'a>(scene: &'a Scene, pose: &Pose, mesh: usize, node: usize, source: Option<ShapeSource>) -> Drawn<'a> {
    let shape = scene.shape(pose, node, mesh);
    let turns = shape.as_ref().map_or(&[][..], |shape| &shape.turns);
    let turned_over = turns.iter().filter(|turn| turn.determinant() < 0.0).count();
    let nodes = if turns.is_empty() { vec![node] } else { Vec::new() };
    Drawn { mesh: &scene.meshes[mesh], mirrored: 2 * turned_over > turns.len(), shape, nodes, source }
}

/// The bits of the weights that a node gives to a mesh. Empty if all are 0.
fn lasting_weights(node: &Node, mesh: &Mesh) -> Vec<u32> {
    let weights = node.weights.iter().take(mesh.targets.len());
    let bits: Vec<u32> = weights.map(|weight| if *weight == 0.0 { 0 } else { weight.to_bits() }).collect();
    if bits.iter().all(|&bits| bits == 0) { Vec::new() } else { bits }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::description::{IDENTITY, Influence, Material, MorphTarget};

    /// A mesh with two targets and one joint, which these nodes draw beside a joint.
    fn scene(nodes: Vec<Node>) -> Scene {
        let target = MorphTarget { vertices: vec![0], positions: vec![[1.0, 0.0, 0.0]], ..Default::default() };
        let mesh = Mesh {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            triangles: vec![[0, 1, 2]],
            targets: vec![target.clone(), target],
            influences: vec![Influence { joint: 0, weight: 1.0 }; 3],
            ..Default::default()
        };
        let draws = |node| Node { meshes: vec![0], ..node };
        Scene {
            meshes: vec![mesh],
            materials: vec![Material::default()],
            skins: vec![Skin { joints: vec![0], inverse_bind: vec![IDENTITY] }],
            nodes: std::iter::once(Node::default()).chain(nodes.into_iter().map(draws)).collect(),
            ..Default::default()
        }
    }

    fn weighted(weights: &[f32]) -> Node {
        Node { weights: weights.to_vec(), ..Default::default() }
    }

    /// The nodes of each shape, whether it differs from the mesh, and whether it follows the pose.
    fn of(scene: &Scene) -> Vec<(Vec<usize>, bool, bool)> {
        let shapes = drawn(scene, &scene.pose(None, 0.0)).into_iter();
        shapes.map(|drawn| (drawn.nodes, drawn.shape.is_some(), drawn.source.is_some())).collect()
    }

    #[test]
    fn nodes_share_a_mesh_in_one_shape() {
        let nodes = [&[][..], &[0.0, 0.5], &[0.0, -0.0], &[0.0, 0.5], &[1.0]].map(weighted);
        assert_eq!(
            of(&scene(nodes.to_vec())),
            [(vec![1, 3], false, false), (vec![2, 4], true, false), (vec![5], true, false)]
        );
    }

    #[test]
    fn meshes_follow_what_may_move() {
        let skinned = Node { skin: Some(0), ..Default::default() };
        let mut scene = scene(vec![Node { movable: true, ..Default::default() }, skinned, weighted(&[])]);
        let still = [(vec![3], false, false), (vec![1], true, true), (vec![], true, false)];
        assert_eq!(of(&scene), still, "weights of a node that the host moves, and a skin at rest");
        scene.nodes[0].movable = true;
        let moving = [(vec![3], false, false), (vec![1], true, true), (vec![], true, true)];
        assert_eq!(of(&scene), moving, "a joint that the host moves");
    }

    #[test]
    fn joints_that_mirror_keep_the_front() {
        let mut scene = scene(vec![Node { skin: Some(0), ..Default::default() }]);
        assert!(!drawn(&scene, &scene.pose(None, 0.0))[0].mirrored);
        scene.skins[0].inverse_bind[0][0][0] = -1.0;
        assert!(drawn(&scene, &scene.pose(None, 0.0))[0].mirrored);
    }
}
