//! OBJ files: colours of vertices.

use crate::common::*;
use crate::obj::read;

/// The linear value of an sRGB value.
fn linear(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

fn triangle(colors: [&str; 3]) -> String {
    let [a, b, c] = colors;
    format!("v 0 0 0 {a}\nv 1 0 0 {b}\nv 0 1 0 {c}\nf 1 2 3\n")
}

#[test]
fn colors_are_srgb_and_seen_as_they_are() {
    let loaded = read(triangle(["1 0 0", "0.5 0.25 0.125", "0 0.02 1 0.5"]), "").unwrap();
    assert_warnings(&loaded, &[("object \"\"", "the opacity of vertex colours")]);
    let mesh = &loaded.scene.meshes[0];
    assert_eq!(mesh.colors[0], [1.0, 0.0, 0.0, 1.0]);
    assert_close(&mesh.colors[1], &[linear(0.5), linear(0.25), linear(0.125), 1.0], 1e-6);
    assert_close(&mesh.colors[2], &[0.0, 0.02 / 12.92, 1.0, 0.5], 1e-6);
    // Without a material, white replaces grey.
    assert_eq!(loaded.scene.materials[mesh.material].base_color, [1.0; 4]);
}

#[test]
fn a_material_stays_and_vertices_without_colour_are_white() {
    let text = format!("mtllib test.mtl\nusemtl m\n{}v 2 0 0\nv 2 1 0\nv 3 0 0\n", triangle(["1 0 0", "", "0 1 0"]));
    let loaded = read(format!("{text}o b\nf 4 6 5\n"), "newmtl m\nKd 0.5 0.5 0.5\n").unwrap();
    assert_warnings(&loaded, &[]);
    assert_eq!(loaded.scene.meshes[0].colors, [[1.0, 0.0, 0.0, 1.0], [1.0; 4], [0.0, 1.0, 0.0, 1.0]]);
    assert!(loaded.scene.meshes[1].colors.is_empty());
    assert_eq!(loaded.scene.materials[loaded.scene.meshes[0].material].base_color, [0.5, 0.5, 0.5, 1.0]);
}

#[test]
fn bytes_and_what_is_out_of_range() {
    let loaded = read(triangle(["255 0 0", "51 102 0", "0 0 255"]), "").unwrap();
    assert_warnings(&loaded, &[("vertex colours", "their largest number is 255; all are taken as 0…255")]);
    assert_close(&loaded.scene.meshes[0].colors[1], &[linear(0.2), linear(0.4), 0.0, 1.0], 1e-6);

    let loaded = read(triangle(["1.5 0 0", "-1 0.5 0", "1.00001 0 0"]), "").unwrap();
    assert_warnings(&loaded, &[("vertex colours", "2 are outside 0…1")]);
    assert_close(&loaded.scene.meshes[0].colors[1], &[0.0, linear(0.5), 0.0, 1.0], 1e-6);
}

#[test]
fn colors_that_cannot_be_read_are_white() {
    for broken in ["nan 0 0", "1 0", "x 0 0", "1 2 3 4 5"] {
        let loaded = read(triangle(["1 0 0", broken, "1 0 0"]), "").unwrap();
        assert_warnings(&loaded, &[("line 2", "white is used")]);
        assert_eq!(loaded.scene.meshes[0].colors[1], [1.0; 4], "{broken}");
        assert_eq!(area(&loaded), 0.5);
    }
    // A fourth number is a weight, not a colour.
    assert!(read(triangle(["1", "1", "0.5"]), "").unwrap().scene.meshes[0].colors.is_empty());
}

#[test]
fn comments_of_zbrush() {
    let loaded = read("v 0 0 0\nv 1 0 0\nv 0 1 0\n#MRGB ff3366ccFF000000\n#MRGB ffffffff\nf 1 2 3\n", "").unwrap();
    assert_warnings(&loaded, &[]);
    let colors = &loaded.scene.meshes[0].colors;
    assert_close(&colors[0], &[linear(0.2), linear(0.4), linear(0.8), 1.0], 1e-6);
    assert_eq!(colors[1..], [[0.0, 0.0, 0.0, 1.0], [1.0; 4]]);
}
