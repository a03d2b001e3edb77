//! The scene on show: its source, and its moving parts.

use crate::dropped::Files;
use crate::state::Motion;
use asvgf::Camera;
use asvgf::scene::{self, Animation, Loaded, Pose, Scene, SceneError, builtin};
use asvgf_fallbacks::framing::{bounds, framing};
use asvgf_fallbacks::shipped;
use asvgf_fallbacks::sky::{is_dark, sky};
use glam::{DMat4, DVec3, Vec3};
use std::path::Path;

/// Seconds for which a blinking lamp is on, and then off.
const BLINK: f32 = 1.0;

/// Animations that the demo makes of others: these are kept separate, so that any combination can play. Blinking lamps need no animation.
const COMPOSED: [&str; 3] = ["static", "blink", "all"];

/// Name of the animation that moves a built-in scene's own camera.
const CAMERA: &str = "move-camera";

/// A scene, with the nodes that the user can move by hand.
pub struct Stage {
    pub scene: Scene,
    /// Notes on the parts of a file that were left out or added.
    pub notes: Vec<String>,
    /// Name of the object that the user can move.
    pub object_name: Option<String>,
    /// All animations of the scene; `scene` itself has the playing ones, merged into one.
    animations: Vec<Animation>,
    /// For each node, true if it moves with the lamps, or with the object.
    with_lamps: Vec<bool>,
    with_object: Vec<bool>,
    bounds: [DVec3; 2],
}

impl Stage {
    /// Opens a built-in scene, a shipped file or any other file. The error is a text for the user.
    pub fn open(name: &str) -> Result<Self, String> {
        if let Some(stage) = Self::built_in(name) {
            return Ok(stage);
        }
        match shipped::load(name) {
            Some(file) => Self::loaded(file.map(|mut loaded| {
                loaded.scene.animations.retain(|animation| !COMPOSED.contains(&animation.name.as_str()));
                loaded
            })),
            None => Self::loaded(scene::load(name)),
        }
    }

    fn built_in(name: &str) -> Option<Self> {
        let mut scene = builtin::scene(name, "all")?;
        let single = builtin::animations(name).iter().copied().filter(|n| !COMPOSED.contains(n));
        scene.animations = single.filter_map(|n| builtin::scene(name, n)).flat_map(|s| s.animations).collect();
        let object =
            scene.nodes.iter().position(|node| ["tall block", "block", "gold ball"].contains(&node.name.as_str()));
        Some(Self::new(scene, object, Vec::new()))
    }

    /// Opens a file in memory, with the files that it refers to.
    pub fn from_memory(files: &Files, path: &Path) -> Result<Self, String> {
        Self::loaded(scene::load_from_memory(files, path))
    }

    fn loaded(loaded: Result<Loaded, SceneError>) -> Result<Self, String> {
        let loaded = loaded.map_err(|error| error.to_string())?;
        let mut scene = loaded.scene;
        let mut notes: Vec<String> = loaded.warnings.iter().map(|w| format!("{}: {}", w.element, w.reason)).collect();
        if is_dark(&scene) {
            notes.push("the scene has no light; a soft sky was added".into());
            scene.environment = Some(sky());
        }
        for (i, animation) in scene.animations.iter_mut().enumerate().filter(|(_, a)| a.name.is_empty()) {
            animation.name = format!("animation {i}");
        }
        // The smallest mesh is the object, because the others may be the room.
        let size =
            |node: usize| scene.nodes[node].meshes.iter().map(|&m| scene.meshes[m].triangles.len()).sum::<usize>();
        let solid = |&node: &usize| !scene.nodes[node].meshes.is_empty() && !emits(&scene, node);
        let several = (0..scene.nodes.len()).filter(solid).count() > 1;
        let object = (0..scene.nodes.len()).filter(solid).min_by_key(|&n| size(n)).filter(|_| several);
        Ok(Self::new(scene, object, notes))
    }

