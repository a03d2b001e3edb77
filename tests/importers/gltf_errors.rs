//! glTF files of which nothing can be drawn: each must give an error with file, element and reason.

use asvgf::scene::load;
use serde_json::{Value, json};

use crate::common::*;

/// Asserts that a file with one broken element is refused.
fn broken(change: impl FnOnce(&mut Gltf), element: &str, reason: &str) {
    let mut gltf = Gltf::triangle();
    let indices = gltf.indices(&[0, 1, 2]);
    gltf.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    assert!(gltf.load().is_ok());
    change(&mut gltf);
    assert_error(gltf.load(), "test.gltf", element, reason);
}

#[test]
fn indices_out_of_range() {
    broken(set("/nodes/0/mesh", json!(1)), "nodes[0].mesh", "index 1 is out of range");
    broken(set("/meshes/0/primitives/0/indices", json!(7)), "meshes[0].primitives[0].indices", "index 7");
    broken(
        set("/meshes/0/primitives/0/attributes/POSITION", json!(7)),
        "meshes[0].primitives[0].attributes.POSITION",
        "index 7",
    );
    broken(set("/accessors/0/bufferView", json!(7)), "primitives[0].attributes.POSITION", "index 7");
    broken(set("/bufferViews/0/buffer", json!(7)), "bufferViews[0]", "buffer 7 is out of range");
}

#[test]
fn accessors_that_do_not_fit() {
    broken(
        set("/accessors/0/count", json!(4_000_000)),
        "meshes[0].primitives[0].attributes.POSITION",
        "accessor 0: 4000000 elements of 12 bytes from byte 0 on do not fit the 36 bytes of buffer view 0",
    );
    broken(set("/accessors/0/count", json!(u64::MAX)), "POSITION", "do not fit");
    broken(set("/accessors/0/byteOffset", json!(u64::MAX - 4)), "POSITION", "do not fit");
    broken(set("/accessors/0/byteOffset", json!(4)), "POSITION", "from byte 4 on");
    broken(set("/bufferViews/0/byteOffset", json!(u64::MAX)), "bufferViews[0]", "not within its buffer");
    broken(set("/bufferViews/0/byteStride", json!(8)), "POSITION", "12 bytes do not fit a stride of 8");
    broken(set("/bufferViews/0/byteStride", json!(16)), "POSITION", "do not fit");
    broken(set("/accessors/1/count", json!(4)), "primitives[0].indices", "do not fit");
}

#[test]
fn accessors_without_data_cannot_ask_for_memory() {
    let zeros = |count: u64, sparse: Value| {
        move |gltf: &mut Gltf| {
            let accessor = gltf.json["accessors"][0].as_object_mut().unwrap();
            accessor.remove("bufferView");
            accessor.insert("count".into(), json!(count));
            accessor.insert("sparse".into(), sparse);
        }
    };
    broken(zeros(4_000_000_000, Value::Null), "POSITION", "4000000000 elements without a buffer view");
    let values = json!({"bufferView": 0});
    let indices = json!({"bufferView": 1, "componentType": U16});
    let sparse = |count: u64| json!({"count": count, "indices": indices, "values": values});
    broken(zeros(u64::MAX, sparse(1)), "POSITION", "without a buffer view");
    broken(zeros(1_000_000, sparse(900_000)), "POSITION", "do not fit");
    broken(zeros(2, sparse(3)), "POSITION", "sparse: 3 replacements for 2 elements");
    broken(zeros(2, sparse(2)), "primitives[0].indices", "index 2 is 2");
}

#[test]
fn sparse_accessors_that_are_wrong() {
    let sparse = |indices: [u16; 3], component: u32| {
        move |gltf: &mut Gltf| {
            let view = gltf.view(&le(indices.map(u16::to_le_bytes).into_iter()));
            gltf.json["accessors"][0]["sparse"] = json!({
                "count": 3, "indices": {"bufferView": view, "componentType": component}, "values": {"bufferView": 0}
            });
        }
    };
    broken(sparse([0, 1, 9], U16), "POSITION", "index 9 is out of range of 3");
    broken(sparse([0, 1, 2], F32), "POSITION", "not an unsigned integer");
}

