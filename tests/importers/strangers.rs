//! Files of kinds that were once drawn wrongly without a warning, or refused for no reason.

use asvgf::image_io;
use asvgf::scene::{Alpha, Environment, Loaded, load};
use serde_json::json;

use crate::common::*;

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn obj(text: &str, mtl: &str) -> Loaded {
    let folder = Folder::new();
    folder.write("test.mtl", mtl);
    folder.write("grey.png", png(1, 1, [102, 102, 102, 255]));
    load(folder.write("test.obj", text)).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn models_in_survey_coordinates_keep_their_shape() {
    // The square has sides of 0.3 m in UTM coordinates, where steps of f32 are half a metre.
    let text = "v 500000.13 4500000.37 12\nv 500000.43 4500000.37 12\nv 500000.43 4500000.67 12\nv 500000.13 4500000.67 12\nf 1 2 3 4\n";
    let loaded = obj(text, "");
    assert_warnings(&loaded, &[]);
    assert!((area(&loaded) - 0.09).abs() < 1e-5, "{}", area(&loaded));
    let bounds = loaded.scene.bounds(&loaded.scene.pose(None, 0.0)).unwrap();
    assert!((bounds[0][0] - 500_000.13).abs() < 1e-4 && (bounds[1][1] - 4_500_000.67).abs() < 1e-4, "{bounds:?}");
    // Nearer to the origin, positions are the file's own.
    assert_eq!(obj(&format!("{SQUARE}f 1 2 3 4\n"), "").scene.meshes[0].positions[2], [1.0, 1.0, 0.0]);
}

#[test]
fn a_grey_map_d_is_a_veil() {
    let text = format!("mtllib test.mtl\n{SQUARE}vt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
    let loaded = obj(&text, "newmtl m\nKd 1 1 1\nmap_d grey.png\n");
    assert_warnings(&loaded, &[]);
    let material = &loaded.scene.materials[0];
    let texel = loaded.scene.images[material.base_color_texture.unwrap().image].texels[0];
    assert_eq!((material.alpha, texel[3]), (Alpha::Blend, 102));
}

#[test]
fn names_that_end_with_a_backslash_join_no_lines() {
    let text = format!("mtllib test.mtl\n{SQUARE}g C:\\proj\\\nusemtl m\nf 1 2 \\\n3 4\n");
    let loaded = obj(&text, "newmtl m\nKd 0 0 1\n");
    assert_warnings(&loaded, &[]);
    assert_eq!(loaded.scene.materials[loaded.scene.meshes[0].material].base_color, [0.0, 0.0, 1.0, 1.0]);
    assert_eq!((area(&loaded), loaded.scene.meshes[0].name.as_str()), (1.0, "C:\\proj\\"));
}

#[test]
fn texts_that_were_padded_put_together_or_written_by_fortran() {
    for text in [
        format!("{SQUARE}f 1 2 3 4\n\0\0\0\0"),
        format!("{SQUARE}\u{FEFF}f 1 2 3 4\n"),
        "v 0.0D+00 0 0\nv 1.0f 0 0\nv 1 1.0d0 0\nv 0 1 0\nf 1 2 3 4\n".to_owned(),
    ] {
        assert_warnings(&obj(&text, ""), &[]);
        assert_eq!(area(&obj(&text, "")), 1.0, "{text}");
    }
    let bright = obj("v 0 0 0 2.5 0 0\nv 1 0 0 1 1 1\nv 1 1 0 1 1 1\nf 1 2 3\n", "");
    assert_warnings(&bright, &[("vertex colours", "1 are outside 0…1")]);
    assert_eq!(bright.scene.meshes[0].colors[1], [1.0; 4]);
}

#[test]
fn one_missing_file_is_one_warning() {
    let text = format!("mtllib absent.mtl\n{SQUARE}usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n");
    assert_warnings(&obj(&text, ""), &[("line 1", "absent.mtl")]);
    let text = format!("mtllib test.mtl\n{SQUARE}vt 0 0\nusemtl a\nf 1/1 2/1 3/1\nusemtl b\nf 1/1 3/1 4/1\n");
    let materials = "newmtl a\nmap_Kd no.png\nnewmtl b\nmap_Kd no.png\n";
    assert_warnings(&obj(&text, materials), &[("test.mtl material \"a\"", "no.png")]);
}

/// Loads a textured triangle with this material.
fn textured(texel: [u8; 4], material: serde_json::Value) -> Loaded {
    let mut gltf = Gltf::textured_triangle();
    let view = gltf.view(&png(1, 1, texel));
    gltf.push("images", json!({"bufferView": view}));
    gltf.push("textures", json!({"source": 0}));
    gltf.push("materials", material);
    gltf.load().unwrap()
}

#[test]
fn extensions_that_are_not_declared_are_named() {
    let loaded = textured([1; 4], json!({"extensions": {"KHR_materials_sheen": {}}}));
    assert_warnings(&loaded, &[("extension KHR_materials_sheen", "not read")]);
    let mut gltf = Gltf::triangle();
    gltf.json["meshes"][0]["primitives"][0]["extensions"] = json!({"KHR_draco_mesh_compression": {"bufferView": 0}});
    assert_error(gltf.load(), "test.gltf", "meshes[0].primitives[0]", "KHR_draco_mesh_compression");
    let mut gltf = Gltf::triangle();
    gltf.json["bufferViews"][0]["extensions"] = json!({"EXT_meshopt_compression": {}});
    assert_error(gltf.load(), "test.gltf", "bufferViews[0]", "meshopt");
}

#[test]
fn views_that_are_rounded_up_and_replacements_in_any_order() {
    let mut gltf = Gltf::triangle();
    gltf.json["bufferViews"][0]["byteLength"] = json!(38);
    assert_warnings(&gltf.load().unwrap(), &[]);
    let mut gltf = Gltf::triangle();
    let view = gltf.view(&le([2_u16, 0, 2].map(u16::to_le_bytes).into_iter()));
    let values = gltf.view(&le([5.0_f32, 5.0, 5.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0].map(f32::to_le_bytes).into_iter()));
    gltf.json["accessors"][0]["sparse"] = json!({
        "count": 3, "indices": {"bufferView": view, "componentType": U16}, "values": {"bufferView": values},
    });
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[]);
    // If one element has two values, the last one counts.
    assert_eq!(loaded.scene.meshes[0].positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 3.0, 0.0]]);
}

