//! OBJ and MTL files.

use asvgf::scene::{Alpha, Loaded, Scene, SceneError, Wrap, load};

use crate::common::*;

fn read(obj: &str, mtl: &str) -> Result<Loaded, SceneError> {
    let folder = Folder::new();
    folder.write("test.mtl", mtl);
    load(folder.write("test.obj", obj))
}

/// A triangle with a material.
fn material(mtl: &str) -> Loaded {
    read("mtllib test.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n", &format!("newmtl m\n{mtl}")).unwrap()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// Positions of the corners of all triangles.
fn corners(scene: &Scene) -> Vec<[f32; 3]> {
    let corners = |mesh: &asvgf::scene::Mesh| {
        mesh.triangles.as_flattened().iter().map(|&corner| mesh.positions[corner as usize]).collect::<Vec<_>>()
    };
    scene.meshes.iter().flat_map(corners).collect()
}

#[test]
fn polygons_are_triangulated() {
    let loaded = read(&format!("{SQUARE}f 1 2 3 4\nf 1 2 3\n"), "").unwrap();
    assert_warnings(&loaded, &[]);
    assert_eq!(loaded.scene.triangle_count(), 3);
    assert_eq!(area(&loaded), 1.5);
    let pentagon = read(&format!("{SQUARE}v -0.5 0.5 0\nf 1 2 3 4 5\n"), "").unwrap();
    assert_eq!((pentagon.scene.triangle_count(), area(&pentagon)), (3, 1.25));
    let material = &pentagon.scene.materials[pentagon.scene.meshes[0].material];
    assert_eq!((material.base_color, material.metallic, material.specular), ([0.8, 0.8, 0.8, 1.0], 0.0, [0.0; 3]));
    assert!(material.double_sided);
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
    // An attribute that is not at every corner of a face does not count for it.
    assert_eq!(kinds, [(1, false, false), (2, false, true), (2, true, false)]);
    loaded.scene.validate().unwrap();
}

#[test]
fn switching_materials_often_does_not_multiply_meshes() {
    let faces = "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n".repeat(50);
    let loaded = read(&format!("mtllib test.mtl\n{SQUARE}o thing\n{faces}"), "newmtl a\nnewmtl b\n").unwrap();
    assert_eq!(loaded.scene.meshes.len(), 2);
    assert_eq!(loaded.scene.triangle_count(), 100);
}

#[test]
fn untidy_text() {
    let text = "\u{FEFF}# comment\r\n\tv\t0 0\t0 # note\r\n  v 1 0 0 1.0\r\nv 0 1 0 0.5 0.5 0.5\r\nmtllib\ttest.mtl\r\n\
                usemtl\ta b#1  # name\r\ns off\r\nvp 1 2\r\nf 1 \\\r\n 2 \\\r\n 3\r\nl 1 2\r\np 1\r\nunknown words\r\n\\";
    let loaded = read(text, "newmtl a b#1\n\tKd\t0.5\n").unwrap();
    assert_warnings(&loaded, &[("line 4", "vertex colours"), ("line 12", "points and lines")]);
    let scene = &loaded.scene;
    assert_eq!(scene.materials[scene.meshes[0].material].name, "a b#1");
    assert_eq!(scene.materials[0].base_color, [0.5, 0.5, 0.5, 1.0]);
    assert_eq!(area(&loaded), 0.5);
}

#[test]
fn text_that_is_not_utf_8() {
    let folder = Folder::new();
    let text = [b"# caf\xE9\no caf\xE9\n", SQUARE.as_bytes(), b"f 1 2 3 4\n"].concat();
    assert_eq!(area(&load(folder.write("latin.obj", text)).unwrap()), 1.0);
}

#[test]
fn faces_that_are_wrong() {
    let face = |face: &str, reason: &str| {
        let text = format!("{SQUARE}vt 0 0\nvn 0 0 1\nf {face}\n");
        assert_error(read(&text, ""), "test.obj", "line 7", reason);
    };
    face("1 2 5", "index 5 is out of range: there are 4 vertices");
    face("1 2 -5", "index -5 is out of range");
    face("0 1 2", "index 0 is out of range");
    face("1/2 2/1 3/1", "index 2 is out of range: there are 1 texture coordinates");
    face("1/-2 2/1 3/1", "index -2");
    face("1//9 2//1 3//1", "index 9 is out of range: there are 1 normals");
    face("1/1/1/1 2 3", "more than three indices");
    face("1 2", "2 corners");
    face("", "0 corners");
    face("a b c", "\"a\" is not an index");
    face("/1 2 3", "\"/1\" is not an index");
    face("9223372036854775807 1 2", "out of range");
    face("-9223372036854775808 1 2", "out of range");
    face("99999999999999999999 1 2", "not an index");
    assert_error(read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n", ""), "test.obj", "line 1", "there are 0 vertices");
}

#[test]
fn numbers_that_are_wrong() {
    let bad = |text: &str, reason: &str| assert_error(read(text, ""), "test.obj", "line 1", reason);
    bad("v 0 0", "2 numbers, where 3 belong");
    bad("v 0 x 0", "\"x\" is not a number");
    bad("v 0 nan 0", "NaN is not finite");
    bad("v 0 1e99 0", "inf is not finite");
    bad("vt", "0 numbers");
    bad("vn 1", "1 numbers");
    bad("usemtl", "no name");
    assert_error(read("", ""), "test.obj", "file", "empty");
    assert_warnings(&read("v 0 0 0\n", "").unwrap(), &[("file", "no triangles")]);
}

#[test]
fn missing_libraries_and_materials_are_drawn_in_grey() {
    let text = format!("mtllib absent.mtl\n{SQUARE}usemtl red\nf 1 2 3\nf 1 3 4\nusemtl red\nf 1 2 4\n");
    let loaded = read(&text, "").unwrap();
    assert_warnings(&loaded, &[("line 1", "absent.mtl"), ("line 6", "no material \"red\"")]);
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
fn diffuse_glossy_metallic_and_emitting_materials() {
    let diffuse = &material("Kd 0.1 0.2 0.3\nKe 17 12 4\nKs 0 0 0\nNs 10\n").scene.materials[0];
    assert_eq!((diffuse.base_color, diffuse.emissive), ([0.1, 0.2, 0.3, 1.0], [17.0, 12.0, 4.0]));
    assert_eq!((diffuse.metallic, diffuse.specular), (0.0, [0.0; 3]));

    let glossy = &material("Kd 0.5 0.5 0.5\nKs 0.2 0.4 0.1\nNs 30\nillum 2\n").scene.materials[0];
    assert_eq!((glossy.metallic, glossy.specular), (0.0, [0.2, 0.4, 0.1]));
    assert_close(&[glossy.roughness], &[(2.0_f32 / 32.0).powf(0.25)], 1e-6);

    let metal = &material("Kd 0 0 0\nKs 0.725 0.71 0.68\nNs 200\n").scene.materials[0];
    assert_eq!((metal.metallic, metal.base_color), (1.0, [0.725, 0.71, 0.68, 1.0]));

    let matte = &material("Kd 0.5\nKs 0.9 0.9 0.9\nillum 1\n").scene.materials[0];
    assert_eq!(matte.specular, [0.0; 3]);
}

#[test]
fn opacity() {
    let clear = material("d 0.2\n");
    assert_warnings(&clear, &[("test.mtl material \"m\"", "opacity 0.2 is below 0.5")]);
    assert_eq!((clear.scene.materials[0].alpha, clear.scene.materials[0].base_color[3]), (Alpha::Mask(0.5), 0.2));
    let half = material("Tr 0.25\n");
    assert_warnings(&half, &[("m", "0.75 is drawn as 1")]);
    assert_eq!(half.scene.materials[0].alpha, Alpha::Opaque);
    assert_warnings(&material("d -halo 1\n"), &[]);
}

#[test]
fn statements_that_cannot_be_read_are_left_out() {
    let loaded = material(
        "Kd spectral file.rfl\nKs 1 2\nNs\nKe nan 0 0\nmap_Kd\nmap_Ke -what 1 a.png\nbump b.png\nmap_Ks c.png\n",
    );
    assert_warnings(
        &loaded,
        &[
            ("test.mtl line 2", "Kd: \"spectral\" is not a number"),
            ("test.mtl line 3", "Ks: 2 numbers"),
            ("test.mtl line 4", "Ns: there is no number"),
            ("test.mtl line 5", "Ke: NaN"),
            ("test.mtl line 6", "map_Kd: there is no file name"),
            ("test.mtl line 7", "the option -what"),
            ("test.mtl line 8", "bump maps"),
            ("test.mtl line 9", "specular maps"),
        ],
    );
}

#[test]
fn textures_with_options() {
    let folder = Folder::new();
    folder.write("maps/my leaf.png", png(2, 2, [1, 2, 3, 4]));
    folder.write(
        "test.mtl",
        "newmtl m\nmap_Kd -s 2 3 1 -o 0.5 0.25 -clamp on -bm 1 -mm 0 1 maps\\my leaf.png\nmap_d maps/my leaf.png\n\
         map_Ke maps/my leaf.png\nnewmtl n\nmap_Kd absent.png\n",
    );
    let text = "mtllib test.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n";
    let loaded = load(folder.write("test.obj", text)).unwrap();
    assert_warnings(&loaded, &[("material \"n\"", "absent.png")]);
    let material = &loaded.scene.materials[0];
    let texture = material.base_color_texture.unwrap();
    assert_eq!(loaded.scene.images.len(), 1);
    assert_eq!(loaded.scene.images[texture.image].texels, [[1, 2, 3, 4]; 4]);
    assert_eq!((texture.wrap, material.alpha), ([Wrap::Clamp; 2], Alpha::Mask(0.5)));
    assert_eq!((material.base_color, material.emissive), ([1.0; 4], [1.0; 3]));
    // (u, v) = (0.1, 0.2) with v upwards is (0.1, 0.8) here; it maps to (0.7, 0.85) upwards.
    let at = texture.transform.map(|row| row[0] * 0.1 + row[1] * 0.8 + row[2]);
    assert_close(&at, &[0.7, 0.15], 1e-6);
    assert_eq!(loaded.scene.materials[1].base_color_texture, None);
}
