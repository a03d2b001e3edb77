//! KHR_animation_pointer: lamps that blink.

use asvgf::scene::{Loaded, Target};
use serde_json::{Value, json};

use crate::common::*;

/// A pointer, its interpolation, the shape of its values, key times and values.
type Curve<'a> = (&'a str, &'a str, &'a str, &'a [f32], &'a [f32]);

/// A file with a triangle of an emitting material and three lights, in which these channels play.
fn animated(channels: &[Curve<'_>]) -> Gltf {
    let mut gltf = Gltf::triangle();
    gltf.json["extensionsUsed"] = json!(["KHR_animation_pointer", "KHR_lights_punctual"]);
    gltf.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    gltf.json["materials"] = json!([{"emissiveFactor": [0, 0.5, 0.25]}, {}]);
    gltf.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "nothing"}, {"type": "point", "intensity": 8, "color": [1, 0.5, 0]}, {"type": "point", "intensity": 0},
    ]}});
    gltf.json["nodes"][0]["extensions"] = json!({"KHR_lights_punctual": {"light": 1}});
    let (mut samplers, mut list) = (Vec::new(), Vec::new());
    for &(pointer, interpolation, shape, times, values) in channels {
        let (times, values) = (gltf.floats("SCALAR", times), gltf.floats(shape, values));
        list.push(channel(pointer, samplers.len()));
        samplers.push(json!({"input": times, "output": values, "interpolation": interpolation}));
    }
    gltf.json["animations"] = json!([{"samplers": samplers, "channels": list}]);
    gltf
}

fn channel(pointer: &str, sampler: usize) -> Value {
    let extensions = json!({"KHR_animation_pointer": {"pointer": pointer}});
    json!({"sampler": sampler, "target": {"path": "pointer", "extensions": extensions}})
}

/// The radiance of a material at a time, or at rest.
fn emission(loaded: &Loaded, material: usize, time: Option<f32>) -> [f32; 3] {
    let pose = loaded.scene.pose(time.map(|_| 0), time.unwrap_or_default());
    [0, 1, 2].map(|c| loaded.scene.materials[material].emissive[c] * pose.emission[material][c])
}

/// The intensity of a light at a time, or at rest.
fn intensity(loaded: &Loaded, light: usize, time: Option<f32>) -> [f32; 3] {
    let pose = loaded.scene.pose(time.map(|_| 0), time.unwrap_or_default());
    [0, 1, 2].map(|c| loaded.scene.lights[light].intensity[c] * pose.intensity[light][c])
}

/// The warnings beside those on the lights of [`animated`].
const LIGHTS: [(&str, &str); 2] = [("lights[0].type", "none of"), ("lights[1]", "photometric")];

#[test]
fn a_lamp_blinks_in_colours_that_it_does_not_have_at_rest() {
    let colors = [0.0, 0.0, 0.0, 4.0, 0.0, 0.25, 0.0, 1.0, 0.0];
    let loaded =
        animated(&[("/materials/0/emissiveFactor", "STEP", "VEC3", &[0.0, 1.0, 2.0], &colors)]).load().unwrap();
    assert_warnings(&loaded, &LIGHTS);
    // The greatest of all keys and of the value at rest decides how often the lamp is sampled.
    assert_eq!(loaded.scene.materials[0].emissive, [4.0, 1.0, 0.25]);
    for (time, expected) in [
        (None, [0.0, 0.5, 0.25]),
        (Some(0.0), [0.0; 3]),
        (Some(0.9), [0.0; 3]),
        (Some(1.0), [4.0, 0.0, 0.25]),
        (Some(1.9), [4.0, 0.0, 0.25]),
    ] {
        assert_close(&emission(&loaded, 0, time), &expected, 1e-6);
    }
    assert!(loaded.scene.materials[1].emissive == [0.0; 3] && loaded.scene.pose(Some(0), 1.5).emission[1] == [1.0; 3]);
}

