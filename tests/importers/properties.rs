//! A valid file with one optional element broken at random: the file loads, the rest is drawn, one warning names the element.

use asvgf::scene::load;
use proptest::prelude::*;
use proptest::sample::select;
use serde_json::{Value, json};

use crate::common::*;

/// A file of two nodes with one triangle each. It has every optional element, and loads without a warning.
fn whole() -> Gltf {
    let mut gltf = Gltf::textured_triangle();
    let normal = gltf.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
    let color = gltf.floats("VEC4", &[0.5; 12]);
    let offsets = gltf.floats("VEC3", &[0.0; 9]);
    let indices = gltf.indices(&[0, 1, 2]);
    let primitive = &mut gltf.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["NORMAL"] = json!(normal);
    primitive["attributes"]["COLOR_0"] = json!(color);
    primitive["targets"] = json!([{"POSITION": offsets, "NORMAL": offsets}]);
    primitive["indices"] = json!(indices);
    gltf.json["meshes"][0]["weights"] = json!([0.5]);
    gltf.json["meshes"][0]["name"] = json!("mesh");

    let view = gltf.view(&png(1, 1, [10, 20, 30, 204]));
    gltf.json["images"] = json!([{"bufferView": view, "mimeType": "image/png", "name": "image"}]);
    gltf.json["samplers"] = json!([{"wrapS": 10497, "wrapT": 33071, "magFilter": 9728, "minFilter": 9729}]);
    gltf.json["textures"] = json!([{"source": 0, "sampler": 0}]);
    let texture = json!({"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform": {
        "offset": [0.5, 0], "rotation": 1, "scale": [2, 2], "texCoord": 0,
    }}});
    gltf.json["materials"] = json!([{
        "name": "material", "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.25, "emissiveFactor": [1, 1, 1],
        "emissiveTexture": texture,
        "pbrMetallicRoughness": {
            "baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0.5, "roughnessFactor": 0.5,
            "baseColorTexture": texture, "metallicRoughnessTexture": texture,
        },
        "extensions": {
            "KHR_materials_ior": {"ior": 1.4}, "KHR_materials_emissive_strength": {"emissiveStrength": 2},
            "KHR_materials_specular": {
                "specularFactor": 0.5, "specularColorFactor": [1, 1, 1], "specularTexture": texture, "specularColorTexture": texture,
            },
        },
    }]);
    gltf.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}, "name": "camera"}]);
    gltf.json["nodes"] = json!([
        {"mesh": 0, "name": "node", "translation": [1, 0, 0], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1], "children": [1],
         "weights": [0.25]},
        {"mesh": 0, "camera": 0},
    ]);
    let times = gltf.floats("SCALAR", &[0.0, 1.0]);
    let moves = gltf.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    gltf.json["animations"] = json!([{
        "name": "animation", "samplers": [{"input": times, "output": moves, "interpolation": "STEP"}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
    }]);
    gltf
}

/// Places that may get any value: only a broken element itself is lost.
const OPTIONAL: &[&str] = &[
    "/asset/generator",
    "/scene",
    "/nodes/0/name",
    "/nodes/0/translation",
    "/nodes/0/translation/1",
    "/nodes/0/rotation",
    "/nodes/0/rotation/3",
    "/nodes/0/scale",
    "/nodes/0/weights",
    "/nodes/1/camera",
    "/meshes/0/name",
    "/meshes/0/primitives/0/material",
    "/meshes/0/primitives/0/attributes/NORMAL",
    "/meshes/0/primitives/0/attributes/COLOR_0",
    "/meshes/0/primitives/0/attributes/TEXCOORD_0",
    "/meshes/0/primitives/0/targets/0/POSITION",
    "/meshes/0/primitives/0/targets/0/NORMAL",
    "/materials/0/name",
    "/materials/0/doubleSided",
    "/materials/0/alphaMode",
    "/materials/0/alphaCutoff",
    "/materials/0/emissiveFactor",
    "/materials/0/emissiveTexture/index",
    "/materials/0/pbrMetallicRoughness/baseColorFactor",
    "/materials/0/pbrMetallicRoughness/metallicFactor",
    "/materials/0/pbrMetallicRoughness/roughnessFactor",
    "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
    "/materials/0/pbrMetallicRoughness/metallicRoughnessTexture/extensions/KHR_texture_transform/rotation",
    "/materials/0/pbrMetallicRoughness/metallicRoughnessTexture/extensions/KHR_texture_transform/scale",
    "/materials/0/extensions/KHR_materials_ior/ior",
    "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength",
    "/materials/0/extensions/KHR_materials_specular/specularFactor",
    "/materials/0/extensions/KHR_materials_specular/specularColorFactor",
    "/materials/0/extensions/KHR_materials_specular/specularTexture/index",
    "/textures/0/source",
    "/textures/0/sampler",
    "/samplers/0/wrapS",
    "/images/0/bufferView",
    "/images/0/name",
    "/cameras/0/type",
    "/cameras/0/perspective",
    "/cameras/0/perspective/yfov",
    "/animations/0/name",
    "/animations/0/samplers/0/input",
    "/animations/0/samplers/0/output",
    "/animations/0/samplers/0/interpolation",
    "/animations/0/channels/0/sampler",
    "/animations/0/channels/0/target/node",
    "/animations/0/channels/0/target/path",
];

