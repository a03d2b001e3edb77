//! glTF files with one broken element each: the element is lost with one warning, and the rest is drawn.

use asvgf::scene::{Interpolation, Target, Transform, Wrap, load};
use serde_json::{Value, json};

use crate::common::*;

/// Asserts that the triangle of a file with one broken element is drawn nevertheless.
#[track_caller]
fn mended(change: impl FnOnce(&mut Gltf), element: &str, reason: &str) -> asvgf::scene::Scene {
    let mut gltf = Gltf::triangle();
    let indices = gltf.indices(&[0, 1, 2]);
    gltf.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    change(&mut gltf);
    let loaded = gltf.load().unwrap_or_else(|error| panic!("{element}: {error}"));
    assert_warnings(&loaded, &[(element, reason)]);
    assert_eq!(loaded.scene.triangle_count(), 1, "{element}");
    loaded.scene
}

#[test]
fn indices_that_lead_nowhere() {
    mended(set("/scene", json!(3)), "scene", "index 3 is out of range: the file has 1; the first scene is drawn");
    mended(set("/scenes/0/nodes", json!([0, 9])), "scene.nodes", "index 9");
    mended(set("/nodes/0/children", json!([5])), "nodes[0].children", "index 5");
    mended(set("/nodes/0/camera", json!(0)), "nodes[0].camera", "index 0");
    mended(set("/nodes/0/skin", json!(0)), "nodes[0].skin", "drawn without its skin");
    mended(set("/nodes/0/extensions", json!({"KHR_lights_punctual": {"light": 2}})), "nodes[0].light", "index 2");
    mended(set("/meshes/0/primitives/0/material", json!(7)), "meshes[0].primitives[0].material", "default material");
    mended(set("/materials", json!([{"emissiveTexture": {"index": 4}}])), "materials[0].emissiveTexture", "index 4");
    let textured = |texture: Value| {
        move |gltf: &mut Gltf| {
            gltf.json["materials"] = json!([{"emissiveTexture": {"index": 0}}]);
            gltf.json["textures"] = json!([texture]);
        }
    };
    mended(textured(json!({"source": 3})), "textures[0].source", "index 3");
    mended(textured(json!({"sampler": 0})), "textures[0].source", "names no image");
}

#[test]
fn triangles_that_use_vertices_that_are_not_finite() {
    // A vertex that is not finite costs its triangles; if nothing uses it, it costs nothing.
    let broken_vertex = |used: u16| {
        move |gltf: &mut Gltf| {
            let positions = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, f32::NAN, 0.0, 0.0];
            let positions = gltf.floats("VEC3", &positions);
            let indices = gltf.indices(&[0, 1, 2, 0, 1, used]);
            let primitive = &mut gltf.json["meshes"][0]["primitives"][0];
            primitive["attributes"]["POSITION"] = json!(positions);
            primitive["indices"] = json!(indices);
        }
    };
    mended(broken_vertex(3), "attributes.POSITION", "vertex 3 is not finite");
    let mut gltf = Gltf::triangle();
    broken_vertex(2)(&mut gltf);
    assert!(gltf.load().unwrap().warnings.is_empty());
}

#[test]
fn one_of_two_primitives() {
    let lost = |primitive: Value, element: &str, reason: &str| {
        mended(|gltf| gltf.primitive(primitive), element, reason);
    };
    lost(json!({"attributes": {}}), "primitives[1].attributes", "no POSITION; it is not drawn");
    lost(json!({"attributes": {"POSITION": 40}}), "primitives[1].attributes.POSITION", "index 40");
    lost(json!({"attributes": {"POSITION": 0}, "indices": 40}), "primitives[1].indices", "index 40");
    lost(json!({"attributes": {"POSITION": 0}, "indices": 0}), "primitives[1].indices", "type is not SCALAR");
    lost(json!({"attributes": {"POSITION": 0}, "mode": 9}), "primitives[1].mode", "0…6");
}