#[test]
fn colour_and_strength_multiply_and_are_interpolated_apart() {
    let strength = "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength";
    let tangents = [9.0, 0.0, 0.0, 12.0, 8.0, 9.0];
    let mut gltf = animated(&[
        ("/materials/0/emissiveFactor", "LINEAR", "VEC3", &[0.0, 4.0], &[1.0, 0.0, 0.0, 0.0, 0.0, 1.0]),
        (strength, "CUBICSPLINE", "SCALAR", &[0.0, 2.0], &tangents),
    ]);
    gltf.json["materials"][0]["extensions"] = json!({"KHR_materials_emissive_strength": {"emissiveStrength": 2}});
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &LIGHTS);
    assert_close(&emission(&loaded, 0, None), &[0.0, 1.0, 0.5], 1e-6);
    for time in [0.0, 0.5, 1.0, 1.75_f32] {
        // The spline is t³ with slopes 0 and 12, and stays at 8.
        let (strength, part) = (time.powi(3), time / 4.0);
        assert_close(&emission(&loaded, 0, Some(time)), &[strength * (1.0 - part), 0.0, strength * part], 1e-5);
    }
    assert_close(&emission(&loaded, 0, Some(3.0)), &[2.0, 0.0, 6.0], 1e-5);
}

#[test]
fn lights_blink_too() {
    let light = |number: u32, name: &str| format!("/extensions/KHR_lights_punctual/lights/{number}/{name}");
    let [first, color, second] = [light(1, "intensity"), light(1, "color"), light(2, "intensity")];
    let loaded = animated(&[
        (&first, "LINEAR", "SCALAR", &[0.0, 2.0], &[0.0, 16.0]),
        (&color, "STEP", "VEC3", &[0.0, 1.0], &[0.0, 1.0, 0.0, 1.0, 1.0, 1.0]),
        (&second, "STEP", "SCALAR", &[0.0, 1.0], &[5.0, 0.0]),
        (&light(0, "intensity"), "STEP", "SCALAR", &[0.0, 1.0], &[5.0, 0.0]),
    ])
    .load()
    .unwrap();
    assert_warnings(&loaded, &LIGHTS);
    assert_close(&intensity(&loaded, 0, None), &[8.0, 4.0, 0.0], 1e-6);
    assert_close(&intensity(&loaded, 0, Some(0.5)), &[0.0, 4.0, 0.0], 1e-6);
    assert_close(&intensity(&loaded, 0, Some(1.5)), &[12.0; 3], 1e-5);
    assert_close(&intensity(&loaded, 1, None), &[0.0; 3], 1e-6);
    assert_close(&intensity(&loaded, 1, Some(0.5)), &[5.0; 3], 1e-6);
    assert_close(&intensity(&loaded, 1, Some(1.5)), &[0.0; 3], 1e-6);
    assert_eq!(loaded.scene.animations[0].channels.len(), 3);
}

#[test]
fn pointers_to_nodes_are_ordinary_channels() {
    let mut gltf = animated(&[
        ("/nodes/0/translation", "LINEAR", "VEC3", &[0.0, 1.0], &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]),
        ("/nodes/0/scale", "STEP", "VEC3", &[0.0, 1.0], &[2.0; 6]),
        ("/nodes/0/rotation", "STEP", "VEC4", &[0.0], &[0.0, 0.0, 0.0, 1.0]),
    ]);
    gltf.json["animations"][0]["channels"].as_array_mut().unwrap().push(channel("/nodes/7/translation", 0));
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[LIGHTS[0], LIGHTS[1], ("channels[3].target.node", "out of range")]);
    assert_close(&loaded.scene.pose(Some(0), 0.5).world[0][3], &[2.0, 0.0, 0.0, 1.0], 1e-6);
    assert_close(&loaded.scene.pose(Some(0), 0.5).world[0][0], &[2.0, 0.0, 0.0, 0.0], 1e-6);
}

