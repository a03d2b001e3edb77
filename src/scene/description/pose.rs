//! The hierarchy at one moment.

use glam::{DMat4, DQuat, DVec3, Mat4};

use super::animation::unit;
use super::{Animation, Matrix, Node, Scene, Target, Transform, WorldMatrix};

/// The moving parts of a [`Scene`] at one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// World matrix of each node, in double precision so that a small offset survives beside a large one.
    pub world: Vec<WorldMatrix>,
    /// Weights of the morph targets of each node's meshes, one for each target of the mesh that has most.
    pub weights: Vec<Vec<f32>>,
    /// Factor on the emission of each material, per colour channel.
    pub emission: Vec<[f32; 3]>,
    /// Factor on the intensity of each light, per colour channel.
    pub intensity: Vec<[f32; 3]>,
}

impl Scene {
    /// Evaluates the hierarchy at `time` seconds of an animation. The animation repeats for ever: `time` is taken modulo
    /// [`Scene::duration`]. A curve holds its first value before its first key and its last value after its last key.
    ///
    /// `None`, an index out of range, or a time that is not finite gives the rest pose, with factors of 1 or
    /// [`Scene::resting_factors`].
    pub fn pose(&self, animation: Option<usize>, time: f32) -> Pose {
        let mut locals: Vec<Local> = self.nodes.iter().map(|node| Local::new(node.transform)).collect();
        let mut weights: Vec<Vec<f32>> = self.nodes.iter().map(|node| self.resting_weights(node)).collect();
        // Strengths and colours, each of materials and of lights.
        let mut factors =
            [self.materials.len(), self.lights.len()].map(|count| [(); 2].map(|()| vec![[1.0; 3]; count]));
        let mut factor = |target: Target, value: [f32; 3]| {
            let ([[emission, emission_color], [intensity, intensity_color]], x) = (&mut factors, value[0]);
            match target {
                Target::Emission(material) => set(emission, material, |factor| *factor = [x; 3]),
                Target::EmissionColor(material) => set(emission_color, material, |factor| *factor = value),
                Target::Intensity(light) => set(intensity, light, |factor| *factor = [x; 3]),
                Target::IntensityColor(light) => set(intensity_color, light, |factor| *factor = value),
                Target::Translation(_) | Target::Rotation(_) | Target::Scale(_) | Target::Weight { .. } => {}
            }
        };
        self.resting_factors.iter().for_each(|&(target, value)| factor(target, value));

        if let Some(playing) = animation.and_then(|index| self.animations.get(index)).filter(|_| time.is_finite()) {
            let time = looped(time, playing.duration());
            for channel in &playing.channels {
                let Some(value) = channel.sample(time) else { continue };
                match channel.target {
                    Target::Translation(node) => set(&mut locals, node, |local| local.translation = value.truncate()),
                    Target::Rotation(node) => set(&mut locals, node, |local| local.rotation = unit(value)),
                    Target::Scale(node) => set(&mut locals, node, |local| local.scale = value.truncate()),
                    Target::Weight { node, target } => set(&mut weights, node, |weights| {
                        set(weights, target, |weight| {
                            *weight = value.x.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32
                        });
                    }),
                    Target::Emission(_)
                    | Target::EmissionColor(_)
                    | Target::Intensity(_)
                    | Target::IntensityColor(_) => {
                        let limited = value.truncate().clamp(DVec3::ZERO, DVec3::splat(f32::MAX.into()));
                        factor(channel.target, limited.as_vec3().to_array())
                    }
                }
            }
        }

        // In f32, the child of a parent at 500 km would move in steps of 3 cm.
        let mut world: Vec<DMat4> = Vec::with_capacity(self.nodes.len());
        for (node, local) in self.nodes.iter().zip(&locals) {
            // One pass suffices, because parents come first.
            let parent = node.parent.and_then(|parent| world.get(parent)).copied().unwrap_or(DMat4::IDENTITY);
            world.push(parent * local.matrix());
        }
        let [emission, intensity] = factors.map(product);
        Pose { world: world.iter().map(DMat4::to_cols_array_2d).collect(), weights, emission, intensity }
    }

