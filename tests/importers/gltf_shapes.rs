//! Skins, morph targets, instances and colours of vertices.

use asvgf::scene::Scene;
use serde_json::{Value, json};

use crate::common::*;

/// A square of 2 × 2 around the origin of its mesh. Its two triangles share no vertices.
fn square() -> Gltf {
    let mut gltf = Gltf::new();
    let position = gltf.floats("VEC3", &[-1.0, -1.0, 0.0, 1.0, -1.0, 0.0, 1.0, 1.0, 0.0, -1.0, 1.0, 0.0]);
    let normal = gltf.floats("VEC3", &[0.0, 0.0, 1.0].repeat(4));
    let indices = gltf.indices(&[0, 1, 2, 0, 2, 3]);
    gltf.primitive(json!({"attributes": {"POSITION": position, "NORMAL": normal}, "indices": indices}));
    gltf
}

fn primitive(gltf: &mut Gltf) -> &mut Value {
    &mut gltf.json["meshes"][0]["primitives"][0]
}

/// Gives all four vertices these joints and weights, in sets of four.
fn bind(gltf: &mut Gltf, joints: &[u8], weights: &[f32]) {
    for (set, (joints, weights)) in joints.chunks(4).zip(weights.chunks(4)).enumerate() {
        let joints = gltf.accessor(U8, "VEC4", 4, &joints.repeat(4));
        let weights = gltf.floats("VEC4", &weights.repeat(4));
        primitive(gltf)["attributes"][format!("JOINTS_{set}")] = json!(joints);
        primitive(gltf)["attributes"][format!("WEIGHTS_{set}")] = json!(weights);
    }
    gltf.json["nodes"][0]["skin"] = json!(0);
}

fn drawn(gltf: &Gltf, warnings: &[(&str, &str)]) -> (Scene, [[f32; 3]; 2]) {
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, warnings);
    let bounds = bounds(&loaded);
    (loaded.scene, bounds)
}

#[test]
fn a_skin_places_its_mesh_and_the_node_does_not() {
    let mut gltf = square();
    bind(&mut gltf, &[0, 0, 0, 0], &[1.0, 0.0, 0.0, 0.0]);
    gltf.json["nodes"] = json!([
        {"mesh": 0, "skin": 0, "translation": [500, 0, 0], "scale": [100, 100, 100]},
        {"scale": [0.5, 0.5, 0.5], "children": [2]},
        {"translation": [4, 0, 0]},
    ]);
    gltf.json["scenes"] = json!([{"nodes": [0, 1]}]);
    gltf.json["skins"] = json!([{"joints": [2]}]);
    assert_eq!(drawn(&gltf, &[]).1, [[1.5, -0.5, 0.0], [2.5, 0.5, 0.0]]);
    // The inverse bind matrix removes the joint's own place.
    let mut matrix = [0.0_f32; 16];
    [0, 5, 10, 15].into_iter().for_each(|diagonal| matrix[diagonal] = 1.0);
    matrix[12] = -4.0;
    let inverse = gltf.accessor(F32, "MAT4", 1, &le(matrix.iter().map(|x| x.to_le_bytes())));
    gltf.json["skins"][0]["inverseBindMatrices"] = json!(inverse);
    assert_eq!(drawn(&gltf, &[]).1, [[-0.5, -0.5, 0.0], [0.5, 0.5, 0.0]]);
}

#[test]
fn joints_mix_by_their_weights_in_any_number_of_sets() {
    let mut gltf = square();
    // The weights do not sum to 1: a third goes to each joint.
    bind(&mut gltf, &[0, 1, 0, 0, 2, 0, 0, 0], &[2.0, 2.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0]);
    gltf.json["nodes"] = json!([
        {"mesh": 0, "skin": 0}, {"translation": [3, 0, 0]}, {"translation": [0, 6, 0]}, {"translation": [0, 0, 9]},
    ]);
    gltf.json["scenes"] = json!([{"nodes": [0, 1, 2, 3]}]);
    gltf.json["skins"] = json!([{"joints": [1, 2, 3]}]);
    let (_, bounds) = drawn(&gltf, &[]);
    assert_close(bounds.as_flattened(), &[0.0, 1.0, 3.0, 2.0, 3.0, 3.0], 1e-5);
}

#[test]
fn normals_follow_their_joints() {
    let mut gltf = square();
    bind(&mut gltf, &[0; 4], &[1.0, 0.0, 0.0, 0.0]);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    // A quarter turn about x turns z to −y; the joints are in centimetres.
    gltf.json["nodes"] = json!([
        {"mesh": 0, "skin": 0}, {"rotation": [half, 0, 0, half], "scale": [0.01, 0.01, 0.01]},
    ]);
    gltf.json["scenes"] = json!([{"nodes": [0, 1]}]);
    gltf.json["skins"] = json!([{"joints": [1]}]);
    let (scene, bounds) = drawn(&gltf, &[]);
    assert_close(bounds.as_flattened(), &[-0.01, 0.0, -0.01, 0.01, 0.0, 0.01], 1e-6);
    for normal in &scene.shape(&scene.pose(None, 0.0), 0, 0).unwrap().normals {
        assert_close(normal, &[0.0, -1.0, 0.0], 1e-5);
    }
}