#[test]
fn attributes_that_do_not_fit() {
    let attribute = |name: &'static str, shape: &'static str, numbers: &'static [f32]| {
        move |gltf: &mut Gltf| {
            let accessor = gltf.floats(shape, numbers);
            gltf.json["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
        }
    };
    const NAN: f32 = f32::NAN;
    let scene = mended(attribute("NORMAL", "VEC3", &[0.0; 6]), "attributes.NORMAL", "2 elements, but POSITION has 3");
    assert!(scene.meshes[0].normals.is_empty());
    mended(attribute("NORMAL", "VEC2", &[0.0; 6]), "attributes.NORMAL", "not VEC3");
    let broken = &[NAN, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, f32::INFINITY];
    let scene = mended(attribute("NORMAL", "VEC3", broken), "attributes.NORMAL", "3 normals have no direction");
    assert_eq!(scene.meshes[0].normals, [[0.0, 0.0, 1.0]; 3]);
    mended(attribute("TEXCOORD_0", "VEC3", &[0.0; 9]), "attributes.TEXCOORD_0", "not VEC2");
    mended(attribute("TEXCOORD_0", "VEC2", &[NAN; 6]), "attributes.TEXCOORD_0", "3 texture coordinates");
    mended(attribute("COLOR_0", "VEC2", &[0.0; 6]), "attributes.COLOR_0", "white is used");
    let scene = mended(attribute("COLOR_0", "VEC3", &[2.0; 9]), "attributes.COLOR_0", "3 colours are outside 0…1");
    assert!(scene.meshes[0].colors.is_empty(), "2 clamped is white");
    mended(attribute("COLOR_1", "VEC3", &[0.0; 9]), "primitives[0]", "beyond COLOR_0");
}

#[test]
fn nodes_materials_and_lights_that_are_wrong() {
    let scene = mended(set("/nodes/0/rotation", json!([0, 0, 0, 0])), "nodes[0].rotation", "length is 0; the identity");
    assert_eq!(scene.nodes[0].transform, Transform::default());
    mended(set("/nodes/0/scale", json!([1e300, 1, 1])), "nodes[0].scale", "not finite");
    let matrix = json!([1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    mended(set("/nodes/0/matrix", matrix), "nodes[0].matrix", "last row");
    mended(set("/nodes/0/weights", json!([1e300])), "nodes[0].weights", "not finite");
    mended(set("/materials", json!([{"alphaMode": "MAYBE"}])), "materials[0].alphaMode", "OPAQUE");
    mended(set("/materials", json!([{"alphaMode": "MASK", "alphaCutoff": 1e300}])), "materials[0].alphaCutoff", "0.5");
    let ior = json!([{"extensions": {"KHR_materials_ior": {"ior": 0.5}}}]);
    mended(set("/materials", ior), "materials[0].KHR_materials_ior.ior", "1.5 is used");
    mended(set("/cameras", json!([{"type": "perspective"}])), "cameras[0].perspective", "is not there");
    mended(set("/cameras", json!([{"type": "fisheye"}])), "cameras[0]", "neither");
    let light = json!({"KHR_lights_punctual": {"lights": [{"type": "laser"}]}});
    mended(set("/extensions", light), "lights[0].type", "directional");
    let instancing = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 99}}});
    mended(set("/nodes/0/extensions", instancing), "attributes.TRANSLATION", "drawn once");
}

#[test]
fn circles_and_second_parents() {
    let with_nodes = |nodes: Value, root: usize| {
        move |gltf: &mut Gltf| {
            gltf.json["nodes"] = nodes;
            gltf.json["scenes"] = json!([{"nodes": [root]}]);
        }
    };
    mended(with_nodes(json!([{"children": [1]}, {"mesh": 0, "children": [0]}]), 0), "nodes[0]", "its own ancestor");
    mended(with_nodes(json!([{"mesh": 0, "children": [0]}]), 0), "nodes[0]", "its own ancestor");
    let twice = json!([{"children": [1, 2]}, {"children": [3]}, {"children": [3]}, {"mesh": 0}]);
    mended(with_nodes(twice, 0), "nodes[3]", "more than one node");
}

/// A file whose only channel has these keys.
fn animated(
    times: &'static [f32],
    values: usize,
    node: usize,
    interpolation: &'static str,
    path: &'static str,
) -> impl FnOnce(&mut Gltf) {
    move |gltf| {
        let input = gltf.floats("SCALAR", times);
        let values: Vec<f32> = (0..values * 3).map(|number| number as f32).collect();
        let output = gltf.floats("VEC3", &values);
        gltf.json["animations"] = json!([{
            "samplers": [{"input": input, "output": output, "interpolation": interpolation}],
            "channels": [{"sampler": 0, "target": {"node": node, "path": path}}],
        }]);
    }
}

