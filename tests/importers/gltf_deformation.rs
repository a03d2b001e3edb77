//! Skins and morph targets that animations move, in all the forms that files have.

use asvgf::scene::{Loaded, MorphTarget, Target};
use serde_json::{Value, json};

use crate::common::*;

/// Two triangles that share no vertices: a small one at the origin, and one at x = 10.
fn triangles() -> Gltf {
    let mut gltf = Gltf::new();
    let small = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let far = [10.0, 0.0, 0.0, 11.0, 0.0, 0.0, 10.0, 1.0, 0.0];
    let position = gltf.floats("VEC3", &[small, far].concat());
    let normal = gltf.floats("VEC3", &[0.0, 0.0, 1.0].repeat(6));
    gltf.primitive(json!({"attributes": {"POSITION": position, "NORMAL": normal}}));
    gltf
}

fn primitive(gltf: &mut Gltf) -> &mut Value {
    &mut gltf.json["meshes"][0]["primitives"][0]
}

/// Adds a channel that animates a node, of keys at 0 and 1 seconds.
fn animate(gltf: &mut Gltf, node: usize, path: &str, output: usize, interpolation: &str) {
    let input = gltf.floats("SCALAR", &[0.0, 1.0]);
    let sampler = json!({"input": input, "output": output, "interpolation": interpolation});
    let channel = json!({"sampler": 0, "target": {"node": node, "path": path}});
    gltf.push("animations", json!({"samplers": [sampler], "channels": [channel]}));
}

/// Gives the mesh a skin of the nodes 1 and 2, at x = 0 and x = 5, whose weights are these bytes.
fn bind(gltf: &mut Gltf, component: u32, weights: &[u8], normalized: bool) {
    let joints = gltf.accessor(U16, "VEC4", 6, &le([0_u16, 1, 0, 0].repeat(6).into_iter().map(u16::to_le_bytes)));
    let weights = gltf.accessor(component, "VEC4", 6, &weights.repeat(6));
    gltf.json["accessors"][weights]["normalized"] = json!(normalized);
    primitive(gltf)["attributes"]["JOINTS_0"] = json!(joints);
    primitive(gltf)["attributes"]["WEIGHTS_0"] = json!(weights);
    gltf.json["nodes"] = json!([{"mesh": 0, "skin": 0}, {}, {"translation": [5, 0, 0]}]);
    gltf.json["scenes"] = json!([{"nodes": [0, 1, 2]}]);
    gltf.json["skins"] = json!([{"joints": [1, 2]}]);
}

/// World-space box at a time of the first animation.
fn bounds_at(loaded: &Loaded, time: f32) -> [f32; 6] {
    let bounds = loaded.scene.bounds(&loaded.scene.pose(Some(0), time)).unwrap();
    let mut numbers = [0.0; 6];
    numbers.iter_mut().zip(bounds.as_flattened()).for_each(|(number, &x)| *number = x as f32);
    numbers
}

fn clean(gltf: &Gltf) -> Loaded {
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[]);
    loaded
}

#[test]
fn animated_joints_move_their_vertices() {
    let floats = le([0.5_f32, 0.5, 0.0, 0.0].map(f32::to_le_bytes).into_iter());
    let shorts = le([0x8000_u16, 0x8000, 0, 0].map(u16::to_le_bytes).into_iter());
    // Integers are normalised, whether the file says so or not.
    for (component, weights, normalized) in
        [(F32, &floats[..], false), (U8, &[127, 127, 0, 0], true), (U16, &shorts, true), (U8, &[9, 9, 0, 0], false)]
    {
        let mut gltf = triangles();
        bind(&mut gltf, component, weights, normalized);
        let moved = gltf.floats("VEC3", &[5.0, 0.0, 0.0, 5.0, 8.0, 0.0]);
        animate(&mut gltf, 2, "translation", moved, "LINEAR");
        let loaded = clean(&gltf);
        assert_close(&bounds_at(&loaded, 0.0), &[2.5, 0.0, 0.0, 13.5, 1.0, 0.0], 1e-6);
        assert_close(&bounds_at(&loaded, 0.5), &[2.5, 2.0, 0.0, 13.5, 3.0, 0.0], 1e-6);
    }
}