    /// The weights of a node at rest, one for each target of its meshes.
    fn resting_weights(&self, node: &Node) -> Vec<f32> {
        let mut weights = node.weights.clone();
        weights.resize(self.target_count(node), 0.0);
        weights
    }

    /// Number of morph targets of the mesh of a node that has most.
    pub(crate) fn target_count(&self, node: &Node) -> usize {
        let meshes = node.meshes.iter().filter_map(|&mesh| self.meshes.get(mesh));
        meshes.map(|mesh| mesh.targets.len()).max().unwrap_or(0)
    }

    /// Time of the last key of an animation in seconds, after which [`Scene::pose`] repeats. 0 if nothing moves: for `None`, for an
    /// index out of range, and for an animation that is one key at time 0.
    pub fn duration(&self, animation: Option<usize>) -> f32 {
        animation.and_then(|index| self.animations.get(index)).map_or(0.0, Animation::duration)
    }

    /// Index of the first animation of that name.
    pub fn find_animation(&self, name: &str) -> Option<usize> {
        self.animations.iter().position(|animation| animation.name == name)
    }

    /// True for each node whose weights may ever change: a [`movable`](crate::scene::Node::movable) one, and one with a weight that a
    /// channel of any animation changes.
    pub(crate) fn morphing_nodes(&self) -> Vec<bool> {
        let mut morphs: Vec<bool> = self.nodes.iter().map(|node| node.movable).collect();
        for channel in self.animations.iter().flat_map(|animation| &animation.channels) {
            if let Target::Weight { node, .. } = channel.target {
                set(&mut morphs, node, |morphs| *morphs = true);
            }
        }
        morphs
    }

    /// True for each node that may ever move: a [`movable`](crate::scene::Node::movable) one, one that a channel of any animation
    /// moves, and one whose parent may move.
    pub fn animated_nodes(&self) -> Vec<bool> {
        let mut moves: Vec<bool> = self.nodes.iter().map(|node| node.movable).collect();
        for channel in self.animations.iter().flat_map(|animation| &animation.channels) {
            if let Some(node) = channel.target.node() {
                set(&mut moves, node, |moves| *moves = true);
            }
        }
        for index in 0..moves.len() {
            let parent = self.nodes.get(index).and_then(|node| node.parent);
            let inherited = parent.and_then(|parent| moves.get(parent)).copied().unwrap_or(false);
            set(&mut moves, index, |moves| *moves |= inherited);
        }
        moves
    }
}

/// A node's own transform while channels are applied to it.
struct Local {
    translation: DVec3,
    rotation: DQuat,
    scale: DVec3,
    /// Replaces the three above in a node that cannot be animated.
    fixed: Option<Matrix>,
}

impl Local {
    fn new(transform: Transform) -> Self {
        match transform {
            Transform::Trs { translation, rotation, scale } => Self {
                translation: translation.map(f64::from).into(),
                rotation: unit(rotation.map(f64::from).into()),
                scale: scale.map(f64::from).into(),
                fixed: None,
            },
            Transform::Matrix(matrix) => {
                Self { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE, fixed: Some(matrix) }
            }
        }
    }

    fn matrix(&self) -> DMat4 {
        match &self.fixed {
            Some(matrix) => Mat4::from_cols_array_2d(matrix).as_dmat4(),
            None => DMat4::from_scale_rotation_translation(self.scale, self.rotation, self.translation),
        }
    }
}

/// Products of strengths and colours, finite.
fn product([strengths, colors]: [Vec<[f32; 3]>; 2]) -> Vec<[f32; 3]> {
    let of = |(strength, color): ([f32; 3], [f32; 3])| [0, 1, 2].map(|c| (strength[c] * color[c]).min(f32::MAX));
    strengths.into_iter().zip(colors).map(of).collect()
}

/// `time` within 0…`duration`, or 0 if nothing repeats.
fn looped(time: f32, duration: f32) -> f32 {
    if duration > 0.0 { time.rem_euclid(duration) } else { 0.0 }
}