#[test]
fn glb_files_with_odd_lengths_and_versions_with_odd_names() {
    let folder = Folder::new();
    let whole = Gltf::triangle().glb();
    for length in [0, 20, whole.len() + 3] {
        let mut bytes = [whole.clone(), b"end".to_vec()].concat();
        bytes[8..12].copy_from_slice(&(length as u32).to_le_bytes());
        assert_eq!(load(folder.write("odd.glb", bytes)).unwrap().scene.triangle_count(), 1, "{length}");
    }
    for asset in [json!({"version": "2.0", "minVersion": "1.0"}), json!({"version": "v2.0"}), json!({"version": "2"})] {
        let mut gltf = Gltf::triangle();
        gltf.json["asset"] = asset;
        assert_warnings(&gltf.load().unwrap(), &[]);
    }
    let text = format!("{} trailing", Gltf::triangle().text());
    assert_warnings(&load(folder.write("trailing.gltf", text)).unwrap(), &[("JSON", "they are left out")]);
    let mut gltf = Gltf::triangle();
    folder.write("a.bin", &gltf.bytes);
    gltf.json["buffers"] = json!([{"byteLength": gltf.bytes.len(), "uri": "a.bin?v=3#top"}]);
    assert_warnings(&gltf.load_in(&folder).unwrap(), &[]);
}

#[test]
fn what_costs_a_file_nothing_takes_no_memory() {
    // Elements without data: a hundred nodes that place a million instances each, and primitives of 16 million vertices.
    let mut gltf = Gltf::triangle();
    let zeros = gltf.push("accessors", json!({"componentType": F32, "type": "VEC3", "count": 1 << 20}));
    let extension = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": zeros}}});
    gltf.json["nodes"] = json!(vec![json!({"mesh": 0, "extensions": extension}); 100]);
    gltf.json["scenes"] = json!([{"nodes": (0..100).collect::<Vec<_>>()}]);
    assert!(gltf.load().unwrap().scene.nodes.len() < (1 << 20) + 200);
}

#[test]
fn environments_that_announce_too_much_or_are_of_another_shape() {
    use exr::prelude::*;
    let folder = Folder::new();
    let write = |name: &str, display: (usize, usize), size: (usize, usize), cube: bool| {
        let attributes = LayerAttributes {
            environment_map: cube.then_some(exr::meta::attribute::EnvironmentMap::Cube),
            ..LayerAttributes::default()
        };
        let channels = SpecificChannels::rgb(|_: Vec2<usize>| (1.0_f32, f32::INFINITY, 1.0_f32));
        let mut image = Image::from_layer(Layer::new(size, attributes, Encoding::UNCOMPRESSED, channels));
        image.attributes.display_window = IntegerBounds::from_dimensions(display);
        let path = folder.0.join(name);
        image.write().to_file(&path).unwrap();
        path
    };
    let huge = Environment::load(write("huge.exr", (100_000, 50_000), (2, 1), false)).unwrap_err();
    assert!(huge.reason.contains("display window"), "{huge}");
    let cube = Environment::load(write("cube.exr", (2, 12), (2, 12), true)).unwrap_err();
    assert!(cube.reason.contains("cube map"), "{cube}");
    let (_, warnings) = Environment::load(write("probe.exr", (32, 32), (32, 32), false)).unwrap();
    assert!(warnings[1].reason.contains("light probe"), "{warnings:?}");
    // One channel is infinite, in any primaries.
    let image = image_io::Channels {
        width: 1,
        height: 1,
        channels: vec![("beauty.r".into(), vec![9.0]), ("albedo.r".into(), vec![1.0])],
    };
    assert!(image_io::write_exr(folder.0.join("no.exr"), &image).is_ok());
    assert!(Environment::load(folder.0.join("no.exr")).is_err(), "a red channel alone is no picture");
}

#[test]
fn skins_without_weights_are_where_their_node_is() {
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"] = json!([{"mesh": 0, "skin": 0, "translation": [100, 0, 0]}, {"translation": [5, 0, 0]}]);
    gltf.json["scenes"] = json!([{"nodes": [0, 1]}]);
    gltf.json["skins"] = json!([{"joints": [1]}]);
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[("attributes.JOINTS_0", "the mesh is drawn where its node is")]);
    assert_eq!(bounds(&loaded)[0][0], 100.0);
}
