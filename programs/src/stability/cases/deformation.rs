//! Skins and morph targets, at their limits.

use super::furnace::{Furnace, ROUNDING, grey};
use super::geometry::ball;
use super::{Breaks, Case, Named, Worst, difference, unusable};
use crate::stability::common::scenes::emitter;
use crate::stability::common::stage::Stage;
use crate::stability::common::statistics::Rgb;
use crate::stability::common::walker::{LEGS, camera, walker};
use asvgf::scene::{
    Animation, Channel, Environment, Influence, Mesh, MorphTarget, Node, Scene, Skin, Target, Transform,
};
use asvgf::{Camera, FilterSettings, Gradient, Mode, Settings, View};

const SIZE: [u32; 2] = [32, 24];

const VARIED: &str = "legs of five joints, many triangles and few, lit and glowing: joints with weights of 0, singular joints and inverse bind \
    matrices, scales of 10⁻²⁰ and 10²⁰, morph weights of ±10⁶ and ±3·10³⁸; in one frame of four";

pub const CASES: &[Case] = &[
    Case {
        name: "skins and morph targets at their limits",
        varied: VARIED,
        quantity: "pixels of the image or the history that are not finite and ≥ 0, in that frame or later",
        bound: 0.0,
        origin: "shapes are computed in f64 and end at ±10⁹ m, so that the fourth power of an edge is a number of f32",
        measure: limits,
        breaks: Breaks::Never("numbers of a scene and of a pose are finite, or refused by name"),
    },
    Case {
        name: "a walk after such a shape",
        varied: VARIED,
        quantity: "largest difference of an unfiltered image from that of legs that were never so",
        bound: 0.0,
        origin: "a shape follows from its pose alone",
        measure: afterwards,
        breaks: Breaks::Known("another tree may find another of two triangles that a ray meets at the same distance"),
    },
    Case {
        name: "balls that change their shape",
        varied: "a ball of 720 triangles that a morph target or a joint stretches to 0.2 … 3 times its size along an axis, and turns inside out",
        quantity: "largest difference of a pixel from ½ (surface) or 1 (sky); infinite if no surface is seen",
        bound: ROUNDING,
        origin: "a convex surface of albedo ½ under a white sky reflects ½ in every shape",
        measure: balls,
        breaks: Breaks::Never("a linear map of a convex surface is convex"),
    },
];

/// A change of the legs for a frame.
type Limit = Named<fn(&mut Scene)>;

/// Replaces the scale of a node.
fn rescale(scene: &mut Scene, node: usize, to: [f32; 3]) {
    if let Transform::Trs { scale, .. } = &mut scene.nodes[node].transform {
        *scale = to;
    }
}

fn weigh(scene: &mut Scene, weight: f32) {
    scene.nodes[LEGS].weights = vec![weight];
}

/// Changes of the pose: the same scene is drawn.
const POSES: [Limit; 11] = [
    ("a shin flattened", |s| rescale(s, 2, [1.0, 0.0, 1.0])),
    ("a shin that is a line", |s| rescale(s, 2, [0.0, 1.0, 0.0])),
    ("a thigh that is a point", |s| rescale(s, 1, [0.0; 3])),
    ("legs that are a point", |s| rescale(s, 0, [0.0; 3])),
    ("a mirrored shin", |s| rescale(s, 4, [-1.0, 1.0, 1.0])),
    ("a scale of 10⁻²⁰", |s| rescale(s, 0, [1e-20; 3])),
    ("a scale of 10²⁰", |s| rescale(s, 3, [1e20; 3])),
    ("a weight of 10⁶", |s| weigh(s, 1e6)),
    ("a weight of −10⁶", |s| weigh(s, -1e6)),
    ("a weight of 3·10³⁸", |s| weigh(s, 3e38)),
    ("a weight of −3·10³⁸", |s| weigh(s, -3e38)),
];

/// Changes of the skin: another scene is drawn.
const SKINS: [Limit; 4] = [
    ("weights of 0", |s| s.meshes[0].influences.iter_mut().for_each(|i| i.weight = 0.0)),
    ("weights that cancel", |s| {
        s.meshes[0]
            .influences
            .iter_mut()
            .zip([1.0, -1.0, 0.0].into_iter().cycle())
            .for_each(|(i, weight)| i.weight = weight);
    }),
    ("singular inverse bind matrices", |s| {
        s.skins[0].inverse_bind[1] = [[0.0; 4], [0.0; 4], [0.0; 4], [0.0, 0.0, 0.0, 1.0]]
    }),
    ("inverse bind matrices of 10³⁰", |s| s.skins[0].inverse_bind[1][0][0] = 1e30),
];

/// Legs that glow or are lit, of many triangles or few.
fn legs(glow: bool, few: bool) -> Scene {
    let mut scene = if few { walker(4, 3) } else { walker(12, 10) };
    // The host moves them.
    scene.animations.clear();
    scene.nodes.iter_mut().for_each(|node| node.movable = true);
    match glow {
        true => scene.materials[0] = emitter([2.0; 3]),
        false => scene.environment = Some(Environment::uniform([1.0; 3])),
    }
    scene
}