    fn new(mut scene: Scene, object: Option<usize>, notes: Vec<String>) -> Self {
        let lamps: Vec<usize> = (0..scene.nodes.len()).filter(|&n| emits(&scene, n)).collect();
        for &node in lamps.iter().chain(&object) {
            scene.nodes[node].movable = true;
        }
        let with_lamps = followers(&scene, |node| lamps.contains(&node));
        let with_object = followers(&scene, |node| Some(node) == object);
        let bounds = bounds(&scene).unwrap_or([DVec3::NEG_ONE, DVec3::ONE]);
        let name = |node: usize| Some(&scene.nodes[node].name).filter(|n| !n.is_empty()).cloned();
        Self {
            object_name: object.map(|node| name(node).unwrap_or_else(|| format!("node {node}"))),
            animations: scene.animations.clone(),
            with_lamps,
            with_object,
            bounds,
            notes,
            scene,
        }
    }

    /// Names of the animations. Blinking lamps and a trembling camera need none.
    pub fn animations(&self) -> impl Iterator<Item = &str> {
        self.animations.iter().map(|a| a.name.as_str())
    }

    /// Returns true if there is a lamp that can be switched and moved.
    pub fn has_lamps(&self) -> bool {
        self.with_lamps.contains(&true)
    }

    /// Greatest distance of a move by hand, in metres.
    pub fn reach(&self) -> f32 {
        (0.25 * (self.bounds[1] - self.bounds[0]).max_element()) as f32
    }

    /// The centre of the scene.
    pub fn centre(&self) -> [f64; 3] {
        (0.5 * (self.bounds[0] + self.bounds[1])).to_array()
    }

    /// The pose of the scene at a time.
    pub fn pose(&mut self, motion: &Motion, time: f32) -> Pose {
        self.scene.animations = vec![self.together(&motion.playing)];
        let mut pose = self.scene.pose(Some(0), time);
        let factor = if motion.lit && !(motion.blink && is_out(time)) { motion.brightness } else { 0.0 };
        for channels in pose.emission.iter_mut().chain(&mut pose.intensity) {
            *channels = [0, 1, 2].map(|c| channels[c] * factor * motion.tint[c]);
        }
        for (node, world) in pose.world.iter_mut().enumerate() {
            for (follows, offset) in [(&self.with_lamps, motion.lamp), (&self.with_object, motion.object)] {
                if follows[node] {
                    let moved = DMat4::from_translation(Vec3::from(offset).as_dvec3());
                    *world = (moved * DMat4::from_cols_array_2d(world)).to_cols_array_2d();
                }
            }
        }
        pose
    }

    /// The scene's own camera, or one that frames the scene.
    pub fn camera(&self, pose: &Pose, aspect: f32) -> Camera {
        let own = self.scene.camera_node().and_then(|node| self.scene.camera_view(pose, node));
        own.unwrap_or_else(|| framing(self.bounds, aspect, 0.7))
    }

    /// Returns true if an animation moves the camera.
    pub fn moves_camera(name: &str) -> bool {
        name == CAMERA
    }

    /// Merges the playing animations into one. If two move the same target, the first one does.
    fn together(&self, playing: &[String]) -> Animation {
        let mut one = Animation::default();
        for channel in self.animations.iter().filter(|a| playing.contains(&a.name)).flat_map(|a| &a.channels) {
            if !one.channels.iter().any(|c| c.target == channel.target) {
                one.channels.push(channel.clone());
            }
        }
        one
    }
}

/// Returns true while blinking lamps are out.
fn is_out(time: f32) -> bool {
    (time / BLINK).rem_euclid(2.0) >= 1.0
}

/// Returns true if a node emits light.
fn emits(scene: &Scene, node: usize) -> bool {
    let node = &scene.nodes[node];
    let bright =
        |mesh: &usize| scene.materials.get(scene.meshes[*mesh].material).is_some_and(|m| m.emissive != [0.0; 3]);
    node.light.is_some() || node.meshes.iter().any(bright)
}

