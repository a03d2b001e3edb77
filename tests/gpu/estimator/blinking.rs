//! A lamp from a glTF file that is dark at rest, and blinks by KHR_animation_pointer.

use super::area::{ALBEDO, HEIGHT, LAMP, RADIANCE, below, expected};
use super::{ROUNDING, SIZE, channel, tracer};
use crate::common::stage::Stage;
use crate::common::statistics::Rgb;
use asvgf::scene::{Scene, load_from_memory};
use asvgf::{Mode, Sampling, Settings};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Strength at the second key; the first and the last have none.
const STRENGTH: f32 = 0.5;

/// A file under construction, whose numbers are in one buffer.
#[derive(Default)]
struct File {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl File {
    fn floats(&mut self, shape: &str, width: usize, numbers: &[f32]) -> usize {
        let offset = self.bytes.len();
        self.bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
        self.views.push(json!({"buffer": 0, "byteOffset": offset, "byteLength": 4 * numbers.len()}));
        let count = numbers.len() / width;
        self.accessors
            .push(json!({"bufferView": self.views.len() - 1, "componentType": 5126, "type": shape, "count": count}));
        self.accessors.len() - 1
    }

    fn quad(&mut self, material: usize, corners: [[f32; 3]; 4]) -> Value {
        let [a, b, c, d] = corners;
        let position = self.floats("VEC3", 3, [a, b, c, a, c, d].as_flattened());
        json!({"primitives": [{"attributes": {"POSITION": position}, "material": material}]})
    }
}

/// The floor and the lamp of `area`, with two channels: the colour is there from 1 s on, and the strength from 2 s to 3 s.
fn blinking() -> Scene {
    let mut file = File::default();
    let [[x0, x1], [z0, z1]] = LAMP.map(|range| range.map(|place| place as f32));
    let y = HEIGHT as f32;
    let floor = file.quad(0, [[-9.0, 0.0, 9.0], [9.0, 0.0, 9.0], [9.0, 0.0, -9.0], [-9.0, 0.0, -9.0]]);
    let lamp = file.quad(1, [[x0, y, z0], [x1, y, z0], [x1, y, z1], [x0, y, z1]]);
    let colors: Vec<f32> = [[0.0; 3], RADIANCE, RADIANCE].concat();
    let color = (file.floats("SCALAR", 1, &[0.0, 1.0, 4.0]), file.floats("VEC3", 3, &colors));
    let strength =
        (file.floats("SCALAR", 1, &[0.0, 2.0, 3.0, 4.0]), file.floats("SCALAR", 1, &[0.0, STRENGTH, 0.0, 0.0]));
    let channel = |sampler: usize, pointer: &str| {
        let extensions = json!({"KHR_animation_pointer": {"pointer": pointer}});
        json!({"sampler": sampler, "target": {"path": "pointer", "extensions": extensions}})
    };
    let matte = |color: f64| json!({"baseColorFactor": [color, color, color, 1.0], "metallicFactor": 0.0});
    let plain = json!({"KHR_materials_specular": {"specularFactor": 0.0}});
    let text = json!({
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_animation_pointer", "KHR_materials_emissive_strength", "KHR_materials_specular"],
        "extensionsRequired": ["KHR_animation_pointer"],
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"mesh": 1}],
        "meshes": [floor, lamp],
        "materials": [
            {"pbrMetallicRoughness": matte(ALBEDO), "extensions": plain},
            {"pbrMetallicRoughness": matte(0.0), "extensions": plain},
        ],
        "animations": [{
            "samplers": [
                {"input": color.0, "output": color.1, "interpolation": "STEP"},
                {"input": strength.0, "output": strength.1, "interpolation": "STEP"},
            ],
            "channels": [
                channel(0, "/materials/1/emissiveFactor"),
                channel(1, "/materials/1/extensions/KHR_materials_emissive_strength/emissiveStrength"),
            ],
        }],
        "buffers": [{"byteLength": file.bytes.len(), "uri": "numbers.bin"}],
        "bufferViews": file.views,
        "accessors": file.accessors,
    });
    let files = [("lamp.gltf", text.to_string().into_bytes()), ("numbers.bin", file.bytes)];
    let files: BTreeMap<PathBuf, Vec<u8>> = files.into_iter().map(|(name, bytes)| (name.into(), bytes)).collect();
    let loaded = load_from_memory(&files, "lamp.gltf").unwrap();
    assert!(loaded.warnings.is_empty(), "{:#?}", loaded.warnings);
    loaded.scene
}

#[test]
fn a_lamp_of_a_file_blinks_with_the_strength_of_its_keys() {
    for sampling in [Sampling::Both, Sampling::Lights] {
        let settings = Settings { mode: Mode::Noisy, tracer: tracer(sampling, 0), ..Settings::adaptive() };
        let mut stage = Stage::new(blinking(), SIZE, settings);
        stage.camera = Some(below());
        for (time, strength) in [(0.5, 0.0), (1.5, 0.0), (2.5, STRENGTH), (3.5, 0.0), (6.5, STRENGTH)] {
            let pose = stage.scene.pose(Some(0), time);
            let images: Vec<Vec<Rgb>> = (0..64).map(|_| stage.frame_in(&pose).image()).collect();
            for i in 0..3 {
                let expected = f64::from(strength) * expected(LAMP, i);
                channel(&images, i).assert_is(expected, ROUNDING, &format!("{sampling:?} at {time}"));
            }
        }
    }
}
