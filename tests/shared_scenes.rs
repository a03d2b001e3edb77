//! Importers on scene files from elsewhere: `../shared/scenes` next to the repository, if it is at hand, with triangle counts, areas
//! and bounds that other programs have measured. Small files for each element are in `importers`.
#![cfg(all(feature = "gltf", feature = "obj"))]

#[path = "common/shared.rs"]
mod shared;

use std::fs;
use std::panic;
use std::path::Path;
use std::time::{Duration, Instant};

use asvgf::scene::{Alpha, LightKind, Loaded, Wrap, load};
use serde_json::Value;
use shared::shared;

/// A file that is always at hand.
const ROOM: &str = "assets/textured/room.glb";

/// The entries of a file of expectations.
fn expectations(path: &Path) -> Vec<(String, Value)> {
    let text = fs::read_to_string(path).unwrap();
    let json: Value = serde_json::from_str(&text).unwrap();
    json.as_object().unwrap().iter().map(|(name, value)| (name.clone(), value.clone())).collect()
}

#[track_caller]
fn read(path: impl AsRef<Path>) -> Loaded {
    load(path).unwrap_or_else(|error| panic!("{error}"))
}

fn assert_measures(name: &str, loaded: &Loaded, expected: &Value) {
    let scene = &loaded.scene;
    let pose = scene.pose(None, 0.0);
    assert_eq!(scene.triangle_count() as u64, expected["triangles"].as_u64().unwrap(), "{name}: triangles");
    let (area, expected_area) = (scene.surface_area(&pose), expected["area"].as_f64().unwrap());
    assert!((area - expected_area).abs() <= 1e-4 * expected_area, "{name}: area {area}, not {expected_area}");
    let bounds = scene.bounds(&pose).unwrap();
    let number = |end: usize, axis: usize| expected["bbox"][end][axis].as_f64().unwrap();
    let extent = (0..3).map(|axis| number(1, axis) - number(0, axis)).fold(0.0, f64::max);
    for (end, corner) in bounds.iter().enumerate() {
        for (axis, &actual) in corner.iter().enumerate() {
            let expected = number(end, axis);
            assert!((actual - expected).abs() <= 1e-4 * extent, "{name}: bounds {bounds:?}, not {expected}");
        }
    }
    if let Some(expected) = expected["emissive_triangles"].as_u64() {
        let emits = |mesh: &usize| scene.materials[scene.meshes[*mesh].material].emissive != [0.0; 3];
        let placed = scene.nodes.iter().flat_map(|node| &node.meshes);
        let triangles: usize = placed.filter(|mesh| emits(mesh)).map(|&mesh| scene.meshes[mesh].triangles.len()).sum();
        assert_eq!(triangles as u64, expected, "{name}: triangles that emit");
    }
    if let Some(expected) = expected["lights"].as_u64() {
        assert_eq!(scene.lights.len() as u64, expected, "{name}: lights");
    }
}

#[test]
fn scenes_have_the_measures_that_others_found() {
    let Some(folder) = shared("scenes") else { return };
    for (name, expected) in expectations(&folder.join("expected_scenes.json")) {
        let loaded = read(folder.join(&name));
        for warning in &loaded.warnings {
            println!("{name}: {}: {}", warning.element, warning.reason);
        }
        assert_measures(&name, &loaded, &expected);
    }
}

/// The repository's own file, measured by a script that knows nothing of the importer.
#[test]
fn the_room_has_the_measures_that_a_script_found() {
    let loaded = read(Path::new(env!("CARGO_MANIFEST_DIR")).join(ROOM));
    let expected = serde_json::json!({
        "triangles": 1574, "area": 73.14719, "bbox": [[-2.0, 0.0, -2.0], [2.0, 2.6, 2.0]], "emissive_triangles": 2, "lights": 0,
    });
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    assert_measures(ROOM, &loaded, &expected);
}

#[test]
fn edge_cases_load_or_fail_as_they_should() {
    let Some(folder) = shared("scenes") else { return };
    for (name, expected) in expectations(&folder.join("edge_cases/expected.json")) {
        let file = format!("{name}.gltf");
        let result = load(folder.join("edge_cases").join(&file));
        if expected["error"] == true {
            let error = result.map(|_| ()).expect_err(&name);
            println!("{error}");
            assert!(error.file.ends_with(&file) && !error.element.is_empty() && !error.reason.is_empty(), "{error}");
        } else {
            let loaded = result.unwrap_or_else(|error| panic!("{error}"));
            for warning in &loaded.warnings {
                println!("{name}: {}: {}", warning.element, warning.reason);
            }
            assert_measures(&name, &loaded, &expected);
        }
    }
}