fn stage(scene: Scene, mode: Mode, gradient: Gradient) -> Stage {
    let filter = FilterSettings { gradient, ..Default::default() };
    let mut stage = Stage::new(scene, SIZE, Settings { mode, filter, ..Settings::adaptive() });
    stage.camera = Some(camera());
    stage
}

/// Renders a frame in a pose that a change of the scene makes.
fn frame(stage: &mut Stage, change: fn(&mut Scene)) -> Vec<Rgb> {
    let mut changed = stage.scene.clone();
    change(&mut changed);
    stage.frame_in(&changed.pose(None, 0.0)).image()
}

const KINDS: [(bool, bool, Gradient); 3] =
    [(false, false, Gradient::Reshade), (true, true, Gradient::Reshade), (true, false, Gradient::BlinnPhong)];

fn limits() -> Worst {
    let mut worst = Worst::default();
    for (glow, few, gradient) in KINDS {
        let mut count = |stage: &mut Stage, name: &str, change: fn(&mut Scene)| {
            let mut broken = 0;
            for step in 0..4 {
                broken += unusable(&frame(stage, if step == 1 { change } else { |_| () }));
                broken += unusable(&stage.view(View::Variance));
            }
            worst.add(broken as f64, || format!("{name}, glow {glow}, few {few}"));
        };
        let mut posed = stage(legs(glow, few), Mode::Denoise, gradient);
        for (name, change) in POSES {
            count(&mut posed, name, change);
        }
        for (name, change) in SKINS {
            let mut scene = legs(glow, few);
            change(&mut scene);
            count(&mut stage(scene, Mode::Denoise, gradient), name, |_| ());
        }
    }
    worst
}

fn afterwards() -> Worst {
    let mut worst = Worst::default();
    for (glow, few, gradient) in KINDS {
        let [mut plain, mut driven] = [0; 2].map(|_| stage(legs(glow, few), Mode::Noisy, gradient));
        for (name, change) in POSES {
            frame(&mut driven, change);
            frame(&mut plain, |_| ());
            let [expected, found] = [&mut plain, &mut driven].map(|stage| frame(stage, |_| ()));
            worst.add(difference(&found, &expected), || format!("{name}, glow {glow}, few {few}"));
        }
    }
    worst
}

/// A scale of 0.2 … 3 over 0.4 seconds, by way of −1 if it turns the ball inside out.
fn stretches(turns_over: bool) -> Vec<f32> {
    if turns_over { vec![1.0, 0.3, -1.0, -0.3, 1.0] } else { vec![1.0, 0.2, 1.0, 3.0, 1.0] }
}

/// A ball that a curve stretches along x.
fn stretched(mesh: Mesh, target: Target, value: impl Fn(f32) -> [f32; 4], turns_over: bool) -> Scene {
    let scales = stretches(turns_over);
    let times = (0..scales.len()).map(|key| key as f32 / 10.0).collect();
    let channel = Channel::new(target, times, scales.into_iter().map(value).collect());
    let mut scene = grey(vec![mesh]);
    scene.animations.push(Animation { name: "stretch".into(), channels: vec![channel] });
    scene
}

fn balls() -> Worst {
    let mut worst = Worst::default();
    let mut furnace = Furnace::new(SIZE);
    let camera = |_| Camera { eye: [0.5, 1.0, 6.0], target: [0.0; 3], ..Default::default() };
    for turns_over in [false, true] {
        let mut morphed = ball(1.0, [0.0; 3]);
        // A weight of 1 adds the size along x once more.
        morphed.targets.push(MorphTarget {
            vertices: (0..morphed.positions.len() as u32).collect(),
            positions: morphed.positions.iter().map(|p| [p[0], 0.0, 0.0]).collect(),
            ..Default::default()
        });
        let target = Target::Weight { node: 0, target: 0 };
        let scene = stretched(morphed, target, |scale| [scale - 1.0, 0.0, 0.0, 0.0], turns_over);
        worst.add(furnace.farthest_seen(scene, 14, camera), || format!("a morph target, inside out: {turns_over}"));

        let mut skinned = ball(1.0, [0.0; 3]);
        skinned.influences = vec![Influence { joint: 0, weight: 1.0 }; skinned.positions.len()];
        let mut scene = stretched(skinned, Target::Scale(1), |scale| [scale, 1.0, 1.0, 0.0], turns_over);
        scene.nodes[0].skin = Some(0);
        scene.nodes.push(Node::default());
        scene.skins.push(Skin { joints: vec![1], inverse_bind: vec![asvgf::scene::IDENTITY] });
        worst.add(furnace.farthest_seen(scene, 14, camera), || format!("a joint, inside out: {turns_over}"));
    }
    worst
}