#[test]
fn joints_outside_of_the_scene_place_their_vertices_too() {
    let mut gltf = triangles();
    let floats = le([0.0_f32, 1.0, 0.0, 0.0].map(f32::to_le_bytes).into_iter());
    bind(&mut gltf, F32, &floats, false);
    gltf.json["nodes"] = json!([
        {"mesh": 0, "skin": 0}, {"name": "bone"}, {"name": "tip", "translation": [5, 0, 0]},
        {"name": "root", "translation": [0, 0, 3], "children": [1, 2]},
    ]);
    gltf.json["scenes"] = json!([{"nodes": [0]}]);
    let moved = gltf.floats("VEC3", &[0.0, 0.0, 3.0, 0.0, 4.0, 3.0]);
    animate(&mut gltf, 3, "translation", moved, "LINEAR");
    let loaded = clean(&gltf);
    let names: Vec<&str> = loaded.scene.nodes.iter().map(|node| node.name.as_str()).collect();
    assert_eq!(names, ["", "root", "bone", "tip"]);
    assert_close(&bounds_at(&loaded, 0.5), &[5.0, 2.0, 3.0, 16.0, 3.0, 3.0], 1e-6);
}

#[test]
fn animated_weights_move_each_target() {
    // Two targets; the weights of a key stand side by side, and a spline has tangents around them.
    let linear = [0.0, 1.0, 1.0, 3.0];
    let spline = [[9.0, 9.0], [0.0, 1.0], [0.0, 0.0], [0.0, 0.0], [1.0, 3.0], [9.0, 9.0]].concat();
    let step = [0.5, 2.0, 1.0, 3.0];
    for (weights, interpolation) in [(&linear[..], "LINEAR"), (&spline, "CUBICSPLINE"), (&step, "STEP")] {
        let mut gltf = triangles();
        let targets = [[0.0, 2.0, 0.0], [0.0, 0.0, 1.0]].map(|offset| gltf.floats("VEC3", &offset.repeat(6)));
        primitive(&mut gltf)["targets"] = json!([{"POSITION": targets[0]}, {"POSITION": targets[1]}]);
        let output = gltf.floats("SCALAR", weights);
        animate(&mut gltf, 0, "weights", output, interpolation);
        let loaded = clean(&gltf);
        let targets: Vec<Target> = loaded.scene.animations[0].channels.iter().map(|channel| channel.target).collect();
        assert_eq!(targets, [0, 1].map(|target| Target::Weight { node: 0, target }));
        // Without slopes at the ends, a spline is half way in the middle.
        assert_close(&bounds_at(&loaded, 0.5), &[0.0, 1.0, 2.0, 11.0, 2.0, 2.0], 1e-6);
    }
}

#[test]
fn weights_of_nodes_without_targets_and_of_another_number_are_left_out() {
    let mut gltf = triangles();
    let output = gltf.floats("SCALAR", &[0.0, 1.0]);
    animate(&mut gltf, 0, "weights", output, "LINEAR");
    assert_warnings(&gltf.load().unwrap(), &[("channels[0].target", "no morph targets; the channel is left out")]);
    let offset = gltf.floats("VEC3", &[0.0, 1.0, 0.0].repeat(6));
    primitive(&mut gltf)["targets"] = json!([{"POSITION": offset}, {"POSITION": offset}]);
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[("samplers[0].output", "2 values for 2 keys, where each has 2")]);
    assert_eq!(loaded.scene.animations[0].channels[1].values, [[1.0, 0.0, 0.0, 0.0]]);
    let translations = gltf.floats("VEC3", &[0.0, 0.0, 0.0, 10.0, 0.0, 0.0]);
    let instancing = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": translations}}});
    gltf.json["nodes"][0]["extensions"] = instancing;
    assert_warnings(
        &gltf.load().unwrap(),
        &[("channels[0].target", "weights of EXT_mesh_gpu_instancing are not read")],
    );
}

#[test]
fn sparse_targets_list_the_vertices_that_move() {
    let mut gltf = triangles();
    let indices = gltf.view(&[1, 4]);
    let values = gltf.view(&le([0.0_f32, 3.0, 0.0, 0.0, 0.0, 7.0].map(f32::to_le_bytes).into_iter()));
    let sparse = json!({
        "count": 2,
        "indices": {"bufferView": indices, "componentType": U8},
        "values": {"bufferView": values},
    });
    let target = gltf.push("accessors", json!({"componentType": F32, "type": "VEC3", "count": 6, "sparse": sparse}));
    primitive(&mut gltf)["targets"] = json!([{"POSITION": target}]);
    gltf.json["meshes"][0]["weights"] = json!([1.0]);
    let loaded = clean(&gltf);
    let expected =
        MorphTarget { vertices: vec![1, 4], positions: vec![[0.0, 3.0, 0.0], [0.0, 0.0, 7.0]], ..Default::default() };
    assert_eq!(loaded.scene.meshes[0].targets, [expected]);
    assert_close(bounds(&loaded).as_flattened(), &[0.0, 0.0, 0.0, 11.0, 3.0, 7.0], 1e-6);
}