#[test]
fn types_that_do_not_belong() {
    broken(set("/accessors/1/componentType", json!(F32)), "primitives[0].indices", "component type is FLOAT");
    broken(
        set("/accessors/1/componentType", json!(I16)),
        "primitives[0].indices",
        "is SHORT, where one of UNSIGNED_BYTE",
    );
    broken(set("/accessors/1/type", json!("VEC2")), "primitives[0].indices", "type is not SCALAR");
    broken(set("/accessors/0/type", json!("VEC4")), "POSITION", "type is not VEC3");
    broken(set("/accessors/0/type", json!("VEC9")), "POSITION", "type is not VEC3");
    broken(set("/accessors/0/componentType", json!(U32)), "POSITION", "UNSIGNED_INT");
    broken(set("/accessors/0/componentType", json!(1)), "POSITION", "does not exist");
    broken(set("/meshes/0/primitives/0/mode", json!(7)), "primitives[0].mode", "0…6");
}

#[test]
fn vertices_that_are_wrong() {
    broken(set("/meshes/0/primitives/0/attributes", json!({})), "primitives[0].attributes", "no POSITION");
    broken(|gltf| gltf.bytes[40] = 200, "meshes[0].primitives[0].indices", "index 2 is 200, but there are only 3");
    for number in [f32::NAN, f32::INFINITY] {
        broken(
            |gltf| gltf.bytes[16..20].copy_from_slice(&number.to_le_bytes()),
            "meshes[0].primitives[0].attributes.POSITION",
            "vertex 1 is not finite",
        );
    }
}

#[test]
fn files_that_are_no_gltf() {
    let folder = Folder::new();
    let load_text = |text: &str| load(folder.write("bad.gltf", text));
    assert_error(load_text(""), "bad.gltf", "JSON", "empty");
    assert_error(load_text(" \n"), "bad.gltf", "JSON", "empty");
    assert_error(load_text("{"), "bad.gltf", "JSON", "line 1");
    assert_error(load_text("[]"), "bad.gltf", "JSON", "");
    assert_error(load_text("{}"), "bad.gltf", "JSON", "asset");
    assert_error(load_text(r#"{"asset": {"version": "1.0"}}"#), "bad.gltf", "asset.version", "1.0");
    assert_error(load_text(r#"{"asset": {"version": "2.1", "minVersion": "2.1"}}"#), "bad.gltf", "asset", "2.0");
    assert_error(load_text(&"[".repeat(100_000)), "bad.gltf", "JSON", "");
    assert_error(load(folder.0.join("absent.gltf")), "absent.gltf", "file", "cannot be read");
    assert_error(load(folder.0.join("no_such_folder/absent.gltf")), "absent.gltf", "file", "cannot be read");
    std::fs::create_dir(folder.0.join("folder.gltf")).unwrap();
    assert_error(load(folder.0.join("folder.gltf")), "folder.gltf", "file", "not a regular file");
}

#[test]
fn extensions_that_are_required_and_unknown() {
    broken(
        |gltf| {
            gltf.json["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
            gltf.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
        },
        "extensionsRequired[0]",
        "KHR_draco_mesh_compression is not supported",
    );
}

#[test]
fn buffers_that_are_wrong() {
    let buffers = |buffer: Value| set("/buffers", json!([buffer]));
    broken(buffers(json!({"byteLength": 4, "uri": "absent.bin"})), "buffers[0]", "\"absent.bin\" cannot be read");
    broken(buffers(json!({"byteLength": 4})), "buffers[0]", "neither a uri nor");
    broken(buffers(json!({"byteLength": 9, "uri": "data:;base64,AAAA"})), "POSITION", "do not fit the 3 bytes");
    broken(buffers(json!({"byteLength": 1, "uri": "data:;base64,?"})), "buffers[0]", "not base64");
    broken(buffers(json!({"byteLength": 1, "uri": "data:text/plain"})), "buffers[0]", "not of the form");
    broken(buffers(json!({"byteLength": 1, "uri": "data:text/plain,%zz"})), "buffers[0]", "not percent-encoded");
    broken(buffers(json!({"byteLength": 1, "uri": "100%"})), "buffers[0]", "cannot be read");
}

#[test]
fn glb_files_that_are_cut_short() {
    let folder = Folder::new();
    let whole = Gltf::triangle().glb();
    for length in 0..whole.len() {
        let result = load(folder.write("cut.glb", &whole[..length]));
        assert!(result.is_err(), "{length} of {} bytes were accepted", whole.len());
    }
    let mut version = whole.clone();
    version[4] = 1;
    assert_error(load(folder.write("v1.glb", version)), "v1.glb", "GLB header", "version 1");
    let other = glb(&[(b"BIN\0", b"1234")]);
    assert_error(load(folder.write("bin.glb", other)), "bin.glb", "GLB chunk 0", "not JSON");
    let mut long = whole;
    long[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
    assert_error(load(folder.write("long.glb", long)), "long.glb", "GLB chunk 0", "past the end");
}
