//! Materials, textures and images of glTF files.

use asvgf::scene::{Alpha, Wrap};
use base64::Engine as _;
use serde_json::json;

use crate::common::*;

#[test]
fn every_field_of_a_material() {
    let mut gltf = Gltf::textured_triangle();
    gltf.json["extensionsUsed"] = json!(["KHR_materials_emissive_strength", "KHR_materials_unlit"]);
    gltf.push(
        "materials",
        json!({
            "name": "lamp", "doubleSided": true, "emissiveFactor": [1.0, 0.5, 0.25], "alphaMode": "MASK",
            "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.6, "roughnessFactor": 0.7},
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8.0}, "KHR_materials_unlit": {}},
        }),
    );
    gltf.push("materials", json!({"alphaMode": "MASK", "alphaCutoff": 0.75}));
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[]);
    let material = &loaded.scene.materials[0];
    assert_eq!(material.name, "lamp");
    assert_eq!(material.base_color, [0.1, 0.2, 0.3, 0.4]);
    assert_eq!((material.metallic, material.roughness, material.specular), (0.6, 0.7, [0.04; 3]));
    assert_eq!(material.emissive, [8.0, 4.0, 2.0]);
    assert!(material.double_sided && material.unlit);
    assert_eq!(material.alpha, Alpha::Mask(0.5));
    assert_eq!(loaded.scene.materials[1].alpha, Alpha::Mask(0.75));
}

#[test]
fn a_negative_strength_of_emission_is_named() {
    let mut gltf = Gltf::textured_triangle();
    let strength = json!({"KHR_materials_emissive_strength": {"emissiveStrength": -5}});
    gltf.push("materials", json!({"emissiveFactor": [1, 1, 1], "extensions": strength}));
    let loaded = gltf.load().unwrap();
    assert_warnings(
        &loaded,
        &[("materials[0].KHR_materials_emissive_strength.emissiveStrength", "-5 is not at least 0")],
    );
    assert_eq!(loaded.scene.materials[0].emissive, [0.0; 3]);
}

#[test]
fn occlusion_maps_are_said_to_be_left_out() {
    let mut gltf = Gltf::textured_triangle();
    gltf.push("textures", json!({"source": 0}));
    let view = gltf.view(&png(1, 1, [1; 4]));
    gltf.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    for _ in 0..2 {
        gltf.push("materials", json!({"alphaMode": "BLEND", "occlusionTexture": {"index": 0}}));
    }
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[("materials[0]", "occlusion")]);
    assert_eq!(loaded.details.len(), 2, "those of both materials");
    assert_eq!(loaded.scene.materials[0].alpha, Alpha::Blend);
    assert!(loaded.scene.images.is_empty(), "maps that are not read are not decoded");
}

#[test]
fn factors_out_of_range_are_clamped() {
    let mut gltf = Gltf::textured_triangle();
    gltf.push(
        "materials",
        json!({"emissiveFactor": [-1, 0, 0], "pbrMetallicRoughness": {
            "baseColorFactor": [1.5, 1.000_001, 0, 1], "metallicFactor": -1, "roughnessFactor": 1e300
        }}),
    );
    let loaded = gltf.load().unwrap();
    assert_warnings(
        &loaded,
        &[("baseColorFactor", "1.5"), ("metallicFactor", "-1"), ("roughnessFactor", "inf"), ("emissiveFactor", "-1")],
    );
    assert_eq!(loaded.scene.materials[0].base_color, [1.0, 1.0, 0.0, 1.0]);
    assert_eq!(loaded.scene.materials[0].emissive, [0.0; 3]);
}

#[test]
fn textures_from_views_data_uris_and_files() {
    let folder = Folder::new();
    folder.write("maps/red one.png", png(2, 3, [255, 0, 0, 128]));
    let mut gltf = Gltf::textured_triangle();
    let view = gltf.view(&png(1, 1, [1, 2, 3, 4]));
    let data = base64::engine::general_purpose::STANDARD.encode(png(4, 1, [0, 9, 0, 255]));
    gltf.json["images"] = json!([
        {"bufferView": view, "mimeType": "image/png"},
        {"uri": format!("data:image/png;base64,{data}")},
        {"uri": "maps/red%20one.png", "name": "red"},
        {"uri": "maps/red one.png"},
    ]);
    gltf.json["samplers"] = json!([{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}, {"magFilter": 9729}]);
    gltf.json["textures"] =
        json!([{"source": 0, "sampler": 0}, {"source": 1, "sampler": 1}, {"source": 2}, {"source": 3}, {"source": 2}]);
    gltf.push(
        "materials",
        json!({"emissiveTexture": {"index": 2}, "pbrMetallicRoughness": {
            "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}
        }}),
    );
    gltf.push(
        "materials",
        json!({"emissiveTexture": {"index": 3}, "pbrMetallicRoughness": {"baseColorTexture": {"index": 4}}}),
    );
    let loaded = gltf.load_in(&folder).unwrap();
    assert_warnings(&loaded, &[]);
    let scene = &loaded.scene;
    assert_eq!(scene.images.len(), 3, "each file is decoded once");
    let [first, second] = [&scene.materials[0], &scene.materials[1]];
    let base = first.base_color_texture.unwrap();
    assert_eq!((base.wrap, base.nearest), ([Wrap::Clamp, Wrap::Mirror], true));
    assert_eq!(scene.images[base.image].texels, [[1, 2, 3, 4]]);
    let rough = first.metallic_roughness_texture.unwrap();
    assert_eq!((rough.wrap, rough.nearest), ([Wrap::Repeat; 2], false));
    assert_eq!((scene.images[rough.image].width, scene.images[rough.image].height), (4, 1));
    let red = &scene.images[first.emissive_texture.unwrap().image];
    assert_eq!((red.name.as_str(), red.width, red.height), ("red", 2, 3));
    assert_eq!(red.texels, [[255, 0, 0, 128]; 6]);
    assert_eq!(first.emissive_texture, second.emissive_texture);
    assert_eq!(first.emissive_texture, second.base_color_texture);
}

