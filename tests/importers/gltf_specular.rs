//! Dielectric reflection: KHR_materials_ior, KHR_materials_specular, KHR_materials_pbrSpecularGlossiness.

use asvgf::scene::{Alpha, Material, Scene};
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
fn glass_is_a_thin_pane() {
    let pane = json!({"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.5}});
    let warned = [("materials[0].KHR_materials_transmission", "thin pane")];
    let pane = scene(pane, &warned).materials[0].clone();
    // 4 % of the light is reflected like a mirror, the rest goes through.
    assert_eq!(pane.alpha, Alpha::Blend);
    assert_close(&[pane.base_color[0], pane.base_color[3]], &[0.0, 0.04], 1e-6);
    assert_close(&pane.specular, &[1.0; 3], 1e-5);
    let half = scene(json!({"KHR_materials_transmission": {"transmissionFactor": 0.5}}), &warned).materials[0].clone();
    // With τ = 0.48: the colours that a ray meets, times the probability of meeting them, are (1 − t)(1 − F₀) = 0.48 and F₀ = 0.04.
    assert_close(&[half.base_color[3], half.base_color[0] * 0.52, half.specular[0] * 0.52], &[0.52, 0.48, 0.04], 1e-5);
    let none = material(json!({"KHR_materials_transmission": {}}));
    assert_eq!((none.alpha, none.base_color[3]), (Alpha::Opaque, 1.0));
}
