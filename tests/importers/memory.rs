//! Scenes load the same from memory as from disk.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use asvgf::scene::{load, load_from_memory};
use serde_json::json;

use crate::common::*;

type Files = BTreeMap<PathBuf, Vec<u8>>;

fn files<const N: usize>(files: [(&str, Vec<u8>); N]) -> Files {
    files.into_iter().map(|(path, bytes)| (path.into(), bytes)).collect()
}

/// A glTF file whose buffer and image are separate files in folders.
fn gltf() -> Files {
    let mut gltf = Gltf::textured_triangle();
    gltf.json["buffers"] = json!([{"byteLength": gltf.bytes.len(), "uri": "data/triangle.bin"}]);
    gltf.push("materials", json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    gltf.push("textures", json!({"source": 0}));
    gltf.push("images", json!({"uri": "./images/on%20wood.png"}));
    let bytes = gltf.bytes.clone();
    let image = png(2, 1, [200, 100, 50, 255]);
    files([
        ("room/test.gltf", gltf.text().into()),
        ("room/data/triangle.bin", bytes),
        ("room/images/on wood.png", image),
    ])
}

fn obj() -> Files {
    let scene = "mtllib parts/a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
    let library = "newmtl m\nKd 1 1 1\nmap_Kd wood.png\n";
    let image = png(1, 2, [1, 2, 3, 255]);
    files([("test.obj", scene.into()), ("parts/a.mtl", library.into()), ("wood.png", image)])
}

/// The scene and warnings of the same files on disk.
fn on_disk(files: &Files, path: &str) -> String {
    let folder = Folder::new();
    for (path, bytes) in files {
        folder.write(path.to_str().unwrap(), bytes);
    }
    format!("{:?}", load(folder.0.join(path)).unwrap())
}

/// The same files, each without its folder.
fn flat(files: Files) -> Files {
    files.into_iter().map(|(path, bytes)| (path.file_name().unwrap().into(), bytes)).collect()
}

#[test]
fn every_kind_of_file_is_what_it_is_on_disk() {
    let glb = files([("a/b.GLB", Gltf::triangle().glb())]);
    for (files, path) in [(gltf(), "room/test.gltf"), (obj(), "test.obj"), (glb, "a/b.GLB")] {
        let loaded = load_from_memory(&files, path).unwrap();
        assert_warnings(&loaded, &[]);
        assert_eq!(format!("{loaded:?}"), on_disk(&files, path), "{path}");
    }
}

#[test]
fn files_whose_folders_are_not_told_are_found_by_name() {
    for (files, path) in [(gltf(), "room/test.gltf"), (obj(), "test.obj")] {
        let expected = on_disk(&files, path);
        let name = Path::new(path).file_name().unwrap();
        assert_eq!(format!("{:?}", load_from_memory(&flat(files), name).unwrap()), expected, "{path}");
    }
}

#[test]
fn a_file_in_its_folder_comes_before_one_of_the_same_name() {
    let mut files = gltf();
    files.insert("room/triangle.bin".into(), Vec::new());
    assert!(load_from_memory(&files, "room/test.gltf").is_ok());
}

#[test]
fn what_was_not_given_is_named() {
    let missing = "not among the files that were given";
    assert_error(load_from_memory(&Files::new(), "test.obj"), "test.obj", "file", missing);
    let mut files = gltf();
    files.remove(Path::new("room/images/on wood.png"));
    let loaded = load_from_memory(&files, "room/test.gltf").unwrap();
    assert_warnings(&loaded, &[("images[0]", missing)]);
    files.remove(Path::new("room/data/triangle.bin"));
    assert_error(load_from_memory(&files, "room/test.gltf"), "room/test.gltf", "buffers[0]", "data/triangle.bin");
    assert_error(load_from_memory(&files, "room/test.fbx"), "test.fbx", "file name", ".gltf, .glb, .obj");
}

#[test]
fn what_is_not_in_the_folder_of_the_scene_is_not_read() {
    for uri in ["../secret.bin", "/secret.bin", "a/../../secret.bin", "http://localhost/secret.bin"] {
        let mut gltf = Gltf::triangle();
        gltf.json["buffers"] = json!([{"byteLength": gltf.bytes.len(), "uri": uri}]);
        let mut files = files([("scene/test.gltf", gltf.text().into()), ("secret.bin", gltf.bytes.clone())]);
        assert_error(load_from_memory(&files, "scene/test.gltf"), "test.gltf", "buffers[0]", "not within the folder");
        // A file of that name in the folder stands for a path of another machine, and never for a network address.
        files.insert("scene/secret.bin".into(), gltf.bytes);
        match load_from_memory(&files, "scene/test.gltf") {
            Ok(loaded) => assert_warnings(&loaded, &[("buffers[0]", "\"secret.bin\" is read instead")]),
            error => assert!(uri.starts_with("http") && error.is_err(), "{uri}"),
        }
    }
}