fn break_at(pointer: &str, value: &Value) -> Gltf {
    let mut gltf = whole();
    if pointer == "/asset/generator" {
        gltf.json["asset"]["generator"] = json!("");
    }
    *gltf.json.pointer_mut(pointer).unwrap() = value.clone();
    gltf
}

#[test]
fn the_whole_file_has_no_fault() {
    let loaded = whole().load().unwrap();
    assert_warnings(&loaded, &[]);
    assert_eq!(loaded.scene.triangle_count(), 2);
    for pointer in OPTIONAL.iter().filter(|pointer| **pointer != "/asset/generator") {
        assert!(whole().json.pointer(pointer).is_some(), "{pointer}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_broken_element_costs_itself_and_one_warning(
        pointer in select(OPTIONAL),
        value in select(vec![json!({}), json!({"a": 1}), json!([[]]), json!(true), json!(1e300), json!(-1e300)]),
    ) {
        let gltf = break_at(pointer, &value);
        // Some of these values are valid for some elements.
        let allowed = matches!(
            (pointer, &value),
            ("/materials/0/doubleSided", Value::Bool(_)) | ("/samplers/0/wrapS", Value::Object(_))
        );
        prop_assume!(!allowed);
        let loaded = gltf.load();
        prop_assert!(loaded.is_ok(), "{pointer} = {value}: {}", loaded.unwrap_err());
        let loaded = loaded.unwrap();
        prop_assert_eq!(loaded.scene.triangle_count(), 2, "{} = {}", pointer, value);
        prop_assert_eq!(loaded.warnings.len(), 1, "{} = {}: {:?}", pointer, value, loaded.warnings);
    }

    #[test]
    fn an_element_that_is_not_there_costs_itself_and_at_most_one_warning(pointer in select(OPTIONAL)) {
        let mut gltf = break_at(pointer, &json!(null));
        let (parent, name) = pointer.rsplit_once('/').unwrap();
        if let Some(parent) = gltf.json.pointer_mut(parent).and_then(Value::as_object_mut) {
            parent.remove(name);
        }
        let loaded = gltf.load();
        prop_assert!(loaded.is_ok(), "{pointer}: {}", loaded.unwrap_err());
        let loaded = loaded.unwrap();
        prop_assert_eq!(loaded.scene.triangle_count(), 2, "{}", pointer);
        prop_assert!(loaded.warnings.len() <= 1, "{}: {:?}", pointer, loaded.warnings);
    }

    #[test]
    fn numbers_that_are_none_cost_themselves(pointer in select(OPTIONAL), number in select(vec!["NaN", "-nan(ind)", "1e999"])) {
        let mark = "\"the number\"";
        let text = break_at(pointer, &json!("the number")).text().replace(mark, number);
        let loaded = load(Folder::new().write("nan.gltf", text));
        prop_assert!(loaded.is_ok(), "{pointer}: {}", loaded.unwrap_err());
        let loaded = loaded.unwrap();
        prop_assert_eq!(loaded.scene.triangle_count(), 2, "{}", pointer);
        // One warning is for text that is not JSON, and one for the element, unless the element may be null.
        prop_assert!(loaded.warnings.len() <= 2, "{}: {:?}", pointer, loaded.warnings);
    }

    #[test]
    fn damaged_bytes_never_panic(at in any::<prop::sample::Index>(), byte in any::<u8>(), binary in any::<bool>()) {
        let gltf = whole();
        let mut bytes = if binary { gltf.glb() } else { gltf.text().into_bytes() };
        let at = at.index(bytes.len());
        bytes[at] = byte;
        if let Ok(loaded) = load(Folder::new().write("damaged.gltf", bytes)) {
            prop_assert!(loaded.scene.validate().is_ok());
        }
    }
}