#[test]
fn channels_that_are_wrong() {
    let sampler = "animations[0].samplers[0]";
    let input = format!("{sampler}.input");
    let output = format!("{sampler}.output");
    for (change, element, reason, channels) in [
        (animated(&[1.0, 0.0], 2, 0, "LINEAR", "scale"), &*input, "decrease; the channel is left out", 0),
        (animated(&[0.0, f32::NAN], 2, 0, "LINEAR", "scale"), &input, "1 keys are not finite", 1),
        (animated(&[f32::NAN], 1, 0, "LINEAR", "scale"), &input, "1 keys are not finite", 0),
        (animated(&[], 0, 0, "LINEAR", "scale"), &input, "there are no keys", 0),
        (animated(&[0.0, 1.0], 3, 0, "LINEAR", "scale"), &output, "3 values for 2 keys", 1),
        (animated(&[0.0, 1.0, 2.0], 2, 0, "LINEAR", "scale"), &output, "2 values for 3 keys", 1),
        (animated(&[0.0, 1.0], 2, 0, "CUBICSPLINE", "scale"), &output, "each has 3", 0),
        (animated(&[0.0, 1.0], 2, 0, "LINEAR", "rotation"), &output, "not VEC4", 0),
        (animated(&[0.0, 1.0], 2, 4, "LINEAR", "scale"), "animations[0].channels[0].target.node", "index 4", 0),
        (animated(&[0.0, 1.0], 2, 0, "JUMP", "scale"), &format!("{sampler}.interpolation"), "LINEAR is used", 1),
        (animated(&[0.0, 1.0], 2, 0, "LINEAR", "colour"), "channels[0].target.path", "translation", 0),
    ] {
        let scene = mended(change, element, reason);
        assert_eq!(scene.animations[0].channels.len(), channels, "{element}: {reason}");
    }
}

#[test]
fn two_keys_of_one_time_are_a_jump() {
    let mut gltf = Gltf::triangle();
    animated(&[0.0, 1.0, 1.0, 2.0], 4, 0, "LINEAR", "translation")(&mut gltf);
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[]);
    let channel = &loaded.scene.animations[0].channels[0];
    assert_eq!((channel.target, channel.interpolation), (Target::Translation(0), Interpolation::Linear));
    assert_eq!(channel.times, [0.0, 1.0, 1.0_f32.next_up(), 2.0]);
    let x = |time: f32| loaded.scene.pose(Some(0), time).world[0][3][0];
    assert_close(&[x(0.0), x(1.0), x(1.5)].map(|x| x as f32), &[0.0, 3.0, 7.5], 1e-5);
    assert!((x(1.0001) - 6.0).abs() < 1e-2, "after the jump");
}

#[test]
fn values_of_a_wrong_type() {
    for (pointer, value, element) in [
        ("/nodes/0/rotation", json!([null, 0, 0, 1]), "nodes[0].rotation"),
        ("/nodes/0/rotation", json!("none"), "nodes[0].rotation"),
        ("/nodes/0/translation", json!([1, 2]), "nodes[0].translation"),
        ("/nodes/0/name", json!(7), "nodes[0].name"),
        ("/nodes/0/children", json!(["a"]), "nodes[0].children[0]"),
        ("/materials", json!([{"pbrMetallicRoughness": {"roughnessFactor": "0.5"}}]), "roughnessFactor"),
        ("/materials", json!([7]), "materials[0]"),
        ("/meshes/0/primitives/0/material", json!("red"), "meshes[0].primitives[0].material"),
        ("/meshes/0/primitives/0/attributes/NORMAL", json!([1]), "attributes.NORMAL"),
        ("/meshes/0/weights", json!({}), "meshes[0].weights"),
        ("/textures", json!([{"source": -1}]), "JSON"),
        ("/textures", json!([{"source": -2}]), "textures[0].source"),
        ("/cameras", json!({}), "cameras"),
        ("/skins", json!([{"joints": "all"}]), "skins[0]"),
        ("/animations", json!([{"channels": 1, "samplers": []}]), "animations[0]"),
        ("/asset/generator", json!(1), "asset.generator"),
        ("/extensionsUsed", json!([1]), "extensionsUsed"),
    ] {
        mended(set(pointer, value), element, "");
    }
}

#[test]
fn text_that_is_nearly_json() {
    let folder = Folder::new();
    let whole = Gltf::triangle().text();
    let load_text = |text: String| load(folder.write("odd.gltf", text)).unwrap();
    let nan = load_text(whole.replacen("\"nodes\":[{", "\"nodes\":[{\"translation\":[NaN,0,0],", 1));
    assert!(nan.warnings.iter().any(|warning| warning.element == "nodes[0].translation"), "{:?}", nan.warnings);
    let comma = load_text(whole.replacen("\"nodes\":[{", "\"nodes\":[{\"name\":\"a\",", 1).replacen("}]", "},]", 1));
    assert_warnings(&comma, &[("JSON", "as if it were JSON")]);
    let units: Vec<u16> = whole.encode_utf16().collect();
    for bytes in [le(units.iter().map(|unit| unit.to_le_bytes())), le(units.iter().map(|unit| unit.to_be_bytes()))] {
        assert_warnings(&load(folder.write("utf_16.gltf", bytes)).unwrap(), &[("JSON", "as if it were JSON")]);
    }
    for loaded in [nan, comma] {
        assert_eq!(loaded.scene.triangle_count(), 1);
    }
}

