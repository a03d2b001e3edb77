//! Dielectrics: KHR_materials_clearcoat, KHR_materials_ior, KHR_materials_transmission, KHR_materials_volume, KHR_materials_specular,
//! KHR_materials_pbrSpecularGlossiness.

use asvgf::scene::{Alpha, Clearcoat, Interior, Material, Scene};
use serde_json::{Value, json};

use crate::common::*;

fn material(extensions: Value) -> Material {
    scene(extensions, &[]).materials[0].clone()
}

fn scene(extensions: Value, warnings: &[(&str, &str)]) -> Scene {
    let mut gltf = Gltf::textured_triangle();
    let view = gltf.view(&png(1, 1, [10, 20, 30, 204]));
    gltf.push("images", json!({"bufferView": view}));
    gltf.push("textures", json!({"source": 0}));
    gltf.push("materials", json!({"extensions": extensions, "pbrMetallicRoughness": {"metallicFactor": 0}}));
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, warnings);
    loaded.scene
}

#[test]
fn an_index_of_refraction_is_a_reflectance() {
    let reflectance = |ior: f64| material(json!({"KHR_materials_ior": {"ior": ior}})).specular;
    assert_eq!(reflectance(1.5), [0.04; 3]);
    assert_eq!(reflectance(1.0), [0.0; 3]);
    assert_close(&reflectance(2.0), &[1.0 / 9.0; 3], 1e-6);
    assert_eq!(reflectance(0.0), [1.0; 3], "0 stands for infinity");
}

#[test]
fn factor_and_colour_of_the_specular_part() {
    let plain = material(json!({"KHR_materials_specular": {}}));
    assert_eq!((plain.specular, plain.specular_edge), ([0.04; 3], 1.0));
    let none = material(json!({"KHR_materials_specular": {"specularFactor": 0}}));
    assert_eq!((none.specular, none.specular_edge), ([0.0; 3], 0.0));
    let tinted = json!({"specularFactor": 0.5, "specularColorFactor": [1, 0.5, 100]});
    let tinted = material(json!({"KHR_materials_specular": tinted, "KHR_materials_ior": {"ior": 2.0}}));
    assert_close(&tinted.specular, &[0.5 / 9.0, 0.25 / 9.0, 0.5], 1e-6);
    assert_eq!(tinted.specular_edge, 0.5);
    let textured = json!({"specularTexture": {"index": 0}, "specularColorTexture": {"index": 0}});
    let textured = material(json!({"KHR_materials_specular": textured}));
    assert!(textured.specular_texture.is_some() && textured.specular_color_texture.is_some());
    let wrong = json!({"KHR_materials_specular": {"specularFactor": 3}});
    scene(wrong, &[("specularFactor", "3 is outside 0…1")]);
}

#[test]
fn glossiness_becomes_roughness() {
    let green =
        json!({"diffuseFactor": [0.1, 0.6, 0.2, 0.5], "specularFactor": [0.5, 0.25, 0], "glossinessFactor": 0.75});
    let green = material(json!({"KHR_materials_pbrSpecularGlossiness": green}));
    assert_close(&green.base_color, &[0.05, 0.3, 0.1, 0.5], 1e-6);
    assert_eq!((green.specular, green.metallic, green.roughness), ([0.5, 0.25, 0.0], 0.0, 0.25));

    // A texture's glossiness of 204 of 255, times ½, is a roughness of 153.
    let textured =
        json!({"specularGlossinessTexture": {"index": 0}, "diffuseTexture": {"index": 0}, "glossinessFactor": 0.5});
    let scene = scene(json!({"KHR_materials_pbrSpecularGlossiness": textured}), &[]);
    let material = &scene.materials[0];
    assert_eq!((material.roughness, material.metallic), (1.0, 0.0));
    let roughness = &scene.images[material.metallic_roughness_texture.unwrap().image];
    assert_eq!((roughness.width, roughness.texels[0][1]), (1, 153));
    let specular = &scene.images[material.specular_color_texture.unwrap().image];
    assert_eq!(specular.texels, [[10, 20, 30, 204]]);
    assert_eq!(material.base_color_texture.unwrap().image, 0);
}

