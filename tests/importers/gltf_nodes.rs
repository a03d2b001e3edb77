//! Scenes, nodes, lights and cameras of glTF files.

use asvgf::scene::{LightKind, Transform};
use serde_json::{Value, json};

use crate::common::*;

fn with_nodes(nodes: Value, scenes: Value) -> Gltf {
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"] = nodes;
    gltf.json["scenes"] = scenes;
    gltf
}

#[test]
fn transforms_of_all_kinds_nest_and_share_meshes() {
    let gltf = with_nodes(
        json!([
            {"mesh": 0, "matrix": [2, 0, 0, 0, 1, 2, 0, 0, 0, 0, 2, 0, 5, 0, 0, 1], "children": [2, 1], "name": "sheared"},
            {"mesh": 0, "scale": [-1, 1, 1]},
            {"rotation": [0, 0, std::f32::consts::FRAC_1_SQRT_2, std::f32::consts::FRAC_1_SQRT_2], "children": [3]},
            {"mesh": 0, "translation": [1, 2, 3]},
        ]),
        json!([{"nodes": [0]}]),
    );
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[]);
    let scene = &loaded.scene;
    assert_eq!(scene.meshes.len(), 1);
    assert_eq!(scene.triangle_count(), 3);
    assert_eq!(scene.nodes.iter().map(|node| node.parent).collect::<Vec<_>>(), [None, Some(0), Some(1), Some(0)]);
    assert!(matches!(scene.nodes[0].transform, Transform::Matrix(_)));
    // The shear has determinant 4 in the plane of the triangle.
    assert!((area(&loaded) - 6.0).abs() < 1e-6);
    // (0, 0, 0) is moved by (1, 2, 3), turned to (-2, 1, 3), and sheared.
    let pose = scene.pose(None, 0.0);
    assert_close(&pose.world[2][3], &[5.0 - 4.0 + 1.0, 2.0, 6.0, 1.0], 1e-5);
}

#[test]
fn only_the_default_scene_is_read() {
    let nodes = json!([{"mesh": 0}, {"mesh": 0, "translation": [0, 9, 0]}, {"mesh": 77, "name": "orphan"}]);
    let mut gltf = with_nodes(nodes, json!([{"nodes": [0]}, {"nodes": [1]}]));
    gltf.json["scene"] = json!(1);
    assert_eq!(bounds(&gltf.load().unwrap())[0], [0.0, 9.0, 0.0]);
    gltf.json.as_object_mut().unwrap().remove("scene");
    assert_eq!(bounds(&gltf.load().unwrap())[0], [0.0, 0.0, 0.0]);
}

#[test]
fn without_scenes_all_nodes_are_drawn() {
    let mut gltf = with_nodes(json!([{"children": [1]}, {"mesh": 0}, {"mesh": 0}]), json!([]));
    gltf.json.as_object_mut().unwrap().remove("scene");
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[("scenes", "no scene")]);
    assert_eq!(loaded.scene.triangle_count(), 2);
}

#[test]
fn a_scene_may_list_nodes_that_are_not_roots() {
    let nodes = json!([
        {"children": [1], "translation": [100, 0, 0]}, {"mesh": 0, "children": [2]}, {"mesh": 0, "translation": [0, 0, 4]},
    ]);
    // The parent is not in the scene.
    let loaded = with_nodes(nodes.clone(), json!([{"nodes": [1]}])).load().unwrap();
    assert_eq!(bounds(&loaded), [[0.0, 0.0, 0.0], [1.0, 1.0, 4.0]]);
    // The parent is in the scene as well, and one of the nodes is there twice.
    let loaded = with_nodes(nodes, json!([{"nodes": [2, 1, 0, 0]}])).load().unwrap();
    assert_eq!(loaded.scene.triangle_count(), 2);
    assert_eq!(bounds(&loaded)[0], [100.0, 0.0, 0.0]);
}

#[test]
fn a_chain_of_many_nodes() {
    let count = 20_000;
    let mut nodes: Vec<Value> =
        (1..count).map(|child| json!({"translation": [0, 0, 1], "children": [child]})).collect();
    nodes.push(json!({"mesh": 0}));
    let loaded = with_nodes(json!(nodes), json!([{"nodes": [0]}])).load().unwrap();
    assert_eq!(bounds(&loaded)[0][2], (count - 1) as f32);
}

