//! Skins and morph targets: shapes, motion and images, against a twin in f64 and against nodes that move.

use crate::common::plane::{Pinhole, V, add, length, scale, sub};
use crate::common::scenes::{emitter, lambert, quad};
use crate::common::stage::Stage;
use crate::common::statistics::{Rgb, luminance, mean};
use crate::common::walker::{LEGS, camera, nearest, positions_in_f64, walker};
use asvgf::plan::Feature;
use asvgf::scene::{Environment, IDENTITY, Influence, Node, Pose, Scene, Skin, Transform};
use asvgf::{FilterSettings, Gradient, Mode, Settings, View};

const SIZE: [u32; 2] = [48, 32];

/// Legs of many triangles, which have a tree, and of so few that each is tested on a CPU.
const LEGS_OF: [[u32; 2]; 2] = [[12, 10], [4, 3]];

fn lit(scene: Scene) -> Scene {
    Scene { environment: Some(Environment::uniform([1.0; 3])), ..scene }
}

fn stage(scene: Scene, settings: Settings) -> Stage {
    let mut stage = Stage::new(lit(scene), SIZE, settings);
    stage.camera = Some(camera());
    stage
}

/// World-space triangles of all meshes in f64.
fn triangles(scene: &Scene, pose: &Pose) -> Vec<[V; 3]> {
    let of_mesh = |(node, mesh): (usize, usize)| {
        let positions = positions_in_f64(scene, pose, node, mesh);
        scene.meshes[mesh].triangles.iter().map(move |t| t.map(|v| positions[v as usize])).collect::<Vec<_>>()
    };
    let drawn = scene.nodes.iter().enumerate().flat_map(|(node, n)| n.meshes.iter().map(move |&mesh| (node, mesh)));
    drawn.flat_map(of_mesh).collect()
}

#[test]
fn shapes_are_those_of_the_twin() {
    let scene = walker(12, 10);
    let rest = scene.shape(&scene.pose(None, 0.0), LEGS, 0).unwrap();
    for time in [0.0, 0.13, 0.4, 0.77] {
        let pose = scene.pose(Some(0), time);
        let shape = scene.shape(&pose, LEGS, 0).unwrap();
        let twin = positions_in_f64(&scene, &pose, LEGS, 0);
        for (position, expected) in shape.positions.iter().zip(&twin) {
            assert!(length(sub(*position, *expected)) < 1e-12, "{position:?}, not {expected:?}");
        }
        assert!(shape.normals.iter().all(|n| (length(n.map(f64::from)) - 1.0).abs() < 1e-6));
        assert!(shape.positions.iter().zip(&rest.positions).any(|(a, b)| length(sub(*a, *b)) > 0.1));
    }
}

#[test]
fn motion_is_that_of_the_same_point_of_the_skin() {
    for [rings, sides] in LEGS_OF {
        let mut stage = stage(walker(rings, sides), Settings::adaptive());
        let (mut worst, mut on_legs) = (0.0_f64, 0);
        for frame in 8..12 {
            stage.index = frame;
            stage.frame();
            if frame == 8 {
                continue;
            }
            let [before, now] = [frame - 1, frame].map(|f| triangles(&stage.scene, &stage.pose_at(f)));
            let pinhole = Pinhole::new(&camera(), SIZE);
            let (motion, depth) = (stage.view(View::Motion), stage.view(View::Depth));
            for (i, (m, d)) in motion.iter().zip(&depth).enumerate() {
                let [x, y] = [i as u32 % SIZE[0], i as u32 / SIZE[0]].map(|place| f64::from(place) + 0.5);
                let Some((triangle, distance, weights)) = nearest(pinhole.eye, pinhole.ray(x, y), &now) else {
                    continue;
                };
                // Rounding decides between two triangles at a common edge.
                if weights.iter().any(|w| *w < 1e-4) {
                    continue;
                }
                let at =
                    |t: &[V; 3]| add(scale(t[0], weights[0]), add(scale(t[1], weights[1]), scale(t[2], weights[2])));
                let was = pinhole.project(at(&before[triangle]));
                let expected = [was[0] - x, was[1] - y, was[2]];
                // Motion is stored in steps of 1/256 pixel and depth in steps of 2⁻¹⁴ of itself, and vertices are rounded to f32.
                let rounding = [1.0 / 512.0, 1.0 / 512.0, expected[2] * 2.0_f64.powi(-15)];
                for ((actual, expected), rounding) in m.iter().map(|&a| f64::from(a)).zip(expected).zip(rounding) {
                    let error = (actual - expected).abs();
                    worst = worst.max(error);
                    assert!(error < rounding + 2e-4, "frame {frame}, ({x}, {y}): {m:?}, not {expected:?}");
                }
                assert!((f64::from(d[0]) - distance).abs() < 1e-5 * distance, "depth {d:?}, not {distance}");
                on_legs +=
                    u32::from(triangle < stage.scene.meshes[0].triangles.len() && expected[0].hypot(expected[1]) > 0.1);
            }
        }
        println!("{rings} × {sides}: largest error of a motion {worst:.1e}, {on_legs} pixels of the legs that move");
        assert!(on_legs > 200, "{on_legs}");
    }
}