#[test]
fn errors_name_the_element() {
    let Some(folder) = shared("scenes") else { return };
    let primitive = "meshes[0].primitives[0]";
    for (name, element, reason) in [
        ("bad_index_out_of_range", format!("{primitive}.indices"), "999"),
        ("bad_accessor_past_end", format!("{primitive}.attributes.POSITION"), "4000000 elements"),
        ("bad_missing_position", format!("{primitive}.attributes"), "POSITION"),
        ("bad_unknown_required_ext", "extensionsRequired[0]".into(), "not supported"),
        ("bad_index_accessor_float", format!("{primitive}.indices"), "FLOAT"),
        ("bad_missing_buffer_file", "buffers[0]".into(), "does_not_exist.bin"),
        ("bad_path_traversal", "buffers[0]".into(), "not within the folder"),
        ("bad_empty", "JSON".into(), "empty"),
    ] {
        let error = load(folder.join(format!("edge_cases/{name}.gltf"))).map(|_| ()).expect_err(name);
        assert!(error.element == element && error.reason.contains(reason), "{error}");
    }
}

#[test]
fn warnings_say_what_is_left_out() {
    let Some(folder) = shared("scenes") else { return };
    let quiet = [
        "bevy_cornell_box/CornellBox.glb",
        "bevy_gltf_primitives/gltf_primitives.glb",
        "bevy_torus/torus.gltf",
        "kajiya_emissive_triangle/triangle.glb",
        "khr_sparse/SimpleSparseAccessor.gltf",
        "khr_triangle_noindex/TriangleWithoutIndices.gltf",
        "cornell_original/CornellBox-Original.obj",
        "edge_cases/quantized_i16.gltf",
        "edge_cases/textures_uv_formats.gltf",
        "edge_cases/nested_transforms.gltf",
    ];
    for name in quiet {
        let warnings = read(folder.join(name)).warnings;
        assert!(warnings.is_empty(), "{name}: {warnings:#?}");
    }
    let said = |name: &str, parts: &[&str]| {
        let warnings = read(folder.join(name)).warnings;
        for part in parts {
            let said =
                |warning: &asvgf::scene::Warning| format!("{}: {}", warning.element, warning.reason).contains(part);
            assert!(warnings.iter().any(said), "{name}: nothing about {part} in {warnings:#?}");
        }
    };
    said("small_pine/scene.gltf", &["M_TreeAtlas_normal.png"]);
    said(
        "barn_lamp/AnisotropyBarnLamp.gltf",
        &["KHR_materials_anisotropy", "AnisotropyBarnLamp_occlusionroughnessmetal.ktx2\" is a KTX2 file"],
    );
    said("flight_helmet/FlightHelmet.gltf", &["occlusion maps"]);
    said("edge_cases/points_lines_mixed.gltf", &["points and lines"]);
}