#[test]
fn lights_of_all_kinds() {
    let mut gltf = Gltf::triangle();
    gltf.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    gltf.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "intensity": 50, "color": [1, 0.5, 0.25], "range": 3},
        {"type": "spot", "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}},
        {"type": "directional"},
        {"type": "spot", "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.5}, "range": -1},
    ]}});
    gltf.json["nodes"][0]["extensions"] = json!({"KHR_lights_punctual": {"light": 1}});
    let loaded = gltf.load().unwrap();
    assert_warnings(
        &loaded,
        &[("lights[0]", "photometric"), ("lights[3].spot", "0.5"), ("lights[3].range", "not above 0")],
    );
    let scene = &loaded.scene;
    assert_eq!((scene.lights[0].kind, scene.lights[0].range), (LightKind::Point, 3.0));
    assert_eq!(scene.lights[0].intensity, [50.0, 25.0, 12.5]);
    assert_eq!(scene.lights[1].kind, LightKind::Spot { inner: 0.25, outer: 0.5 });
    assert_eq!((scene.lights[2].kind, scene.lights[2].range), (LightKind::Directional, f32::INFINITY));
    assert_eq!(scene.lights[2].intensity, [1.0; 3]);
    assert_eq!(scene.nodes[0].light, Some(1));
}

#[test]
fn cameras_look_along_their_node() {
    let mut gltf = with_nodes(
        json!([{"mesh": 0}, {"camera": 0}, {"camera": 1, "translation": [0, 0, 5]}, {"camera": 2}]),
        json!([{"nodes": [0, 1, 2, 3]}]),
    );
    gltf.json["cameras"] = json!([
        {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "zfar": 9, "znear": 1}},
        {"type": "perspective", "perspective": {"yfov": 0.75, "znear": 0.1}},
        {"type": "perspective", "perspective": {"yfov": 4, "znear": 0.1}},
    ]);
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[("cameras[0]", "orthographic"), ("cameras[2]", "yfov 4")]);
    let scene = &loaded.scene;
    assert_eq!(scene.camera_node(), Some(2));
    let view = scene.camera_view(&scene.pose(None, 0.0), 2).unwrap();
    assert_eq!((view.eye, view.target, view.up, view.fov_y), ([0.0, 0.0, 5.0], [0.0, 0.0, 4.0], [0.0, 1.0, 0.0], 0.75));
    assert_eq!(scene.camera_view(&scene.pose(None, 0.0), 1), None);
    assert_eq!(scene.camera_view(&scene.pose(None, 0.0), 99), None);
}

#[test]
fn hidden_nodes_are_not_drawn() {
    let hidden = |visible: Value, warnings: &[(&str, &str)]| {
        let mut gltf = with_nodes(
            json!([
                {"mesh": 0, "children": [1], "extensions": {"KHR_node_visibility": {"visible": visible}}},
                {"children": [2], "extensions": {"KHR_node_visibility": {"visible": true}}},
                {"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}},
                {"mesh": 0, "extensions": {"KHR_node_visibility": {}}},
            ]),
            json!([{"nodes": [0, 3]}]),
        );
        gltf.json["extensionsUsed"] = json!(["KHR_node_visibility", "KHR_lights_punctual"]);
        gltf.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 1}]}});
        let loaded = gltf.load().unwrap();
        let units = ("KHR_lights_punctual.lights[0]", "photometric units");
        assert_warnings(&loaded, &[&[units], warnings].concat());
        (loaded.scene.triangle_count(), loaded.scene.nodes.iter().filter(|node| node.light.is_some()).count())
    };
    assert_eq!(hidden(json!(true), &[]), (3, 1));
    assert_eq!(hidden(json!(false), &[]), (1, 0), "and all below is hidden, too");
    let broken = [("nodes[0].KHR_node_visibility.visible", "0 is neither true nor false; the node is drawn")];
    assert_eq!(hidden(json!(0), &broken), (3, 1));
}