#[test]
fn pointers_that_lead_nowhere_cost_themselves() {
    let color = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
    let step = |pointer| (pointer, "STEP", "VEC3", &[0.0_f32, 1.0][..], &color[..]);
    let mut gltf = animated(&[
        step("/materials/0/emissiveFactor"),
        step("/materials/0/emissiveFactor"),
        step("/materials/2/emissiveFactor"),
        step("/materials/x/emissiveFactor"),
        step("/materials/01/emissiveFactor"),
        step("/materials/0/pbrMetallicRoughness/baseColorFactor"),
        step("/materials/1/pbrMetallicRoughness/baseColorFactor"),
        step("/nodes/0/extensions/KHR_node_visibility/visible"),
        step("/extensions/KHR_lights_punctual/lights/3/intensity"),
        step("/extensions/KHR_lights_punctual/lights/1/intensity"),
        ("/materials/1/emissiveFactor", "STEP", "SCALAR", &[0.0, 1.0], &[1.0, 2.0]),
        ("/extensions/KHR_lights_punctual/lights/1/color", "STEP", "VEC3", &[0.0, 1.0], &[f32::NAN; 6]),
        step(""),
    ]);
    gltf.json["animations"][0]["channels"].as_array_mut().unwrap().extend([
        channel("/materials/1/emissiveFactor", 99),
        json!({"sampler": 0, "target": {"path": "pointer"}}),
        json!({"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": 5}}}}),
        json!({"target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/materials/1/emissiveFactor"}}}}),
    ]);
    let loaded = gltf.load().unwrap();
    assert_warnings(
        &loaded,
        &[
            LIGHTS[0],
            LIGHTS[1],
            ("channels[1]", "same target"),
            ("channels[2].target", "out of range"),
            ("channels[3].target", "\"x\" is not an index"),
            ("channels[4].target", "\"01\" is not an index"),
            ("channels[5].target", "/materials/*/pbrMetallicRoughness/baseColorFactor is not read"),
            ("channels[7].target", "/nodes/*/extensions/KHR_node_visibility/visible is not read"),
            ("channels[8].target", "out of range"),
            ("samplers[9].output", "SCALAR"),
            ("samplers[10].output", "VEC3"),
            ("samplers[11].input", "not finite"),
            ("channels[12].target", "is not read"),
            ("channels[13].sampler", "out of range"),
            ("channels[16].sampler", "out of range"),
            ("animations", "do not move a node"),
        ],
    );
    assert_eq!(loaded.scene.animations[0].channels.len(), 1);
    assert_eq!(loaded.scene.animations[0].channels[0].target, Target::EmissionColor(0));
    assert_close(&emission(&loaded, 0, Some(0.5)), &[1.0; 3], 1e-6);
}

#[test]
fn a_lamp_that_never_shines_and_one_that_is_too_bright_are_sound() {
    let factor = "/materials/0/emissiveFactor";
    let strength = "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength";
    let mut dark = animated(&[(factor, "LINEAR", "VEC3", &[0.0, 1.0], &[0.0, -1.0, 0.0, 0.0, 0.0, -3.0])]);
    dark.json["materials"][0]["emissiveFactor"] = json!([0, 0, 0]);
    let dark = dark.load().unwrap();
    assert!(dark.scene.materials[0].emissive == [0.0; 3]);
    assert_eq!(emission(&dark, 0, Some(0.5)), [0.0; 3]);
    let bright = animated(&[
        (factor, "LINEAR", "VEC3", &[0.0, 1.0], &[1e30, 1.0, 0.0, 0.0, 0.0, 0.0]),
        (strength, "CUBICSPLINE", "SCALAR", &[0.0, 1.0], &[3e38, 1e-30, 3e38, 3e38, 1e20, 3e38]),
    ]);
    let bright = bright.load().unwrap();
    assert_warnings(&bright, &[LIGHTS[0], LIGHTS[1], ("materials[0].emissiveFactor", "not finite")]);
    for time in [0.0, 0.3, 0.7, 0.99] {
        assert!(emission(&bright, 0, Some(time)).iter().all(|channel| *channel >= 0.0), "{time}");
        let factors = bright.scene.pose(Some(0), time).emission[0];
        assert!(factors.iter().all(|factor| factor.is_finite()), "{factors:?} at {time}");
    }
}
