//! Primitives, accessors and containers of glTF files.

use asvgf::scene::load;
use serde_json::json;

use crate::common::*;

const SQUARE: [f32; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];

#[test]
fn a_triangle_gets_the_default_material_of_gltf() {
    let loaded = Gltf::triangle().load().unwrap();
    assert_warnings(&loaded, &[]);
    let mesh = &loaded.scene.meshes[0];
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert!(mesh.normals.is_empty() && mesh.uvs[0].is_empty());
    let material = &loaded.scene.materials[mesh.material];
    assert_eq!(material.base_color, [1.0; 4]);
    assert_eq!((material.metallic, material.roughness, material.specular), (1.0, 1.0, [0.04; 3]));
    assert_eq!(area(&loaded), 0.5);
}

#[test]
fn all_primitives_without_material_share_one() {
    let mut gltf = Gltf::triangle();
    gltf.push("materials", json!({}));
    let first = gltf.json["meshes"][0]["primitives"][0].clone();
    gltf.primitive(first);
    let scene = gltf.load().unwrap().scene;
    assert_eq!(scene.materials.len(), 2);
    assert_eq!(scene.meshes.iter().map(|mesh| mesh.material).collect::<Vec<_>>(), [1, 1]);
    assert_eq!(scene.nodes[0].meshes, [0, 1]);
}

#[test]
fn indices_of_every_type() {
    let corners = [0, 1, 2, 0, 2, 3_u32];
    for component in [U8, U16, U32] {
        let mut gltf = Gltf::new();
        let position = gltf.floats("VEC3", &SQUARE);
        let bytes: Vec<u8> = match component {
            U8 => corners.iter().map(|&corner| corner as u8).collect(),
            U16 => le(corners.iter().map(|&corner| (corner as u16).to_le_bytes())),
            _ => le(corners.iter().map(|corner| corner.to_le_bytes())),
        };
        let indices = gltf.accessor(component, "SCALAR", 6, &bytes);
        gltf.primitive(json!({"attributes": {"POSITION": position}, "indices": indices}));
        let loaded = gltf.load().unwrap();
        assert_eq!(loaded.scene.meshes[0].triangles, [[0, 1, 2], [0, 2, 3]], "{component}");
        assert_eq!(loaded.scene.meshes[0].positions.len(), 4);
    }
}

#[test]
fn strips_and_fans_keep_their_winding() {
    let strip = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 2.0, 0.0];
    let fan = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, -1.0, 1.0, 0.0];
    for (mode, positions) in [(5, strip), (6, fan)] {
        let mut gltf = Gltf::new();
        let position = gltf.floats("VEC3", &positions);
        gltf.primitive(json!({"attributes": {"POSITION": position}, "mode": mode}));
        let loaded = gltf.load().unwrap();
        let mesh = &loaded.scene.meshes[0];
        assert_eq!(mesh.triangles.len(), 3);
        assert_eq!(area(&loaded), 1.5);
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|corner| mesh.positions[corner as usize]);
            let z = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            assert!(z > 0.0, "mode {mode}: {triangle:?} faces away");
        }
    }
}

#[test]
fn a_fan_of_shared_vertices_may_skip_some() {
    let mut gltf = Gltf::new();
    let position = gltf.floats("VEC3", &[[9.0; 12].as_slice(), &SQUARE].concat());
    let indices = gltf.indices(&[4, 5, 6, 7]);
    gltf.primitive(json!({"attributes": {"POSITION": position}, "indices": indices, "mode": 6}));
    let loaded = gltf.load().unwrap();
    assert_eq!(loaded.scene.meshes[0].positions.len(), 4, "only the vertices in use are kept");
    assert_eq!(area(&loaded), 1.0);
    assert_eq!(bounds(&loaded), [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]]);
}

#[test]
fn points_and_lines_are_skipped_with_one_warning() {
    let mut gltf = Gltf::triangle();
    for mode in 0..4 {
        gltf.primitive(json!({"attributes": {"POSITION": 0}, "mode": mode}));
    }
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[("meshes[0].primitives[1]", "points and lines")]);
    assert_eq!(loaded.scene.triangle_count(), 1);
}

