//! What a scene file may refer to.

use asvgf::scene::load;
use serde_json::json;

use crate::common::*;

/// A folder with a readable file outside of the folder of the scene.
fn nested() -> (Folder, Gltf) {
    let folder = Folder::new();
    let gltf = Gltf::triangle();
    folder.write("secret.bin", &gltf.bytes);
    folder.write("scene/inside.bin", &gltf.bytes);
    folder.write("scene/below/inside.bin", &gltf.bytes);
    (folder, gltf)
}

fn load_with(folder: &Folder, gltf: &Gltf, uri: &str) -> Result<asvgf::scene::Loaded, asvgf::scene::SceneError> {
    let mut gltf = gltf.clone();
    gltf.json["buffers"] = json!([{"byteLength": gltf.bytes.len(), "uri": uri}]);
    load(folder.write("scene/test.gltf", gltf.text()))
}

#[test]
fn files_in_the_folder_and_below_are_read() {
    let (folder, gltf) = nested();
    for uri in
        ["inside.bin", "./inside.bin", "below/inside.bin", "below/../inside.bin", "below%2Finside.bin", "%69nside.bin"]
    {
        assert!(load_with(&folder, &gltf, uri).is_ok(), "{uri}");
    }
}

#[test]
fn nothing_else_is_read() {
    let (folder, gltf) = nested();
    let absolute = folder.0.join("secret.bin").display().to_string();
    let inside = folder.0.join("scene/inside.bin").display().to_string();
    let file_url = format!("file://{absolute}");
    for uri in [
        "../secret.bin",
        "%2E%2E/secret.bin",
        "..%2fsecret.bin",
        "below/../../secret.bin",
        "./../scene/../secret.bin",
        "../scene/inside.bin",
        &absolute,
        &inside,
        &file_url,
        "http://localhost/secret.bin",
        "HTTPS:secret.bin",
        "c:/secret.bin",
        "\\\\server\\secret.bin",
        "//server/secret.bin",
        "inside.bin%00",
    ] {
        assert_error(load_with(&folder, &gltf, uri), "test.gltf", "buffers[0]", "not within the folder");
    }
}

#[cfg(unix)]
#[test]
fn links_that_lead_out_are_not_followed() {
    let (folder, gltf) = nested();
    std::os::unix::fs::symlink(folder.0.join("secret.bin"), folder.0.join("scene/link.bin")).unwrap();
    std::os::unix::fs::symlink(&folder.0, folder.0.join("scene/up")).unwrap();
    std::os::unix::fs::symlink("inside.bin", folder.0.join("scene/fine.bin")).unwrap();
    assert_error(load_with(&folder, &gltf, "link.bin"), "test.gltf", "buffers[0]", "not within the folder");
    assert_error(load_with(&folder, &gltf, "up/secret.bin"), "test.gltf", "buffers[0]", "not within the folder");
    assert!(load_with(&folder, &gltf, "fine.bin").is_ok());
}

#[test]
fn unknown_extensions_are_refused_with_a_list() {
    for name in ["scene.fbx", "scene", ".gltf"] {
        assert_error(load(name), name, "file name", ".gltf, .glb, .obj");
    }
}
