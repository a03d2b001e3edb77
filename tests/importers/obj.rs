//! OBJ files: objects, indices, materials by name. The rest is in `obj_faces`, `obj_normals`, `obj_text`, `obj_colors`,
//! `obj_materials`, `obj_maps` and `obj_broken`.

use asvgf::scene::{Loaded, Mesh, Scene, SceneError, load};

use crate::common::*;

/// Reads an OBJ file with `test.mtl` beside it.
pub fn read(obj: impl AsRef<[u8]>, mtl: impl AsRef<[u8]>) -> Result<Loaded, SceneError> {
    let folder = Folder::new();
    folder.write("test.mtl", mtl);
    load(folder.write("test.obj", obj))
}

/// Loads a triangle with a material.
pub fn material(mtl: &str) -> Loaded {
    read("mtllib test.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n", format!("newmtl m\n{mtl}")).unwrap()
}

pub const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// Positions of the corners of all triangles.
pub fn corners(scene: &Scene) -> Vec<[f32; 3]> {
    let corners = |mesh: &Mesh| {
        mesh.triangles.as_flattened().iter().map(|&corner| mesh.positions[corner as usize]).collect::<Vec<_>>()
    };
    scene.meshes.iter().flat_map(corners).collect()
}

#[test]
fn negative_indices_count_back_from_where_they_stand() {
    let text = format!("{SQUARE}f -4 -3 -2 -1\ng second\nv 0 0 5\nv 1 0 5\nv 0 1 5\nf -3 -2 -1\n");
    let loaded = read(&text, "").unwrap();
    assert_eq!(corners(&loaded.scene)[6..], [[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [0.0, 1.0, 5.0]]);
    assert_eq!(loaded.scene.meshes[1].name, "second");
}

#[test]
fn texture_coordinates_and_normals() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0.25 0\nvt 0.5\nvn 0 0 1\nf 1/1/1 2/2/1 3/-1/-1\n";
    let mesh = &read(text, "").unwrap().scene.meshes[0];
    assert_eq!(mesh.uvs[0], [[0.0, 1.0], [1.0, 0.75], [0.5, 1.0]], "v grows downwards here");
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]; 3]);
}

#[test]
fn faces_with_and_without_attributes_may_mix() {
    let text = format!(
        "{SQUARE}vt 0 0\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1 2 3\nf 1/1 2/1 3/1\nf 1/1/1 2/1 3/1/1\nf 2//1 3//1 4//1\n"
    );
    let loaded = read(&text, "").unwrap();
    let mut kinds: Vec<_> = loaded
        .scene
        .meshes
        .iter()
        .map(|mesh| (mesh.triangles.len(), !mesh.normals.is_empty(), !mesh.uvs[0].is_empty()))
        .collect();
    kinds.sort();
    // A face ignores an attribute that is missing at some of its corners.
    assert_warnings(&loaded, &[("line 10", "only some corners have texture coordinates or normals")]);
    assert_eq!(kinds, [(1, false, false), (2, false, true), (2, true, false)]);
    loaded.scene.validate().unwrap();
}

#[test]
fn switching_materials_often_does_not_multiply_meshes() {
    let faces = "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n".repeat(50);
    let loaded = read(format!("mtllib test.mtl\n{SQUARE}o thing\n{faces}"), "newmtl a\nnewmtl b\n").unwrap();
    assert_eq!(loaded.scene.meshes.len(), 2);
    assert_eq!(loaded.scene.triangle_count(), 100);
}

#[test]
fn missing_libraries_and_materials_are_drawn_in_grey() {
    let text = format!("mtllib absent.mtl\n{SQUARE}usemtl red\nf 1 2 3\nf 1 3 4\nusemtl red\nf 1 2 4\n");
    let loaded = read(&text, "").unwrap();
    assert_warnings(&loaded, &[("line 1", "absent.mtl")]);
    assert_eq!(loaded.scene.meshes.len(), 1);
    assert_eq!(loaded.scene.materials[0].base_color, [0.8, 0.8, 0.8, 1.0]);
}

#[test]
fn libraries_and_textures_stay_in_the_folder() {
    let folder = Folder::new();
    folder.write("secret.mtl", "newmtl m\nKd 1 0 0\n");
    folder.write("scene/own.mtl", "newmtl m\nKd 0 1 0\nmap_Kd ../secret.png\n");
    folder.write("secret.png", png(1, 1, [1; 4]));
    let text = format!("mtllib ../secret.mtl\nmtllib own.mtl\n{SQUARE}usemtl m\nf 1 2 3\n");
    let loaded = load(folder.write("scene/test.obj", text)).unwrap();
    assert_warnings(
        &loaded,
        &[("line 1", "not within the folder"), ("own.mtl material \"m\"", "not within the folder")],
    );
    assert_eq!(loaded.scene.materials[0].base_color, [0.0, 1.0, 0.0, 1.0]);
}

#[test]
fn several_libraries_in_one_statement_and_names_with_spaces() {
    let folder = Folder::new();
    folder.write("a.mtl", "newmtl a\n");
    folder.write("b.mtl", "newmtl b\n");
    folder.write("my lib.mtl", "newmtl c\n");
    let faces = "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n";
    let text = format!("mtllib a.mtl b.mtl\nmtllib my lib.mtl\n{SQUARE}{faces}");
    let loaded = load(folder.write("test.obj", text)).unwrap();
    assert_warnings(&loaded, &[]);
    assert_eq!(
        loaded.scene.materials.iter().map(|material| material.name.as_str()).collect::<Vec<_>>(),
        ["a", "b", "c"]
    );
}

#[test]
fn names_of_libraries_in_quotes_or_twice() {
    let folder = Folder::new();
    folder.write("my lib.mtl", "newmtl a\n");
    folder.write("b.mtl", "newmtl b\n");
    let faces = "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n";
    let text = |libraries: &str| format!("{libraries}\n{SQUARE}{faces}");
    let twice = load(folder.write("test.obj", text("mtllib my lib.mtl\nmtllib b.mtl b.mtl\nmtllib ./b.mtl"))).unwrap();
    assert_warnings(&twice, &[]);
    assert_eq!(twice.scene.materials.len(), 2);
    let quoted = load(folder.write("test.obj", text("mtllib \"my lib.mtl\"\nmtllib 'b.mtl'"))).unwrap();
    assert_warnings(&quoted, &[("line 1", "\"my lib.mtl\" is read"), ("line 2", "\"b.mtl\" is read")]);
    let list = load(folder.write("test.obj", text("mtllib \"my lib.mtl\" \"b.mtl\""))).unwrap();
    assert_warnings(&list, &[]);
    // The existing files of a list are read.
    let partly = load(folder.write("test.obj", text("mtllib b.mtl absent.mtl"))).unwrap();
    assert_warnings(&partly, &[("line 1", "absent.mtl")]);
}

/// Faces after an empty `usemtl` get the default material, and not the previous one.
#[test]
fn materials_end_where_another_starts() {
    let loaded =
        read(format!("mtllib test.mtl\n{SQUARE}f 1 2 3\nusemtl m\nf 1 3 4\n"), "newmtl m\nKd 1 0 0\n").unwrap();
    assert_warnings(&loaded, &[]);
    let colors: Vec<_> =
        loaded.scene.meshes.iter().map(|mesh| loaded.scene.materials[mesh.material].base_color[0]).collect();
    assert_eq!(colors, [0.8, 1.0]);
}