#[test]
fn interleaved_attributes() {
    let mut gltf = Gltf::new();
    let mut bytes = Vec::new();
    for vertex in 0..3 {
        bytes.extend(le([vertex as f32, (vertex * vertex) as f32, 0.5].iter().map(|x: &f32| x.to_le_bytes())));
        bytes.extend(le([0.0, 0.0, 2.0].iter().map(|x: &f32| x.to_le_bytes())));
        bytes.extend([vertex * 100, 255, 0, 0]);
    }
    let view = gltf.view(&bytes);
    gltf.json["bufferViews"][view]["byteStride"] = json!(28);
    for (offset, component, shape, normalized) in
        [(0, F32, "VEC3", false), (12, F32, "VEC3", false), (24, U8, "VEC2", true)]
    {
        gltf.push(
            "accessors",
            json!({"bufferView": view, "byteOffset": offset, "componentType": component, "type": shape, "count": 3,
                   "normalized": normalized}),
        );
    }
    gltf.primitive(json!({"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}));
    let loaded = gltf.load().unwrap();
    let mesh = &loaded.scene.meshes[0];
    assert_eq!(mesh.positions, [[0.0, 0.0, 0.5], [1.0, 1.0, 0.5], [2.0, 4.0, 0.5]]);
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]; 3], "normals are made unit vectors");
    assert_eq!(mesh.uvs[0], [[0.0, 1.0], [100.0 / 255.0, 1.0], [200.0 / 255.0, 1.0]]);
}

#[test]
fn sparse_accessors_with_and_without_a_base() {
    for base in [true, false] {
        let mut gltf = Gltf::triangle();
        let indices = gltf.view(&[1, 2]);
        let values = gltf.view(&le([5.0_f32, 0.0, 0.0, 0.0, 7.0, 0.0].iter().map(|x| x.to_le_bytes())));
        gltf.json["accessors"][0]["sparse"] = json!({
            "count": 2, "indices": {"bufferView": indices, "componentType": U8}, "values": {"bufferView": values}
        });
        if !base {
            gltf.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
        }
        let loaded = gltf.load().unwrap();
        assert_eq!(loaded.scene.meshes[0].positions, [[0.0; 3], [5.0, 0.0, 0.0], [0.0, 7.0, 0.0]]);
    }
}

