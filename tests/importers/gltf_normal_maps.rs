//! Normal maps and tangents of glTF files.

use asvgf::scene::Loaded;
use serde_json::{Value, json};

use crate::common::*;

/// A triangle with normals whose material has this normal texture.
fn triangle(normal_texture: Value) -> Gltf {
    let mut gltf = Gltf::textured_triangle();
    let view = gltf.view(&png(1, 1, [10, 20, 30, 255]));
    gltf.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    gltf.push("textures", json!({"source": 0}));
    gltf.push("materials", json!({"normalTexture": normal_texture}));
    let normals = gltf.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
    attribute(&mut gltf, "NORMAL", normals);
    gltf
}

fn attribute(gltf: &mut Gltf, name: &str, accessor: usize) {
    gltf.json["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
}

fn with_tangents(normal_texture: Value, tangents: &[f32; 12]) -> Gltf {
    let mut gltf = triangle(normal_texture);
    let tangents = gltf.floats("VEC4", tangents);
    attribute(&mut gltf, "TANGENT", tangents);
    gltf
}

const TANGENTS: [f32; 12] = [1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.6, 0.8, 0.0, -1.0];

fn tangents(loaded: &Loaded) -> &[[f32; 4]] {
    &loaded.scene.meshes[0].tangents
}

/// The tangents in the shape in which the first node draws the mesh at rest.
fn posed_tangents(loaded: &Loaded) -> Vec<[f32; 4]> {
    let scene = &loaded.scene;
    scene.shape(&scene.pose(None, 0.0), 0, 0).unwrap().tangents
}

#[test]
fn a_normal_map_has_a_scale_and_a_place() {
    let plain = triangle(json!({"index": 0})).load().unwrap();
    assert_warnings(&plain, &[]);
    let material = &plain.scene.materials[0];
    let texture = material.normal_texture.unwrap();
    assert_eq!((texture.uv_set, material.normal_scale), (0, 1.0));
    assert_eq!(plain.scene.images[texture.image].texels, [[10, 20, 30, 255]], "the texels are as in the file");

    let transform = json!({"offset": [0.25, 0.5], "scale": [2.0, 3.0], "texCoord": 1});
    let placed = json!({"index": 0, "scale": -0.5, "extensions": {"KHR_texture_transform": transform}});
    let mut gltf = triangle(placed);
    let uv = gltf.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    attribute(&mut gltf, "TEXCOORD_1", uv);
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[]);
    let texture = loaded.scene.materials[0].normal_texture.unwrap();
    assert_eq!((texture.uv_set, loaded.scene.materials[0].normal_scale), (1, -0.5));
    assert_eq!(texture.transform, [[2.0, 0.0, 0.25], [0.0, 3.0, 0.5]]);
}

#[test]
fn a_normal_map_that_is_broken_costs_itself() {
    let absent = triangle(json!({"index": 7})).load().unwrap();
    assert_warnings(&absent, &[("materials[0].normalTexture", "index 7 is out of range")]);
    assert_eq!(absent.scene.materials[0].normal_texture, None);
    let huge = triangle(json!({"index": 0, "scale": 1e300})).load().unwrap();
    assert_warnings(&huge, &[("normalTexture.scale", "not finite; 1 is used")]);
    assert_eq!(huge.scene.materials[0].normal_scale, 1.0);
    let turned = json!({"index": 0, "extensions": {"KHR_texture_transform": {"rotation": "left"}}});
    let turned = triangle(turned).load().unwrap();
    assert_warnings(&turned, &[("normalTexture.KHR_texture_transform", "it is left out")]);
    assert!(turned.scene.materials[0].normal_texture.is_some());
    let third = triangle(json!({"index": 0, "texCoord": 2})).load().unwrap();
    assert_warnings(&third, &[("materials[0].normalTexture", "TEXCOORD_2 is not read")]);
}

#[test]
fn tangents_are_read_for_a_normal_map() {
    let read = with_tangents(json!({"index": 0}), &TANGENTS).load().unwrap();
    assert_warnings(&read, &[]);
    assert_close(tangents(&read).as_flattened(), &TANGENTS, 0.0);
    // Nothing depends on the tangents of a material without a normal map, or of a mesh without normals.
    let mut plain = with_tangents(json!({"index": 0}), &TANGENTS);
    plain.json["materials"][0] = json!({});
    let mut flat = with_tangents(json!({"index": 0}), &TANGENTS);
    flat.json["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("NORMAL");
    for gltf in [plain, flat] {
        let loaded = gltf.load().unwrap();
        assert!(tangents(&loaded).is_empty());
        assert!(!loaded.warnings.iter().any(|warning| warning.reason.contains("tangents")), "{:?}", loaded.warnings);
    }
}

#[test]
fn tangents_that_cannot_be_read_are_made_anew() {
    let mut none = TANGENTS;
    none[4..7].copy_from_slice(&[0.0; 3]);
    let mut wild = TANGENTS;
    wild[3] = f32::NAN;
    for tangents_of_file in [none, wild] {
        let loaded = with_tangents(json!({"index": 0}), &tangents_of_file).load().unwrap();
        assert_warnings(&loaded, &[("attributes.TANGENT", "1 tangents have no direction")]);
        assert!(tangents(&loaded).is_empty());
    }
    let mut short = triangle(json!({"index": 0}));
    let two = short.floats("VEC4", &TANGENTS[..8]);
    attribute(&mut short, "TANGENT", two);
    let loaded = short.load().unwrap();
    assert_warnings(&loaded, &[("attributes.TANGENT", "made from the texture coordinates")]);
}

#[test]
fn tangents_follow_morph_targets_and_joints() {
    let mut morphed = with_tangents(json!({"index": 0}), &TANGENTS);
    let offsets = morphed.floats("VEC3", &[0.0, 2.0, 0.0].repeat(3));
    morphed.json["meshes"][0]["primitives"][0]["targets"] = json!([{"TANGENT": offsets}]);
    morphed.json["meshes"][0]["weights"] = json!([0.5]);
    let loaded = morphed.load().unwrap();
    let (half, length) = (0.5_f32.sqrt(), 3.6_f32.sqrt());
    let expected = [half, half, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.6 / length, 1.8 / length, 0.0, -1.0];
    assert_close(posed_tangents(&loaded).as_flattened(), &expected, 1e-6);

    // A joint that mirrors x turns the handedness over: the relief is mirrored with the mesh.
    let mut skinned = with_tangents(json!({"index": 0}), &TANGENTS);
    let joints = skinned.accessor(U8, "VEC4", 3, &[0; 12]);
    let weights = skinned.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(3));
    attribute(&mut skinned, "JOINTS_0", joints);
    attribute(&mut skinned, "WEIGHTS_0", weights);
    skinned.json["nodes"] = json!([{"mesh": 0, "skin": 0}, {"scale": [-2, 1, 1]}]);
    skinned.json["scenes"][0]["nodes"] = json!([0, 1]);
    skinned.json["skins"] = json!([{"joints": [1]}]);
    let loaded = skinned.load().unwrap();
    let length = 2.08_f32.sqrt();
    let expected = [-1.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0, 1.0, -1.2 / length, 0.8 / length, 0.0, 1.0];
    assert_close(posed_tangents(&loaded).as_flattened(), &expected, 1e-6);
}