#[test]
fn texture_transforms() {
    let mut gltf = Gltf::textured_triangle();
    gltf.json["extensionsUsed"] = json!(["KHR_texture_transform"]);
    let view = gltf.view(&png(1, 1, [0; 4]));
    gltf.push("images", json!({"bufferView": view}));
    gltf.push("textures", json!({"source": 0}));
    let info = json!({"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform": {
        "offset": [0, 1], "rotation": std::f32::consts::FRAC_PI_2, "scale": [0.5, 0.5], "texCoord": 0
    }}});
    gltf.push("materials", json!({"pbrMetallicRoughness": {"baseColorTexture": info}}));
    let loaded = gltf.load().unwrap();
    let texture = loaded.scene.materials[0].base_color_texture.unwrap();
    assert_eq!(texture.uv_set, 0);
    // The example in the extension's specification: the lower left quadrant of the image, rotated clockwise.
    let at = |u: f32, v: f32| texture.transform.map(|row| row[0] * u + row[1] * v + row[2]);
    assert_close(&at(0.0, 0.0), &[0.0, 1.0], 1e-6);
    assert_close(&at(1.0, 0.0), &[0.0, 0.5], 1e-6);
    assert_close(&at(0.0, 1.0), &[0.5, 1.0], 1e-6);
    assert_close(&at(1.0, 1.0), &[0.5, 0.5], 1e-6);
}

#[test]
fn images_that_cannot_be_read_are_named() {
    let folder = Folder::new();
    folder.write("old.ktx2", b"\xABKTX 20\xBB\r\n\x1A\n rest");
    folder.write("broken.png", &png(8, 8, [1; 4])[..60]);
    let mut gltf = Gltf::textured_triangle();
    gltf.json["images"] = json!([
        {"uri": "absent.png"}, {"uri": "old.ktx2"}, {"uri": "broken.png"}, {"uri": "../outside.png"}, {}, {"uri": "unused.jpg"},
    ]);
    for image in 0..5 {
        gltf.push("textures", json!({"source": image}));
        gltf.push("materials", json!({"emissiveTexture": {"index": image}}));
    }
    gltf.push("textures", json!({"extensions": {"KHR_texture_basisu": {"source": 1}}}));
    gltf.push("materials", json!({"emissiveTexture": {"index": 5}, "normalTexture": {"index": 4}}));
    let loaded = gltf.load_in(&folder).unwrap();
    assert_warnings(
        &loaded,
        &[
            ("images[0]", "absent.png"),
            ("images[1]", "old.ktx2\" is not a sound KTX2 file"),
            ("images[2]", "broken.png\" cannot be decoded"),
            ("images[3]", "not within the folder"),
            ("images[4]", "neither"),
            ("images[5]", "unused.jpg"),
        ],
    );
    assert!(loaded.scene.materials.iter().all(|material| material.emissive_texture.is_none()));
}

#[test]
fn images_of_more_than_16384_texels_a_side_are_left_out() {
    let mut gltf = Gltf::textured_triangle();
    let view = gltf.view(&png(16_385, 1, [0; 4]));
    gltf.push("images", json!({"bufferView": view}));
    gltf.push("textures", json!({"source": 0}));
    gltf.push("materials", json!({"emissiveTexture": {"index": 0}}));
    assert_warnings(&gltf.load().unwrap(), &[("images[0]", "cannot be decoded")]);
}

#[test]
fn texture_coordinates_that_are_not_there() {
    let mut gltf = Gltf::textured_triangle();
    let view = gltf.view(&png(1, 1, [0; 4]));
    gltf.push("images", json!({"bufferView": view}));
    gltf.push("textures", json!({"source": 0}));
    gltf.push("materials", json!({"emissiveTexture": {"index": 0, "texCoord": 1}}));
    gltf.push("materials", json!({"emissiveTexture": {"index": 0, "texCoord": 2}}));
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[("primitives[0]", "TEXCOORD_1"), ("materials[1].emissiveTexture", "TEXCOORD_2")]);
}
