//! A scene looks the same wherever it stands, because its coordinates count from a centre of its own.

use crate::common::scenes::{before_corner, corner, emitter, lambert, quad, scene, shine};
use crate::common::stage::Stage;
use crate::common::statistics::{Rgb, mean};
use asvgf::scene::{
    Animation, Channel, Environment, Interpolation, LightKind, Node, Perspective, Scene, Target, Transform,
};
use asvgf::{Camera, Settings, TracerSettings, View};

const SIZE: [u32; 2] = [48, 36];

/// Offsets, in whole multiples of the scene's size.
const PLACES: [[f64; 3]; 6] = [
    [8192.0, 0.0, -8192.0],
    [-8192.0, 0.0, 0.0],
    [32_768.0, -32_768.0, 0.0],
    [0.0, 0.0, 524_288.0],
    [524_288.0, 0.0, -524_288.0],
    [-524_288.0, 524_288.0, 0.0],
];

/// The way in which a scene gets to its place.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Placed {
    /// Its vertices are there.
    Vertices,
    /// Nodes that never move put it there.
    Nodes,
    /// Nodes that a host may move put it there.
    Movable,
    /// The vertices of meshes that a host may move are there.
    MovableVertices,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Light {
    Sky,
    Point,
    Emitter,
}

fn moved(by: [f64; 3]) -> Transform {
    Transform::Trs { translation: by.map(|x| x as f32), rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] }
}

/// A corner with a slab that floats a millimetre above its floor, and a light.
fn lit_corner(place: [f64; 3], placed: Placed, light: Light) -> Scene {
    let in_vertices = matches!(placed, Placed::Vertices | Placed::MovableVertices);
    let [x, y, z] = if in_vertices { place.map(|x| x as f32) } else { [0.0; 3] };
    let mut meshes = corner([x, y, z]);
    let mut materials = vec![lambert([0.6, 0.5, 0.4])];
    if light == Light::Emitter {
        materials.push(emitter([4.0; 3]));
        meshes.push(quad([x - 0.25, y + 1.5, z + 0.25], [0.5, 0.0, 0.0], [0.0, 0.0, 0.5], 1));
    }
    let mut scene = scene(materials, meshes);
    if light == Light::Point {
        shine(&mut scene, LightKind::Point, [2.0; 3], f32::INFINITY, [x + 0.5, y + 1.5, z + 0.75]);
    }
    if light == Light::Sky {
        scene.environment = Some(Environment::uniform([1.0, 0.9, 0.8]));
    }
    for node in &mut scene.nodes {
        node.movable = matches!(placed, Placed::Movable | Placed::MovableVertices);
        if !in_vertices && let Transform::Trs { translation, .. } = &mut node.transform {
            *translation = [0, 1, 2].map(|i| translation[i] + place[i] as f32);
        }
    }
    scene
}

fn settings() -> Settings {
    let tracer = TracerSettings { samples: 4, ..Default::default() };
    Settings { tracer, ..Settings::adaptive() }
}

/// The images of some frames, seen from the corner's place.
fn images(scene: Scene, place: [f64; 3]) -> Vec<Vec<Rgb>> {
    let mut stage = Stage::new(scene, SIZE, settings());
    (0..3)
        .map(|frame| {
            let mut camera = before_corner(place);
            camera.eye[0] += 1e-3 * f64::from(frame);
            stage.camera = Some(camera);
            stage.frame().image()
        })
        .collect()
}

/// Pixels that differ by more than a thousandth of the image's mean, and the difference of the means, relative.
fn compare(far: &[Rgb], near: &[Rgb]) -> (usize, f64) {
    let level = mean(near);
    assert!(level > 0.01, "the corner is lit");
    let differs = |(a, b): (&Rgb, &Rgb)| (0..3).any(|c| f64::from((a[c] - b[c]).abs()) > 1e-3 * level);
    (far.iter().zip(near).filter(|&(a, b)| differs((a, b))).count(), (mean(far) / level - 1.0).abs())
}