/// Changes one element, if the index is in range.
fn set<T>(items: &mut [T], index: usize, change: impl FnOnce(&mut T)) {
    if let Some(item) = items.get_mut(index) {
        change(item);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::description::{Channel, Interpolation, Perspective};

    const FAR: f64 = 524_288.0;

    fn at(translation: [f32; 3]) -> Transform {
        Transform::Trs { translation, rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] }
    }

    /// A turned parent that is far away, and a child with a camera that moves by a millimetre.
    fn far_family() -> Scene {
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let parent = Transform::Trs {
            translation: [FAR as f32, 0.0, -FAR as f32],
            rotation: [0.0, half, 0.0, half],
            scale: [1.0; 3],
        };
        let child = Node { parent: Some(0), transform: at([0.0; 3]), camera: Some(0), ..Default::default() };
        let channel = Channel {
            target: Target::Translation(1),
            interpolation: Interpolation::Linear,
            times: vec![0.0, 1.0],
            values: vec![[0.0; 4], [1e-3, 0.0, 0.0, 0.0]],
        };
        Scene {
            nodes: vec![Node { transform: parent, ..Default::default() }, child],
            cameras: vec![Perspective { fov_y: 0.8 }],
            animations: vec![Animation { name: "move".into(), channels: vec![channel] }],
            ..Default::default()
        }
    }

    #[test]
    fn a_child_of_a_far_parent_moves_in_small_steps() {
        let scene = far_family();
        for i in 0..10 {
            let time = i as f32 / 10.0;
            let pose = scene.pose(Some(0), time);
            // A quarter turn about y takes +X to −Z.
            let [x, y, z, _] = pose.world[1][3];
            assert!((x - FAR).abs() < 1e-9 && y.abs() < 1e-9, "{x}, {y}");
            assert!((z + FAR + 1e-3 * f64::from(time)).abs() < 1e-9, "{z} at {time}");
            let view = scene.camera_view(&pose, 1).unwrap();
            assert_eq!(view.eye, [x, y, z]);
            let way = [0, 1, 2].map(|axis| view.target[axis] - view.eye[axis]);
            assert!((way[0] + 1.0).abs() < 1e-6 && way[2].abs() < 1e-6, "{way:?}");
        }
    }

    #[test]
    fn curves_between_far_keys_do_not_go_in_steps() {
        let mut scene = far_family();
        let channel = &mut scene.animations[0].channels[0];
        channel.target = Target::Translation(0);
        let keys = [[FAR as f32, 0.0, 0.0, 0.0], [FAR as f32 + 1.0, 0.0, 0.0, 0.0]];
        for interpolation in [Interpolation::Linear, Interpolation::CubicSpline] {
            let channel = &mut scene.animations[0].channels[0];
            channel.interpolation = interpolation;
            channel.values = match interpolation {
                Interpolation::CubicSpline => {
                    let tangent = [1.0, 0.0, 0.0, 0.0];
                    keys.iter().flat_map(|&key| [tangent, key, tangent]).collect()
                }
                _ => keys.to_vec(),
            };
            for time in [0.001_f32, 0.3, 0.77] {
                let x = scene.pose(Some(0), time).world[0][3][0];
                assert!((x - FAR - f64::from(time)).abs() < 1e-9, "{interpolation:?}: {x} at {time}");
            }
        }
    }

    #[test]
    fn bounds_of_what_is_far_are_as_narrow_as_near() {
        let mut scene = far_family();
        scene.materials.push(Default::default());
        scene.meshes.push(crate::scene::Mesh {
            positions: vec![[0.0; 3], [1e-3, 0.0, 0.0], [0.0, 1e-3, 0.0]],
            triangles: vec![[0, 1, 2]],
            ..Default::default()
        });
        scene.nodes[1].meshes.push(0);
        let [low, high] = scene.bounds(&scene.pose(None, 0.0)).unwrap();
        assert!((high[2] - low[2] - 1e-3).abs() < 1e-9 && (high[1] - 1e-3).abs() < 1e-9, "{low:?}, {high:?}");
    }
}