#[test]
fn numbers_with_a_decimal_point_are_integers_too() {
    let text = Gltf::triangle().text().replace("5126", "5126.0").replace("\"count\":3", "\"count\":3.0");
    assert!(text.contains("5126.0") && text.contains("3.0"));
    assert_warnings(&load(Folder::new().write("float.gltf", text)).unwrap(), &[]);
}

#[test]
fn glb_chunks_without_padding() {
    let gltf = Gltf::triangle();
    let mut text = gltf.text_of_glb();
    while text.len() % 4 != 3 {
        text.push(' ');
    }
    let chunk = |kind: &[u8; 4], content: &[u8]| [&(content.len() as u32).to_le_bytes()[..], kind, content].concat();
    let chunks = [chunk(b"JSON", text.as_bytes()), chunk(b"BIN\0", &gltf.bytes)].concat();
    for announced in [12 + chunks.len(), 16 + chunks.len()] {
        let header = [&b"glTF"[..], &2_u32.to_le_bytes(), &(announced as u32).to_le_bytes()].concat();
        let loaded = load(Folder::new().write("unpadded.glb", [header, chunks.clone()].concat())).unwrap();
        assert_eq!(loaded.scene.triangle_count(), 1);
    }
    // The padding has zeros instead of spaces.
    let padded = [text.as_bytes(), &[0; 5]].concat();
    let file = glb(&[(b"JSON", &padded), (b"BIN\0", &gltf.bytes)]);
    assert_warnings(&load(Folder::new().write("zeros.glb", file)).unwrap(), &[]);
}

#[test]
fn data_uris_of_every_kind() {
    use base64::Engine as _;
    let gltf = Gltf::triangle();
    let base64 = base64::engine::general_purpose::STANDARD.encode(&gltf.bytes);
    let percent: String = gltf.bytes.iter().map(|byte| format!("%{byte:02X}")).collect();
    let url_safe = base64.replace('+', "-").replace('/', "_");
    for uri in [
        format!("data:application/gltf-buffer;charset=x;base64,{base64}"),
        format!("DATA:;BASE64,{}", base64.trim_end_matches('=')),
        format!("data:x/y;base64,{}\r\n {}", &base64[..20], &base64[20..]),
        format!("data:x/y;base64,{url_safe}"),
        format!("data:x/y;base64,{}", base64.replace('=', "%3D").replace('/', "%2F")),
        format!("data:application/octet-stream,{percent}"),
    ] {
        let mut gltf = gltf.clone();
        gltf.json["buffers"] = json!([{"byteLength": gltf.bytes.len(), "uri": uri}]);
        let loaded = gltf.load().unwrap();
        assert_warnings(&loaded, &[]);
        assert_eq!(loaded.scene.triangle_count(), 1);
    }
}

#[test]
fn a_stride_of_zero_and_a_wrap_mode_of_opengl() {
    let mut gltf = Gltf::triangle();
    gltf.json["bufferViews"][0]["byteStride"] = json!(0);
    assert_warnings(&gltf.load().unwrap(), &[]);
    let mut gltf = Gltf::textured_triangle();
    let view = gltf.view(&png(1, 1, [9; 4]));
    gltf.json["samplers"] = json!([{"wrapS": 10496, "wrapT": 33071}]);
    gltf.json["images"] = json!([{"bufferView": view}]);
    gltf.json["textures"] = json!([{"source": 0, "sampler": 0}]);
    gltf.json["materials"] = json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]);
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[("textures[0].sampler", "the texture repeats")]);
    let texture = loaded.scene.materials[0].base_color_texture.unwrap();
    assert_eq!(texture.wrap, [Wrap::Repeat, Wrap::Clamp]);
}

#[test]
fn a_buffer_that_is_missing_costs_its_users_alone() {
    let scene = mended(
        |gltf| {
            animated(&[0.0, 1.0], 2, 0, "LINEAR", "scale")(gltf);
            let views = gltf.json["bufferViews"].as_array().unwrap().len();
            let own = json!({"byteLength": gltf.bytes.len(), "uri": gltf.data_uri()});
            gltf.json["buffers"] = json!([own, {"byteLength": 24, "uri": "absent.bin"}]);
            gltf.json["bufferViews"][views - 1]["buffer"] = json!(1);
        },
        "buffers[1]",
        "\"absent.bin\" cannot be read",
    );
    assert!(scene.animations[0].channels.is_empty());
}
