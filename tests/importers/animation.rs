//! Animations: from files, and their evaluation.

use std::f32::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

use asvgf::scene::{Animation, Channel, Interpolation, Material, Node, Scene, Target};
use serde_json::json;

use crate::common::*;

/// A scene of one node in which one channel plays.
fn playing(target: Target, interpolation: Interpolation, times: &[f32], values: &[[f32; 4]]) -> Scene {
    let channel = Channel { target, interpolation, times: times.to_vec(), values: values.to_vec() };
    let scene = Scene {
        nodes: vec![Node::default()],
        materials: vec![Material::default()],
        animations: vec![Animation { name: "move".into(), channels: vec![channel] }],
        ..Scene::default()
    };
    scene.validate().unwrap();
    scene
}

fn x_at(scene: &Scene, time: f32) -> f32 {
    scene.pose(Some(0), time).world[0][3][0] as f32
}

#[test]
fn curves_hold_at_the_ends_and_repeat() {
    let values = [[10.0, 0.0, 0.0, 0.0], [20.0, 0.0, 0.0, 0.0], [0.0; 4]];
    let times = [1.0, 2.0, 4.0];
    for (interpolation, expected) in
        [(Interpolation::Linear, [10.0, 15.0, 10.0]), (Interpolation::Step, [10.0, 10.0, 20.0])]
    {
        let scene = playing(Target::Translation(0), interpolation, &times, &values);
        assert_eq!(scene.duration(Some(0)), 4.0);
        for (time, expected) in [0.5, 1.5, 3.0].into_iter().zip(expected) {
            assert_eq!(x_at(&scene, time), expected, "{interpolation:?} at {time}");
            assert_eq!(x_at(&scene, time + 8.0), expected);
            assert_eq!(x_at(&scene, time - 4.0), expected);
        }
        assert_eq!(x_at(&scene, 2.0), 20.0);
    }
}

#[test]
fn rest_pose_without_an_animation() {
    let scene = playing(Target::Translation(0), Interpolation::Step, &[0.0], &[[3.0, 0.0, 0.0, 0.0]]);
    assert_eq!((scene.duration(Some(0)), scene.duration(Some(1)), scene.duration(None)), (0.0, 0.0, 0.0));
    assert_eq!(x_at(&scene, 77.0), 3.0);
    for pose in [scene.pose(None, 1.0), scene.pose(Some(1), 1.0), scene.pose(Some(0), f32::NAN)] {
        assert_eq!(pose.world[0][3][0], 0.0);
        assert_eq!(pose.emission, [[1.0; 3]]);
    }
    assert_eq!((scene.find_animation("move"), scene.find_animation("rest")), (Some(0), None));
}

#[test]
fn rotations_take_the_short_way_at_constant_speed() {
    let quarter = [0.0, 0.0, -FRAC_1_SQRT_2, -FRAC_1_SQRT_2]; // a quarter turn, with the other sign
    let scene = playing(Target::Rotation(0), Interpolation::Linear, &[0.0, 3.0], &[[0.0, 0.0, 0.0, 1.0], quarter]);
    let x_axis = scene.pose(Some(0), 1.0).world[0][0];
    let angle = FRAC_PI_2 / 3.0;
    assert_close(&x_axis, &[angle.cos(), angle.sin(), 0.0, 0.0], 1e-6);
}

#[test]
fn cubic_splines_follow_their_tangents() {
    // The curve is x = t³ on 0…2, with slopes 0 and 12.
    let values = [[9.0; 4], [0.0; 4], [0.0; 4], [12.0, 0.0, 0.0, 0.0], [8.0, 0.0, 0.0, 0.0], [9.0; 4]];
    let scene = playing(Target::Translation(0), Interpolation::CubicSpline, &[0.0, 2.0], &values);
    for time in [0.0, 0.25, 1.0, 1.75_f32] {
        assert_close(&[x_at(&scene, time)], &[time.powi(3)], 1e-5);
    }
}

#[test]
fn factors_do_not_fall_below_zero() {
    let scene = playing(Target::Emission(0), Interpolation::Linear, &[0.0, 4.0], &[[2.0; 4], [-2.0; 4]]);
    assert_eq!(scene.pose(Some(0), 1.0).emission, [[1.0; 3]]);
    assert_eq!(scene.pose(Some(0), 3.0).emission, [[0.0; 3]]);
}

#[test]
fn movement_is_inherited() {
    let mut scene = playing(Target::Scale(0), Interpolation::Step, &[0.0], &[[1.0; 4]]);
    let child = |parent, movable| Node { parent, movable, ..Node::default() };
    scene.nodes.extend([
        child(Some(0), false),
        child(None, false),
        child(None, true),
        child(Some(3), false),
        child(Some(2), false),
    ]);
    assert_eq!(scene.animated_nodes(), [true, true, false, true, true, false]);
}

#[test]
fn animations_from_a_file() {
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"] = json!([
        {"mesh": 0, "children": [1]}, {"name": "turning", "matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 0, 0, 1]}, {"name": "orphan"},
    ]);
    let times = gltf.floats("SCALAR", &[0.0, 1.0]);
    let moved = gltf.floats("VEC3", &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]);
    let turned = gltf.accessor(
        I16,
        "VEC4",
        2,
        &le([0, 0, 0, 32_767, 0, 0, 23_170, 23_170_i16].map(i16::to_le_bytes).into_iter()),
    );
    gltf.json["accessors"][turned]["normalized"] = json!(true);
    let cubic = gltf.floats("VEC3", &[1.0; 18]);
    gltf.json["animations"] = json!([
        {
            "samplers": [
                {"input": times, "output": moved}, {"input": times, "output": turned, "interpolation": "STEP"},
                {"input": times, "output": cubic, "interpolation": "CUBICSPLINE"},
            ],
            "channels": [
                {"sampler": 0, "target": {"node": 0, "path": "translation"}},
                {"sampler": 1, "target": {"node": 1, "path": "rotation"}},
                {"sampler": 2, "target": {"node": 1, "path": "scale"}},
                {"sampler": 2, "target": {"node": 1, "path": "scale"}},
                {"sampler": 0, "target": {"node": 2, "path": "translation"}},
                {"sampler": 0, "target": {"node": 0, "path": "weights"}},
                {"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/x"}}}},
            ],
        },
        {"name": "nothing", "samplers": [], "channels": []},
    ]);
    let loaded = gltf.load().unwrap();
    assert_warnings(
        &loaded,
        &[
            ("channels[6]", "/x is not read"),
            ("nodes[1]", "matrix"),
            ("channels[3]", "same target"),
            ("channels[5]", "morph targets"),
        ],
    );
    let scene = &loaded.scene;
    assert_eq!((scene.animations[0].name.as_str(), scene.animations[1].name.as_str()), ("animation 0", "nothing"));
    assert_eq!(scene.animations[0].channels.len(), 3);
    assert_eq!(scene.animated_nodes(), [true, true]);
    let pose = scene.pose(Some(0), 0.5);
    assert_close(&pose.world[0][3], &[2.0, 0.0, 0.0, 1.0], 1e-6);
    assert_close(&pose.world[1][3], &[3.0, 0.0, 0.0, 1.0], 1e-6);
    assert_close(&scene.animations[0].channels[1].values[1], &[0.0, 0.0, FRAC_1_SQRT_2, FRAC_1_SQRT_2], 1e-4);
}