/// A paused walk has motion and gradients of exactly 0, and poses in between leave no trace.
#[test]
fn a_paused_walk_stands_still() {
    for ([rings, sides], gradient) in LEGS_OF.into_iter().zip([Gradient::Reshade, Gradient::BlinnPhong]) {
        let filter = FilterSettings { gradient, ..Default::default() };
        let settings = Settings { filter, ..Settings::adaptive() };
        let [mut left, mut shaken] = [0; 2].map(|_| stage(walker(rings, sides), settings.clone()));
        left.frames(4);
        shaken.frames(4);
        let (pose, other) = (left.pose_at(3), left.pose_at(17));
        for frame in 0..4 {
            let gpu = shaken.gpu;
            gpu.submit(|encoder| {
                for pose in [&other, &pose] {
                    shaken.uploaded.update(&gpu.device, encoder, pose).unwrap();
                }
            });
            assert!(left.frame_in(&pose).image() == shaken.frame_in(&pose).image(), "frame {frame}");
            assert!(left.view(View::Motion).iter().all(|m| m[0] == 0.0 && m[1] == 0.0), "frame {frame}");
            assert_eq!(left.largest(View::Lambda), 0.0, "frame {frame}");
        }
        let features = left.denoiser.plan().unwrap().features;
        assert!(features.has(Feature::Still) && features.has(Feature::Deforming));
    }
}

/// A card with this material on a node, or on a skin with one joint that is the same node.
fn card(skinned: bool, glows: bool) -> Scene {
    // Its front faces the wall behind it.
    let mut card = quad([0.4, -0.3, 0.0], [-0.8, 0.0, 0.0], [0.0, 0.6, 0.0], 0);
    card.normals = vec![[0.0, 0.0, -1.0]; 4];
    let wall = quad([-4.0, -4.0, -1.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0], 1);
    let node = Node { movable: true, ..Default::default() };
    let still = Node { meshes: vec![1], ..Default::default() };
    let mut scene = Scene {
        materials: vec![if glows { emitter([3.0; 3]) } else { lambert([0.8; 3]) }, lambert([0.5; 3])],
        nodes: vec![node, still],
        ..Default::default()
    };
    if skinned {
        card.influences = vec![Influence { joint: 0, weight: 0.7 }; 4];
        scene.skins.push(Skin { joints: vec![0], inverse_bind: vec![IDENTITY] });
        scene.nodes.push(Node { meshes: vec![0], skin: Some(0), ..Default::default() });
    } else {
        scene.nodes[0].meshes = vec![0];
        // The same number of nodes, so that the same pose suits both.
        scene.nodes.push(Node::default());
    }
    scene.meshes = vec![card, wall];
    if glows { scene } else { lit(scene) }
}

fn turned(frame: u32) -> Transform {
    let t = frame as f32;
    let half = 0.1 * t;
    Transform::Trs {
        translation: [0.05 * t, -0.02 * t, 0.1],
        rotation: [0.0, half.sin(), 0.0, half.cos()],
        scale: [1.0, 1.2, 1.0],
    }
}

fn before_card(skinned: bool, glows: bool, settings: Settings) -> Stage {
    let mut stage = Stage::new(card(skinned, glows), SIZE, settings);
    stage.camera = Some(asvgf::Camera { eye: [0.0, 0.0, 2.5], target: [0.0; 3], ..Default::default() });
    stage
}

/// Renders a frame of a card after its turn.
fn turn(stage: &mut Stage, frame: u32) {
    let mut moved = stage.scene.clone();
    moved.nodes[0].transform = turned(frame);
    stage.frame_in(&moved.pose(None, 0.0));
}