#[test]
fn a_corner_looks_the_same_wherever_it_stands() {
    for light in [Light::Sky, Light::Point, Light::Emitter] {
        for placed in [Placed::Vertices, Placed::Nodes, Placed::Movable, Placed::MovableVertices] {
            let near = images(lit_corner([0.0; 3], placed, light), [0.0; 3]);
            for place in PLACES {
                let far = images(lit_corner(place, placed, light), place);
                for (frame, (far, near)) in far.iter().zip(&near).enumerate() {
                    let (pixels, mean) = compare(far, near);
                    let what = format!("{light:?}, {placed:?}, {place:?}, frame {frame}");
                    // A shifted eye is rounded in f64, so a ray in some thousand meets another side of an edge.
                    assert!(pixels <= 2 && mean < 1e-4, "{what}: {pixels} pixels, {mean:.1e}");
                    assert!(frame > 0 || far == near, "{what}: the numbers are the same, and so is the image");
                }
            }
        }
    }
}

/// A corner, a block that moves and a camera that moves, all below one parent.
fn animated(place: [f64; 3]) -> Scene {
    let mut scene = lit_corner([0.0; 3], Placed::Nodes, Light::Sky);
    scene.meshes.push(quad([-0.25, 0.001, 0.75], [0.5, 0.0, 0.0], [0.0, 0.0, -0.5], 0));
    scene.cameras.push(Perspective { fov_y: 0.7 });
    let below = |node: Node| Node { parent: Some(0), ..node };
    let mut nodes = vec![Node { transform: moved(place), ..Default::default() }];
    nodes.extend(scene.nodes.iter().cloned().map(below));
    nodes.push(below(Node { meshes: vec![2], ..Default::default() }));
    nodes.push(below(Node { camera: Some(0), transform: moved([0.0, 0.5, 2.0]), ..Default::default() }));
    let channel = |node: usize, values: [[f32; 4]; 2]| Channel {
        target: Target::Translation(node),
        interpolation: Interpolation::Linear,
        times: vec![0.0, 1.0],
        values: values.into(),
    };
    let channels = vec![
        channel(nodes.len() - 2, [[0.0, 0.0, 0.0, 0.0], [0.05, 0.02, 0.0, 0.0]]),
        channel(nodes.len() - 1, [[0.0, 0.5, 2.0, 0.0], [0.03, 0.52, 2.0, 0.0]]),
    ];
    Scene { nodes, animations: vec![Animation { name: "move".into(), channels }], ..scene }
}

#[test]
fn what_moves_far_away_moves_as_near() {
    let stage = |place| Stage::new(animated(place), SIZE, settings());
    let mut near = stage([0.0; 3]);
    let mut far = PLACES.map(stage);
    for frame in 0..8 {
        let image = near.frame().image();
        let [motion, length] = [View::Motion, View::HistoryLength].map(|view| near.view(view));
        assert!(frame == 0 || motion.iter().any(|m| m[0] != 0.0), "the camera moves");
        for (stage, place) in far.iter_mut().zip(PLACES) {
            let what = format!("{place:?}, frame {frame}");
            let (pixels, mean) = compare(&stage.frame().image(), &image);
            assert!(pixels <= 8 && mean < 2e-4, "{what}: {pixels} pixels, {mean:.1e}");
            let far = [View::Motion, View::HistoryLength].map(|view| stage.view(view));
            // The images agree, except for rays that meet another side of an edge.
            let differ = |a: &[Rgb], b: &[Rgb], by: f32| {
                a.iter().zip(b).filter(|(a, b)| (0..2).any(|c| (a[c] - b[c]).abs() > by)).count()
            };
            let (motions, lengths) = (differ(&far[0], &motion, 2e-3), differ(&far[1], &length, 1e-3));
            assert!(motions <= 4 && lengths <= 8, "{what}: {motions} motions, {lengths} histories");
        }
    }
}

/// A camera in f32 gives the image of exactly that camera.
#[test]
fn a_camera_in_f32_is_taken_for_what_it_says() {
    let place = [524_288.0, 0.0, -524_288.0];
    let eye = [524_288.03_f32, 0.71, -524_286.03].map(f64::from);
    let camera = |eye: [f64; 3], place: [f64; 3]| Camera { eye, ..before_corner(place) };
    let view = |place: [f64; 3], eye: [f64; 3]| {
        let mut stage = Stage::new(lit_corner(place, Placed::Nodes, Light::Sky), SIZE, settings());
        stage.camera = Some(camera(eye, place));
        stage.frame().image()
    };
    let near = view([0.0; 3], std::array::from_fn(|i| eye[i] - place[i]));
    assert!(view(place, eye) == near);
}