#[test]
fn extreme_weights_and_singular_joints_give_finite_shapes() {
    let mut gltf = triangles();
    let floats = le([0.5_f32, 0.5, 0.0, 0.0].map(f32::to_le_bytes).into_iter());
    bind(&mut gltf, F32, &floats, false);
    gltf.json["nodes"][2]["scale"] = json!([0, 0, 0]);
    gltf.json["nodes"][1]["scale"] = json!([0, 1, 1]);
    let offset = gltf.floats("VEC3", &[0.0, 1.0, 0.0].repeat(6));
    let broken = gltf.floats("VEC3", &[f32::NAN, 1.0, 0.0].repeat(6));
    primitive(&mut gltf)["targets"] = json!([{"POSITION": offset}, {"POSITION": broken}]);
    gltf.json["meshes"][0]["weights"] = json!([1e6, 1.0]);
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[("primitives[0].targets", "6 offsets are not finite; 0 is used")]);
    assert_close(bounds(&loaded).as_flattened(), &[2.5, 5e5, 0.0, 2.5, 5e5 + 0.5, 0.0], 0.1);
    let shape = loaded.scene.shape(&loaded.scene.pose(None, 0.0), 0, 0).unwrap();
    assert!(shape.normals.as_flattened().iter().all(|number| number.is_finite()), "{:?}", shape.normals);
    // Shares that add up to 0 are no shares: the vertex follows its first joint.
    let cancelling = le([0.5_f32, -0.5, 0.0, 0.0].map(f32::to_le_bytes).into_iter());
    let mut gltf = triangles();
    bind(&mut gltf, F32, &cancelling, false);
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[("attributes.WEIGHTS_0", "6 vertices have no weights above 0")]);
    assert_close(bounds(&loaded).as_flattened(), &[0.0, 0.0, 0.0, 11.0, 1.0, 0.0], 1e-6);
}

#[test]
fn a_matrix_that_is_not_finite_costs_the_skin() {
    let mut gltf = triangles();
    let floats = le([0.5_f32, 0.5, 0.0, 0.0].map(f32::to_le_bytes).into_iter());
    bind(&mut gltf, F32, &floats, false);
    let mut matrices = [0.0_f32; 32];
    [0, 5, 10, 15, 16, 21, 26, 31].into_iter().for_each(|diagonal| matrices[diagonal] = 1.0);
    matrices[19] = 0.5;
    let inverse = |gltf: &mut Gltf, matrices: &[f32]| {
        let bytes = le(matrices.iter().map(|x| x.to_le_bytes()));
        let accessor = gltf.accessor(F32, "MAT4", 2, &bytes);
        gltf.json["skins"][0]["inverseBindMatrices"] = json!(accessor);
    };
    inverse(&mut gltf, &matrices);
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[("inverseBindMatrices", "the last row of matrix 1")]);
    assert_close(bounds(&loaded).as_flattened(), &[2.5, 0.0, 0.0, 13.5, 1.0, 0.0], 1e-6);
    matrices[20] = f32::INFINITY;
    inverse(&mut gltf, &matrices);
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[("inverseBindMatrices", "matrix 1 is not finite; the mesh is drawn without its skin")]);
    assert_close(bounds(&loaded).as_flattened(), &[0.0, 0.0, 0.0, 11.0, 1.0, 0.0], 1e-6);
}

#[test]
fn instances_of_a_skin_are_drawn_once_and_named() {
    let mut gltf = triangles();
    let floats = le([1.0_f32, 0.0, 0.0, 0.0].map(f32::to_le_bytes).into_iter());
    bind(&mut gltf, F32, &floats, false);
    let translations = gltf.floats("VEC3", &[0.0, 0.0, 0.0, 10.0, 0.0, 0.0]);
    let instancing = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": translations}}});
    gltf.json["nodes"][0]["extensions"] = instancing;
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[("nodes[0].EXT_mesh_gpu_instancing", "beside a skin; the mesh is drawn once")]);
    assert_eq!(loaded.scene.triangle_count(), 2);
}