#[test]
fn textures_are_decoded_and_placed() {
    let Some(folder) = shared("scenes") else { return };
    let scene = read(folder.join("edge_cases/textures_uv_formats.gltf")).scene;
    assert_eq!(scene.images.len(), 2);
    for image in &scene.images {
        assert_eq!((image.width, image.height), (8, 8));
        let holes = image.texels.iter().filter(|texel| texel[3] < 128).count();
        assert_eq!(holes, 32, "half of the texels are holes");
    }
    let textures: Vec<_> = scene.materials.iter().map(|material| material.base_color_texture.unwrap()).collect();
    assert_eq!(textures[0].wrap, [Wrap::Clamp, Wrap::Mirror]);
    assert!(textures[0].nearest && !textures[1].nearest);
    assert_eq!((textures[1].uv_set, textures[1].wrap), (1, [Wrap::Repeat; 2]));
    let (sin, cos) = 0.7_f32.sin_cos();
    let expected = [[2.0 * cos, 3.0 * sin, 0.25], [-2.0 * sin, 3.0 * cos, 0.5]];
    let transform = textures[2].transform.as_flattened();
    assert!(transform.iter().zip(expected.as_flattened()).all(|(a, b)| (a - b).abs() < 1e-6), "{transform:?}");
    assert!(scene.materials.iter().all(|material| material.alpha == Alpha::Mask(0.5) && material.double_sided));
    // Integers of 16 and 8 bits map to 0…1; floats stay as they are.
    for (mesh, size) in scene.meshes.iter().zip([1.0, 1.0, 2.0]) {
        assert_eq!(mesh.uvs[0], [[0.0, 0.0], [size, 0.0], [size, size], [0.0, size]]);
        assert_eq!(mesh.uvs[1], [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
    }

    let helmet = read(folder.join("flight_helmet/FlightHelmet.gltf")).scene;
    assert_eq!(helmet.images.len(), 15, "base colour, roughness and normals of five materials");
    assert!(helmet.images.iter().all(|image| image.texels.len() == (image.width * image.height) as usize));
    let path = folder.join("flight_helmet/FlightHelmet_Materials_LensesMat_BaseColor.png");
    let (_, _, texels) = asvgf::image_io::read_png(path).unwrap();
    let lenses = helmet.materials.iter().find(|material| material.name.contains("Lenses")).unwrap();
    assert_eq!(helmet.images[lenses.base_color_texture.unwrap().image].texels, texels);

    let balloon = read(folder.join("viva_balloon/scene.gltf")).scene;
    assert!(balloon.images.iter().all(|image| image.texels.iter().all(|texel| texel[3] == 255)), "JPEG is opaque");
    assert_eq!(balloon.images.len(), 17);
}

#[test]
fn materials_lights_and_names() {
    let Some(folder) = shared("scenes") else { return };
    let cornell = read(folder.join("cornell_original/CornellBox-Original.obj")).scene;
    let material = |name: &str| cornell.materials.iter().find(|material| material.name == name).unwrap();
    assert_eq!(material("light").emissive, [17.0, 12.0, 4.0]);
    assert_eq!(material("leftWall").base_color, [0.63, 0.065, 0.05, 1.0]);
    assert_eq!((material("tallBox").metallic, material("tallBox").base_color[0]), (1.0, 0.725));
    assert!(
        cornell.meshes.iter().any(|mesh| mesh.name == "tallBox"),
        "{:?}",
        cornell.meshes.iter().map(|mesh| &mesh.name).collect::<Vec<_>>()
    );

    let lamp = read(folder.join("barn_lamp/AnisotropyBarnLamp.gltf")).scene;
    assert_eq!(lamp.materials[1].emissive, [25.0, 12.5, 6.25]);

    let lights = read(folder.join("edge_cases/lights_punctual.gltf")).scene;
    assert_eq!(lights.lights[0].intensity, [50.0, 25.0, 10.0]);
    assert_eq!(lights.lights[1].kind, LightKind::Spot { inner: 0.2, outer: 0.5 });
    assert_eq!((lights.lights[1].range, lights.lights[2].kind), (10.0, LightKind::Directional));

    let ramp = read(folder.join("kajiya_roughness_scale/scene.gltf")).scene;
    assert!(ramp.meshes.iter().all(|mesh| mesh.normals.len() == mesh.positions.len()));
    let instances = read(folder.join("edge_cases/instances_1000.gltf")).scene;
    assert_eq!((instances.meshes.len(), instances.nodes.len()), (1, 1000));
}

/// Small files with bytes cut off or changed give a result soon, whatever it is.
#[test]
fn damaged_files_never_panic() {
    // The repository's own file is always damaged.
    let mut files = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join(ROOM)];
    let names = [
        "edge_cases/textures_uv_formats.gltf",
        "edge_cases/lights_punctual.gltf",
        "edge_cases/nested_transforms.gltf",
        "edge_cases/quantized_i16.gltf",
        "khr_sparse/SimpleSparseAccessor.gltf",
        "edge_cases/two_scenes.gltf",
        "kajiya_emissive_triangle/triangle.glb",
        "kenney_alien_cake/tile.glb",
        "bevy_gltf_primitives/gltf_primitives.glb",
        "cornell_original/CornellBox-Original.obj",
        "cornell_original/CornellBox-Original.mtl",
    ];
    files.extend(shared("scenes").into_iter().flat_map(|folder| names.map(|name| folder.join(name))));
    let temporary = std::env::temp_dir().join(format!("asvgf-damaged-{}", std::process::id()));
    fs::create_dir_all(&temporary).unwrap();
    let mut state = 0x2545_F491_4F6C_DD1D_u64;
    let mut random = |below: usize| {
        // xorshift64*: the same damage on every run.
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) as usize % below
    };
    let start = Instant::now();
    let (mut loads, mut accepted) = (0, 0);
    for file in files {
        let (name, whole) = (file.display(), fs::read(&file).unwrap());
        let extension = file.extension().unwrap().to_string_lossy().into_owned();
        for round in 0..100 {
            let mut bytes = whole.clone();
            match round % 4 {
                0 => bytes.truncate(random(whole.len())),
                1 => bytes[random(whole.len())] ^= 1 << random(8),
                2 => (0..8).for_each(|_| bytes[random(whole.len())] = random(256) as u8),
                // Digits become other digits: valid text with other numbers.
                _ => {
                    let digits: Vec<_> = (0..bytes.len()).filter(|&at| bytes[at].is_ascii_digit()).collect();
                    (0..3)
                        .filter(|_| !digits.is_empty())
                        .for_each(|_| bytes[digits[random(digits.len())]] = b'0' + random(10) as u8);
                }
            }
            let path = if extension == "mtl" {
                fs::write(temporary.join("CornellBox-Original.mtl"), &bytes).unwrap();
                let obj = temporary.join("whole.obj");
                fs::copy(file.with_extension("obj"), &obj).unwrap();
                obj
            } else {
                let path = temporary.join(format!("damaged.{extension}"));
                fs::write(&path, &bytes).unwrap();
                path
            };
            let result = panic::catch_unwind(|| load(&path));
            assert!(result.is_ok(), "{name}: round {round} panics; see {}", path.display());
            loads += 1;
            if let Ok(Ok(loaded)) = result {
                accepted += 1;
                loaded.scene.validate().unwrap();
            }
        }
    }
    println!("{loads} damaged files, {accepted} of them still readable, {:?}", start.elapsed());
    assert!(start.elapsed() < Duration::from_secs(60));
    fs::remove_dir_all(temporary).unwrap();
}
