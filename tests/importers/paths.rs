//! Paths that a scene file may refer to.

use asvgf::scene::load;
use serde_json::json;

use crate::common::*;

/// A scene in a folder, with a readable file outside it.
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
    let file_url = format!("file://{absolute}");
    for uri in [
        "../secret.bin",
        "%2E%2E/secret.bin",
        "..%2fsecret.bin",
        "below/../../secret.bin",
        "./../scene/../secret.bin",
        &absolute,
        &file_url,
        "http://localhost/secret.bin",
        "HTTPS:secret.bin",
        "c:/secret.bin",
        "\\\\server\\secret.bin",
        "//server/secret.bin",
        "inside.bin%00",
        "http://localhost/inside.bin",
        "https:inside.bin",
    ] {
        assert_error(load_with(&folder, &gltf, uri), "test.gltf", "buffers[0]", "not within the folder");
    }
}

/// A path of another machine stands for the file in the folder that matches its longest end.
#[test]
fn paths_of_other_machines_are_looked_for_in_the_folder() {
    let (folder, gltf) = nested();
    folder.write("scene/below/Deep Er/only.bin", &gltf.bytes);
    folder.write("scene/a/twice.bin", &gltf.bytes);
    folder.write("scene/b/twice.bin", &gltf.bytes);
    let inside = folder.0.join("scene/inside.bin").display().to_string();
    for (uri, found) in [
        ("../scene/inside.bin", "inside.bin"),
        (&*inside, "inside.bin"),
        ("c:/users/me/below/inside.bin", "below/inside.bin"),
        ("C:\\inside.bin", "inside.bin"),
        ("\\\\server\\share\\inside.bin", "inside.bin"),
        ("file:///C:/inside.bin", "inside.bin"),
        ("file:///home/me/only.bin", "below/Deep Er/only.bin"),
        ("..%5Cbelow%5Cinside.bin", "below/inside.bin"),
        ("textures/inside.bin", "inside.bin"),
        ("Inside.BIN", "inside.bin"),
        ("\"inside.bin\"", "inside.bin"),
        ("DEEP ER/ONLY.bin", "below/Deep Er/only.bin"),
        ("x/b/twice.bin", "b/twice.bin"),
        ("twice.bin", "a/twice.bin"),
    ] {
        let loaded = load_with(&folder, &gltf, uri).unwrap_or_else(|error| panic!("{error}"));
        assert_warnings(&loaded, &[("buffers[0]", &format!("; \"{found}\" is read instead"))]);
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
    assert_error(load_with(&folder, &gltf, "x/link.bin"), "test.gltf", "buffers[0]", "cannot be read");
    let linked = load_with(&folder, &gltf, "x/fine.bin").unwrap();
    assert_warnings(&linked, &[("buffers[0]", "\"fine.bin\" is read instead")]);
}

#[test]
fn unknown_extensions_are_refused_with_a_list() {
    for name in ["scene.fbx", "scene", ".gltf"] {
        assert_error(load(name), name, "file name", ".gltf, .glb, .obj");
    }
}