#[test]
fn transmission_and_volume_are_glass() {
    let pane = material(json!({"KHR_materials_transmission": {"transmissionFactor": 0.75}}));
    assert_eq!((pane.transmission, pane.interior), (0.75, Interior { index: 1.5, absorption: None }));
    let none = material(json!({"KHR_materials_transmission": {}}));
    assert_eq!((none.transmission, none.alpha), (0.0, Alpha::Opaque));
    let body = |volume: Value| {
        json!({
            "KHR_materials_transmission": {"transmissionFactor": 1, "transmissionTexture": {"index": 0}},
            "KHR_materials_ior": {"ior": 1.33},
            "KHR_materials_volume": volume,
        })
    };
    let thin = material(body(json!({"attenuationDistance": 1, "attenuationColor": [0.5, 0.5, 0.5]})));
    assert_eq!(thin.interior, Interior { index: 1.33, absorption: None }, "a thickness of 0 is a pane");
    let clear = material(body(json!({"thicknessFactor": 0.1})));
    assert_eq!(clear.interior.absorption, Some([0.0; 3]), "an infinite distance absorbs nothing");
    assert!(clear.transmission_texture.is_some());
    let tinted = body(json!({"thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [1, 0.5, 0.25]}));
    let absorption = material(tinted).interior.absorption.unwrap();
    let half = 0.5 * 2.0_f32.ln();
    assert_close(&absorption, &[0.0, half, 2.0 * half], 1e-6);
    // Black at the distance is as near to black as a number comes.
    let black = body(json!({"thicknessFactor": 1, "attenuationDistance": 1, "attenuationColor": [0, 0, 0]}));
    assert!(material(black).interior.absorption.unwrap().iter().all(|sigma| (13.0..14.0).contains(sigma)));
}

#[test]
fn glass_that_is_wrong_costs_itself() {
    let body = |volume: Value| json!({"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": volume});
    let of = |volume: Value, element: &str, reason: &str| {
        scene(body(volume), &[(element, reason)]).materials[0].interior.absorption
    };
    assert_eq!(of(json!({"thicknessFactor": -1}), "thicknessFactor", "-1 is not at least 0; 0 is used"), None);
    let distance = json!({"thicknessFactor": 1, "attenuationDistance": 0, "attenuationColor": [0.5, 1, 1]});
    assert_eq!(of(distance, "attenuationDistance", "0 is not above 0; the volume absorbs nothing"), Some([0.0; 3]));
    let color = json!({"thicknessFactor": 1, "attenuationDistance": 1, "attenuationColor": [2, 1, 1]});
    assert_eq!(of(color, "attenuationColor", "2 is outside 0…1"), Some([0.0; 3]));
    let mut blended = Gltf::textured_triangle();
    let skin = body(json!({"thicknessFactor": 1}));
    blended.push("materials", json!({"extensions": skin, "alphaMode": "BLEND"}));
    assert_warnings(&blended.load().unwrap(), &[("materials[0].alphaMode", "the body is drawn whole")]);
    let alone = json!({"KHR_materials_volume": {"thicknessFactor": 1}});
    let opaque = scene(alone, &[("KHR_materials_volume", "no effect without KHR_materials_transmission")]);
    assert_eq!(opaque.materials[0].transmission, 0.0);
    let index = json!({"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 0.5}});
    assert_eq!(scene(index, &[("KHR_materials_ior.ior", "1.5 is used")]).materials[0].interior.index, 1.5);
    // Infinity mirrors everything, whatever its index.
    let mirror = json!({"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 0}});
    let mirror = material(mirror);
    assert_eq!((mirror.specular, mirror.interior.index), ([1.0; 3], Interior::MOST_INDEX));
}

#[test]
fn every_field_of_a_clear_coat() {
    let plain = material(json!({"KHR_materials_clearcoat": {}}));
    assert_eq!(plain.clearcoat, Clearcoat::default(), "a coat without a weight is none");
    let texture =
        json!({"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform": {"scale": [2, 3], "texCoord": 0}}});
    let normals = json!({"index": 0, "scale": 0.5});
    let full = material(json!({"KHR_materials_clearcoat": {
        "clearcoatFactor": 0.75, "clearcoatTexture": texture, "clearcoatRoughnessFactor": 0.25,
        "clearcoatRoughnessTexture": {"index": 0}, "clearcoatNormalTexture": normals,
    }}));
    let coat = full.clearcoat;
    assert_eq!((coat.weight, coat.roughness, coat.normal_scale), (0.75, 0.25, 0.5));
    let weights = coat.weight_texture.unwrap();
    assert_eq!((weights.uv_set, weights.transform[0][0], weights.transform[1][1]), (0, 2.0, 3.0));
    assert!(coat.roughness_texture.is_some() && coat.normal_texture.is_some());
    let old = json!({"KHR_materials_pbrSpecularGlossiness": {}, "KHR_materials_clearcoat": {"clearcoatFactor": 1}});
    assert_eq!(material(old).clearcoat.weight, 1.0);
}

#[test]
fn a_clear_coat_that_is_wrong_costs_itself() {
    let coat = |fields: Value| json!({"KHR_materials_clearcoat": fields});
    let of =
        |fields: Value, element: &str, reason: &str| scene(coat(fields), &[(element, reason)]).materials[0].clearcoat;
    assert_eq!(of(json!({"clearcoatFactor": 7}), "clearcoat.clearcoatFactor", "7 is outside 0…1").weight, 1.0);
    let rough = json!({"clearcoatFactor": 1, "clearcoatRoughnessFactor": -1});
    assert_eq!(of(rough, "clearcoatRoughnessFactor", "-1 is outside 0…1").roughness, 0.0);
    let text = of(json!({"clearcoatFactor": "much"}), "KHR_materials_clearcoat", "the surface has no coat");
    assert_eq!(text, Clearcoat::default());
    let nameless = json!({"clearcoatFactor": 1, "clearcoatRoughnessTexture": {}});
    assert_eq!(
        of(nameless, "clearcoatRoughnessTexture", "missing field `index`; the coat is drawn without it").weight,
        1.0
    );
    let missing = json!({"clearcoatFactor": 1, "clearcoatTexture": {"index": 9}});
    let missing = of(missing, "clearcoatTexture", "9");
    assert_eq!((missing.weight, missing.weight_texture), (1.0, None));
    let scale = json!({"clearcoatFactor": 1, "clearcoatNormalTexture": {"index": 0, "scale": 1e39}});
    assert_eq!(of(scale, "clearcoatNormalTexture", "1").weight, 1.0);
}