#[test]
fn a_skin_that_is_broken_leaves_the_mesh_where_its_node_is() {
    let mut gltf = square();
    bind(&mut gltf, &[0; 4], &[1.0, 0.0, 0.0, 0.0]);
    gltf.json["nodes"][0]["translation"] = json!([7, 0, 0]);
    gltf.json["skins"] = json!([{"joints": [9]}]);
    let (_, bounds) = drawn(&gltf, &[("skins[0].joints[0]", "drawn without its skin")]);
    assert_eq!(bounds, [[6.0, -1.0, 0.0], [8.0, 1.0, 0.0]]);
    // A joint that the skin lacks is ignored.
    let mut gltf = square();
    bind(&mut gltf, &[0, 9, 0, 0], &[0.5, 0.5, 0.0, 0.0]);
    gltf.json["skins"] = json!([{"joints": [0]}]);
    assert_eq!(drawn(&gltf, &[("attributes.JOINTS_0", "4 joints")]).1, [[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]]);
}

#[test]
fn morph_targets_have_the_weights_of_the_mesh_or_of_the_node() {
    let mut gltf = square();
    let wider = gltf.floats("VEC3", &[-1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0]);
    let nearer = gltf.floats("VEC3", &[0.0, 0.0, 4.0].repeat(4));
    let tilt = gltf.floats("VEC3", &[0.0, 1.0, 0.0].repeat(4));
    primitive(&mut gltf)["targets"] = json!([{"POSITION": wider}, {"POSITION": nearer, "NORMAL": tilt}]);
    assert_eq!(drawn(&gltf, &[]).1, [[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]], "no weights: the base");
    gltf.json["meshes"][0]["weights"] = json!([1.0, 0.0]);
    assert_eq!(drawn(&gltf, &[]).1, [[-2.0, -1.0, 0.0], [2.0, 1.0, 0.0]]);
    // Two nodes with different weights are two shapes of one mesh.
    gltf.json["nodes"] = json!([{"mesh": 0, "weights": [0.5, 1.0]}, {"mesh": 0}]);
    gltf.json["scenes"] = json!([{"nodes": [0, 1]}]);
    let (scene, bounds) = drawn(&gltf, &[]);
    assert_eq!(bounds, [[-2.0, -1.0, 0.0], [2.0, 1.0, 4.0]]);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let normal = |node: usize| scene.shape(&scene.pose(None, 0.0), node, 0).unwrap().normals[0];
    assert_close(&normal(0), &[0.0, half, half], 1e-6);
    assert_eq!(normal(1), [0.0, 0.0, 1.0]);
}

#[test]
fn a_morph_target_that_does_not_fit_is_left_out() {
    let mut gltf = square();
    let short = gltf.floats("VEC3", &[9.0; 6]);
    primitive(&mut gltf)["targets"] = json!([{"POSITION": short}]);
    gltf.json["meshes"][0]["weights"] = json!([1.0]);
    let (_, bounds) = drawn(&gltf, &[("targets[0].POSITION", "2 elements, but POSITION has 4; it is left out")]);
    let mut colored = gltf.clone();
    primitive(&mut colored)["targets"] = json!([{"COLOR_0": 0}]);
    drawn(&colored, &[("primitives[0].targets", "COLOR_0 of morph targets is not read")]);
    assert_eq!(bounds, [[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]]);
}

#[test]
fn instances_are_placed_relative_to_their_node() {
    let mut gltf = square();
    let translations = gltf.floats("VEC3", &[0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 0.0, 20.0, 0.0]);
    let scales = gltf.floats("VEC3", &[1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 1.0, 1.0, 1.0]);
    // The rotation is a half turn about z in normalised bytes.
    let rotations = gltf.accessor(5120, "VEC4", 3, &[0, 0, 127, 0].repeat(3));
    gltf.json["accessors"][rotations]["normalized"] = json!(true);
    let attributes = json!({"TRANSLATION": translations, "SCALE": scales, "ROTATION": rotations});
    gltf.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": attributes}});
    gltf.json["nodes"][0]["translation"] = json!([0, 0, 5]);
    gltf.json["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
    gltf.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    let (scene, bounds) = drawn(&gltf, &[]);
    assert_eq!((scene.triangle_count(), scene.meshes.len()), (6, 1));
    assert_close(bounds.as_flattened(), &[-1.0, -2.0, 5.0, 12.0, 21.0, 5.0], 1e-4);
    let area = scene.surface_area(&scene.pose(None, 0.0));
    assert!((area - (4.0 + 16.0 + 4.0)).abs() < 1e-4, "{area}");
}

#[test]
fn colours_of_vertices_in_every_type() {
    let color = |component: u32, shape: &str, bytes: &[u8], normalized: bool, warnings: &[(&str, &str)]| {
        let mut gltf = square();
        let accessor = gltf.accessor(component, shape, 4, &bytes.repeat(4));
        gltf.json["accessors"][accessor]["normalized"] = json!(normalized);
        primitive(&mut gltf)["attributes"]["COLOR_0"] = json!(accessor);
        drawn(&gltf, warnings).0.meshes[0].colors[3]
    };
    let floats = |numbers: &[f32]| le(numbers.iter().map(|x| x.to_le_bytes()));
    let shorts = |numbers: &[u16]| le(numbers.iter().map(|x| x.to_le_bytes()));
    assert_eq!(color(F32, "VEC3", &floats(&[0.25, 0.5, 0.75]), false, &[]), [0.25, 0.5, 0.75, 1.0]);
    assert_eq!(color(F32, "VEC4", &floats(&[0.25, 0.5, 0.75, 0.5]), false, &[]), [0.25, 0.5, 0.75, 0.5]);
    assert_eq!(color(U8, "VEC4", &[51, 102, 153, 204], true, &[]), [0.2, 0.4, 0.6, 0.8]);
    assert_eq!(color(U16, "VEC4", &shorts(&[13107, 26214, 39321, 0]), true, &[]), [0.2, 0.4, 0.6, 0.0]);
    let whole = [("attributes.COLOR_0", "not normalised")];
    assert_eq!(color(U8, "VEC4", &[51, 102, 153, 255], false, &whole), [0.2, 0.4, 0.6, 1.0]);
}