#[test]
fn quantised_attributes() {
    let mut gltf = Gltf::new();
    gltf.json["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    gltf.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let padded = |numbers: [[i16; 3]; 3]| le(numbers.iter().flat_map(|&[x, y, z]| [x, y, z, 0]).map(i16::to_le_bytes));
    let mut add = |component: u32, shape: &str, bytes: &[u8], stride: u32, normalized: bool| {
        let accessor = gltf.accessor(component, shape, 3, bytes);
        gltf.json["bufferViews"][accessor]["byteStride"] = json!(stride);
        gltf.json["accessors"][accessor]["normalized"] = json!(normalized);
        accessor
    };
    let position = add(I16, "VEC3", &padded([[-32_768, 0, 0], [32_767, 0, 0], [0, 16_384, 0]]), 8, true);
    let integers = add(I16, "VEC3", &padded([[-3, 0, 0], [3, 0, 0], [0, 5, 0]]), 8, false);
    let normal = add(I8, "VEC3", &[0, 0, 127, 0, 0, 0, 129, 0, 127, 0, 0, 0], 4, true);
    let uv0 = add(U16, "VEC2", &le([0, 65_535, 65_535, 0, 0, 0_u16].map(u16::to_le_bytes).into_iter()), 4, true);
    let uv1 = add(I16, "VEC2", &le([-2, 3, 0, 0, 1, 1_i16].map(i16::to_le_bytes).into_iter()), 4, false);
    gltf.primitive(
        json!({"attributes": {"POSITION": position, "NORMAL": normal, "TEXCOORD_0": uv0, "TEXCOORD_1": uv1}}),
    );
    gltf.primitive(json!({"attributes": {"POSITION": integers}}));
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[]);
    let mesh = &loaded.scene.meshes[0];
    assert_close(mesh.positions.as_flattened(), &[-1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.500_015, 0.0], 1e-6);
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]]);
    assert_eq!(mesh.uvs[0], [[0.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
    assert_eq!(mesh.uvs[1], [[-2.0, 3.0], [0.0, 0.0], [1.0, 1.0]]);
    assert_eq!(loaded.scene.meshes[1].positions, [[-3.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 5.0, 0.0]]);
}

#[test]
fn normals_without_direction_are_replaced() {
    let mut gltf = Gltf::triangle();
    let normal = gltf.floats("VEC3", &[0.0, 0.0, 0.0, f32::NAN, 0.0, 1.0, 0.0, 3.0, 0.0]);
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(normal);
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[("primitives[0].attributes.NORMAL", "2 normals have no direction")]);
    assert_eq!(loaded.scene.meshes[0].normals, [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]);
}

#[test]
fn what_is_not_read_is_said_once() {
    let mut gltf = Gltf::triangle();
    let four = gltf.floats("VEC4", &[0.5; 12]);
    let three = gltf.floats("VEC3", &[0.5; 9]);
    let two = gltf.floats("VEC2", &[1.0; 6]);
    let primitive = json!({
        "attributes": {"POSITION": 0, "COLOR_1": three, "TANGENT": four, "TEXCOORD_2": two, "_CUSTOM": two},
    });
    gltf.primitive(primitive.clone());
    gltf.primitive(primitive);
    gltf.json["extensionsUsed"] = json!(["EXT_something", "KHR_materials_unlit"]);
    let loaded = gltf.load().unwrap();
    assert_warnings(
        &loaded,
        &[("extension EXT_something", "not read"), ("primitives[1]", "COLOR_0"), ("primitives[1]", "TEXCOORD_1")],
    );
}

#[test]
fn white_vertex_colours_need_no_warning() {
    let mut gltf = Gltf::triangle();
    let white = gltf.accessor(U8, "VEC4", 3, &[255; 12]);
    gltf.json["accessors"][white]["normalized"] = json!(true);
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(white);
    assert_warnings(&gltf.load().unwrap(), &[]);
}

#[test]
fn glb_files_with_chunks_of_other_kinds() {
    let folder = Folder::new();
    let gltf = Gltf::triangle();
    assert_eq!(area(&load(folder.write("a.GLB", gltf.glb())).unwrap()), 0.5);

    let mut json = gltf.json.clone();
    json["buffers"] = json!([{"byteLength": gltf.bytes.len()}]);
    let bytes = glb(&[(b"JSON", json.to_string().as_bytes()), (b"XTRA", b"1234"), (b"BIN\0", &gltf.bytes)]);
    // The first chunk has an odd length, and the next one starts at a multiple of four.
    let padding = json.to_string().len().next_multiple_of(4) - json.to_string().len();
    let at = 20 + json.to_string().len();
    let mut padded = [&bytes[..at], &vec![b' '; padding], &bytes[at..]].concat();
    let length = padded.len() as u32;
    padded[8..12].copy_from_slice(&length.to_le_bytes());
    assert_eq!(area(&load(folder.write("b.glb", padded)).unwrap()), 0.5);
}

#[test]
fn buffers_in_files_are_shared() {
    let folder = Folder::new();
    let mut gltf = Gltf::triangle();
    folder.write("data/my buffer.bin", &gltf.bytes);
    gltf.json["buffers"] = json!([
        {"byteLength": gltf.bytes.len(), "uri": "data/my%20buffer.bin"},
        {"byteLength": 4, "uri": "data/my buffer.bin"},
    ]);
    assert_eq!(area(&gltf.load_in(&folder).unwrap()), 0.5);
}

#[test]
fn a_file_that_draws_nothing_says_so() {
    let mut gltf = Gltf::new();
    gltf.json["scenes"] = json!([{"name": "without nodes"}]);
    let loaded = gltf.load().unwrap();
    assert_warnings(&loaded, &[("file", "no triangles")]);
    assert!(loaded.scene.nodes.is_empty());
}

#[test]
fn a_byte_order_mark_and_extras_do_no_harm() {
    let mut gltf = Gltf::triangle();
    gltf.json["extras"] = json!({"anything": [1, {"x": null}]});
    gltf.json["nodes"][0]["extras"] = json!(7);
    let folder = Folder::new();
    let text = format!("\u{FEFF}{}", gltf.text());
    assert_eq!(area(&load(folder.write("bom.gltf", text)).unwrap()), 0.5);
}