/// Largest difference over the pixels, but for a part of them where rounding decides between two surfaces.
fn farthest(a: &[Rgb], b: &[Rgb]) -> f32 {
    let mut apart: Vec<f32> = a
        .iter()
        .zip(b)
        .map(|(a, b)| (0..3).map(|i| (a[i] - b[i]).abs() / (1.0 + b[i].abs())).fold(0.0, f32::max))
        .collect();
    apart.sort_by(f32::total_cmp);
    apart[apart.len() * 98 / 100]
}

#[test]
fn a_skin_with_one_joint_is_a_node_that_moves() {
    for (glows, gradient) in [(false, Gradient::Reshade), (true, Gradient::BlinnPhong)] {
        let filter = FilterSettings { gradient, ..Default::default() };
        let settings = Settings { filter, ..Settings::adaptive() };
        let [mut node, mut skin] = [false, true].map(|skinned| before_card(skinned, glows, settings.clone()));
        for frame in 0..6 {
            turn(&mut node, frame);
            turn(&mut skin, frame);
            let mut views = vec![View::Motion, View::Depth, View::Normal, View::Object, View::Lambda];
            // The triangles of a lamp are in another order, so that samples differ.
            views.extend((!glows).then_some([View::Noisy, View::Denoised]).into_iter().flatten());
            for view in views {
                let apart = farthest(&skin.view(view), &node.view(view));
                assert!(apart < 1e-3, "glows: {glows}, {gradient:?}, frame {frame}, {view:?}: {apart}");
            }
        }
        assert!(skin.denoiser.plan().unwrap().features.has(Feature::Deforming));
        assert!(!node.denoiser.plan().unwrap().features.has(Feature::Deforming));
    }
}

#[test]
fn a_skin_that_glows_lights_as_much_as_a_node_that_does() {
    let [node, skin] = [false, true].map(|skinned| {
        let mut stage = before_card(skinned, true, Settings { mode: Mode::Reference, ..Settings::adaptive() });
        for _ in 0..256 {
            turn(&mut stage, 5);
        }
        mean(&stage.image())
    });
    println!("{node:.4}, {skin:.4}");
    assert!(node > 0.02 && (skin / node - 1.0).abs() < 0.01, "{skin}, not {node}");
}

/// Luminances of pixels.
fn luminances(image: &[Rgb], pixels: &[usize]) -> Vec<f64> {
    pixels.iter().map(|&i| luminance(image[i])).collect()
}

/// Root of the mean squared difference.
fn rms(a: &[f64], b: &[f64]) -> f64 {
    (a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

/// Pixels that legs have uncovered have the error of pixels that are as new because nothing was drawn before.
#[test]
fn a_walk_leaves_no_trail() {
    const FRAMES: u32 = 3;
    const LAST: u32 = 20;
    let size = [96, 64];
    let make = |settings: Settings| {
        let mut stage = Stage::new(lit(walker(12, 10)), size, settings);
        stage.camera = Some(camera());
        stage
    };
    let mut seen = make(Settings::adaptive());
    let [before, now] = [LAST - FRAMES, LAST].map(|frame| {
        let pose = seen.pose_at(frame);
        seen.frame_in(&pose).view(View::Object)
    });
    let legs = now.iter().map(|o| o[0]).fold(0.0, f32::max);
    let uncovered: Vec<usize> = (0..now.len()).filter(|&i| before[i][0] == legs && now[i][0] != legs).collect();
    assert!(uncovered.len() > 100, "{}", uncovered.len());

    let mut truth = make(Settings { mode: Mode::Reference, ..Settings::adaptive() });
    let pose = truth.pose_at(LAST);
    (0..256).for_each(|_| {
        truth.frame_in(&pose);
    });
    let truth = luminances(&truth.image(), &uncovered);
    let runs = 8;
    // Legs that walk, legs that stand and were never seen before these frames, and legs that always stood there.
    let errors = [(0, true), (LAST + 1 - FRAMES, false), (0, false)].map(|(first, walk)| {
        let squares = (0..runs).map(|run| {
            let mut stage = make(Settings::adaptive());
            stage.index = 1000 * run + first;
            for frame in first..=LAST {
                let pose = stage.pose_at(if walk { frame } else { LAST });
                stage.frame_in(&pose);
            }
            rms(&luminances(&stage.image(), &uncovered), &truth).powi(2)
        });
        (squares.sum::<f64>() / f64::from(runs)).sqrt()
    });
    let [walking, standing, settled] = errors;
    println!("walking {walking:.4}, standing for {FRAMES} frames {standing:.4}, for {} {settled:.4}", LAST + 1);
    assert!(walking < 1.2 * standing, "{walking} where {standing} is due to short histories");
}