/// For each node, returns true if it or one of its ancestors is chosen.
fn followers(scene: &Scene, chosen: impl Fn(usize) -> bool) -> Vec<bool> {
    let mut follows: Vec<bool> = Vec::with_capacity(scene.nodes.len());
    for (i, node) in scene.nodes.iter().enumerate() {
        follows.push(chosen(i) || node.parent.is_some_and(|parent| follows[parent]));
    }
    follows
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cornell() -> Stage {
        Stage::open("cornell").unwrap()
    }

    fn still() -> Motion {
        Motion { blink: false, ..Motion::default() }
    }

    fn node(stage: &Stage, name: &str) -> usize {
        stage.scene.nodes.iter().position(|n| n.name == name).unwrap()
    }

    #[test]
    fn lamps_blink_and_dim() {
        let mut stage = cornell();
        let lamp =
            |stage: &mut Stage, motion: &Motion, time| stage.pose(motion, time).emission.iter().flatten().sum::<f32>();
        let on = lamp(&mut stage, &still(), 1.5);
        assert!(on > 0.0);
        let blink = Motion { blink: true, ..still() };
        assert_eq!((lamp(&mut stage, &blink, 0.5), lamp(&mut stage, &blink, 1.5)), (on, 0.0));
        assert_eq!(lamp(&mut stage, &Motion { lit: false, ..still() }, 0.0), 0.0);
        assert_eq!(lamp(&mut stage, &Motion { brightness: 0.5, ..still() }, 0.0), 0.5 * on);
        let red = stage.pose(&Motion { tint: [1.0, 0.0, 0.0], ..still() }, 0.0);
        assert!(red.emission.iter().all(|factor| *factor == [1.0, 0.0, 0.0]));
    }

    #[test]
    fn a_scene_without_a_camera_is_framed_alike_wherever_it_stands() {
        let seen = |x: f32| {
            let mut scene = cornell().scene;
            scene.nodes.iter_mut().for_each(|node| node.camera = None);
            scene.nodes.insert(0, scene::Node::default());
            for node in &mut scene.nodes[1..] {
                node.parent = Some(node.parent.map_or(0, |parent| parent + 1));
            }
            scene.animations.clear();
            let translation = [x, 0.0, -x];
            scene.nodes[0].transform =
                scene::Transform::Trs { translation, rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] };
            let mut stage = Stage::new(scene, None, Vec::new());
            let pose = stage.pose(&still(), 0.0);
            (stage.camera(&pose, 1.5), stage.reach())
        };
        let ((near, reach), (far, far_reach)) = (seen(0.0), seen(524_288.0));
        for (far, near) in [(far.eye, near.eye), (far.target, near.target)] {
            let back = DVec3::from(far) - DVec3::new(524_288.0, 0.0, -524_288.0);
            assert!(back.distance(near.into()) < 1e-6, "{back}, not {near:?}");
        }
        assert!((reach - far_reach).abs() < 1e-6 && reach > 0.0);
    }

    #[test]
    fn only_what_is_chosen_moves() {
        let mut stage = cornell();
        let rest = stage.pose(&still(), 0.5);
        let by_hand = stage.pose(&Motion { lamp: [0.1, 0.0, 0.0], object: [0.0, 0.0, 0.2], ..still() }, 0.5);
        let (lamp, block) = (node(&stage, "lamp"), node(&stage, "tall block"));
        assert!((by_hand.world[lamp][3][0] - rest.world[lamp][3][0] - 0.1).abs() < 1e-6);
        assert!((by_hand.world[block][3][2] - rest.world[block][3][2] - 0.2).abs() < 1e-6);
        let short = node(&stage, "short block");
        assert_eq!(by_hand.world[short], rest.world[short]);
        let played = stage.pose(&Motion { playing: vec!["move-object".into()], ..still() }, 0.5);
        assert_ne!(played.world[block], rest.world[block]);
        assert_eq!(played.world[lamp], rest.world[lamp]);
    }

    #[test]
    fn the_shining_scene_has_an_animation_of_what_mirrors_show() {
        let mut stage = Stage::open("gloss").unwrap();
        assert!(stage.animations().any(|name| name == "move-reflected") && stage.object_name.is_some());
        let rest = stage.pose(&still(), 0.5);
        let played = stage.pose(&Motion { playing: vec!["move-reflected".into()], ..still() }, 0.5);
        assert_ne!(played.world, rest.world);
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = Stage::open("no/such/room.glb").err().unwrap();
        assert!(error.contains("room.glb"), "{error}");
        let error = Stage::open("nonsense").err().unwrap();
        assert!(error.contains("nonsense"), "{error}");
    }
}
