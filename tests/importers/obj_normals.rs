//! OBJ files: given normals, and those that the reader has to compute.

use std::f32::consts::TAU;
use std::fmt::Write as _;

use asvgf::scene::{Loaded, Mesh};
use glam::Vec3;

use crate::common::*;
use crate::obj::{SQUARE, read};

/// The side of a cylinder of radius 1 around y, between two caps. `side` writes its faces from the numbers of four corners.
fn cylinder(sides: usize, smoothing: &str, side: impl Fn([usize; 4]) -> String) -> Loaded {
    let mut text = String::new();
    for i in 0..sides {
        let (sin, cos) = (i as f32 / sides as f32 * TAU).sin_cos();
        writeln!(text, "v {sin} -1 {cos}\nv {sin} 1 {cos}").unwrap();
    }
    writeln!(text, "{smoothing}").unwrap();
    for i in 0..sides {
        let [low, next] = [2 * i + 1, 2 * ((i + 1) % sides) + 1];
        text += &side([low, next, next + 1, low + 1]);
    }
    read(text, "").unwrap()
}

fn quad([a, b, c, d]: [usize; 4]) -> String {
    format!("f {a} {b} {c} {d}\n")
}

fn triangles([a, b, c, d]: [usize; 4]) -> String {
    format!("f {a} {b} {c}\nf {a} {c} {d}\n")
}

/// Asserts that the normal of each vertex is `expected` of its position.
#[track_caller]
fn assert_normals(loaded: &Loaded, expected: impl Fn(Vec3) -> Vec3) {
    assert_warnings(loaded, &[]);
    for mesh in &loaded.scene.meshes {
        assert_eq!(mesh.normals.len(), mesh.positions.len());
        for (&position, &normal) in std::iter::zip(&mesh.positions, &mesh.normals) {
            let expected = expected(position.into());
            assert!(Vec3::from(normal).distance(expected) < 1e-5, "{normal:?} at {position:?}, not {expected}");
        }
    }
}

#[test]
fn smoothing_groups_make_round_what_is_round() {
    let radial = |position: Vec3| Vec3::new(position.x, 0.0, position.z).normalize();
    for sides in [5, 8, 64] {
        for group in ["s 1", "s on", "S 7", "s 4294967296", "s 99999999999999999999"] {
            // The normals do not depend on the triangulation of the sides.
            assert_normals(&cylinder(sides, group, quad), radial);
            assert_normals(&cylinder(sides, group, triangles), radial);
        }
        assert_eq!(cylinder(sides, "s 1", quad).scene.meshes[0].positions.len(), 2 * sides, "vertices are shared");
    }
}

#[test]
fn without_a_group_faces_are_flat() {
    for group in ["", "s off", "s 0", "s", "s 1\ns off"] {
        let loaded = cylinder(8, group, quad);
        assert_warnings(&loaded, &[]);
        assert!(loaded.scene.meshes.iter().all(|mesh| mesh.normals.is_empty()), "{group}");
    }
}

#[test]
fn groups_and_sharp_angles_split() {
    // Two quads meet at 45°.
    let bend = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 1\nv 2 1 1\n";
    let [left, right] = ["f 1 2 3 4\n", "f 2 5 6 3\n"];
    let along =
        |at: f32| move |position: Vec3| if position.x < at { Vec3::Z } else { Vec3::new(-1.0, 0.0, 1.0).normalize() };
    let split = read(format!("{bend}s 1\n{left}s 2\n{right}"), "").unwrap();
    assert_eq!(split.scene.meshes[0].positions.len(), 8);
    let normals = |mesh: &Mesh| mesh.normals.clone();
    assert_eq!(normals(&split.scene.meshes[0])[..4], [[0.0, 0.0, 1.0]; 4]);
    let joined = read(format!("{bend}s 1\n{left}{right}"), "").unwrap();
    let middle = (Vec3::Z + Vec3::new(-1.0, 0.0, 1.0).normalize()).normalize();
    assert_normals(&joined, |position| if position.x == 1.0 { middle } else { along(1.5)(position) });
    // Materials and names do not split a smoothing group.
    let parted = read(format!("{bend}s 1\no a\n{left}o b\n{right}"), "").unwrap();
    assert_eq!(parted.scene.meshes.len(), 2);
    assert_normals(&parted, |position| if position.x == 1.0 { middle } else { along(1.5)(position) });

    // A cube in one group keeps its edges.
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\ns 1\n\
                f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n";
    let cube = read(cube, "").unwrap();
    assert_eq!(cube.scene.meshes[0].positions.len(), 24);
    for &triangle in &cube.scene.meshes[0].triangles {
        let mesh = &cube.scene.meshes[0];
        let [a, b, c] = triangle.map(|corner| Vec3::from(mesh.positions[corner as usize]));
        let flat = (b - a).cross(c - a).normalize();
        assert!(triangle.iter().all(|&corner| Vec3::from(mesh.normals[corner as usize]).distance(flat) < 1e-6));
    }
}

#[test]
fn given_normals_stay() {
    let text = format!("{SQUARE}vn 0 3 4\ns 1\nf 1//1 2//1 3//1\nf 1 3 4\ns off\nf 1 2 4\n");
    let loaded = read(text, "").unwrap();
    assert_warnings(&loaded, &[]);
    let [with, without] = &loaded.scene.meshes[..] else { panic!("{:?}", loaded.scene.meshes) };
    assert_close(with.normals[..3].as_flattened(), &[0.0, 0.6, 0.8, 0.0, 0.6, 0.8, 0.0, 0.6, 0.8], 1e-6);
    assert_eq!(with.normals[3..], [[0.0, 0.0, 1.0]; 3], "the smooth one of the face without");
    assert!(without.normals.is_empty());
}

#[test]
fn normals_that_cannot_be_read() {
    for broken in ["nan 0 0", "-nan(ind) 0 0", "1.#QNAN 0 0", "0 0 0", "0 inf 0", "1e99 0 0", "0 0", "", "x y z"] {
        let text = format!("{SQUARE}vn 0 1 0\nvn {broken}\nvn {broken}\nf 1//1 2//2 3//3 4//1\n");
        let loaded = read(text, "").unwrap();
        assert_warnings(&loaded, &[("line 6", "the normal of the faces is used (2 normals like this)")]);
        let mut normals = loaded.scene.meshes[0].normals.clone();
        normals.sort_by(|a, b| a.partial_cmp(b).unwrap());
        normals.dedup();
        assert_eq!(normals, [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]], "{broken}");
    }
    // In a smoothing group, the surrounding faces determine the normal.
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 1\nv 2 1 1\nvn 0 0 0\ns 1\n\
                f 1//1 2//1 3//1 4//1\nf 2//1 5//1 6//1 3//1\n";
    let mesh = &read(text, "").unwrap().scene.meshes[0];
    let middle = (Vec3::Z + Vec3::new(-1.0, 0.0, 1.0).normalize()).normalize();
    assert_close(&mesh.normals[1], &middle.to_array(), 1e-6);
    // Long normals do not overflow.
    let loaded = read(format!("{SQUARE}vn 0 3e38 0\nf 1//1 2//1 3//1\n"), "").unwrap();
    assert_warnings(&loaded, &[]);
    assert_eq!(loaded.scene.meshes[0].normals[0], [0.0, 1.0, 0.0]);
}

/// A cone with so many sides that comparing each pair of faces at the apex would take too long.
#[test]
fn very_many_faces_at_one_vertex() {
    const SIDES: usize = 200_000;
    let mut text = String::from("v 0 1 0\n");
    for i in 0..SIDES {
        let (sin, cos) = (i as f32 / SIDES as f32 * TAU).sin_cos();
        writeln!(text, "v {cos} 0 {sin}").unwrap();
    }
    text += "s 1\n";
    (0..SIDES).for_each(|i| writeln!(text, "f 1 {} {}", 2 + (i + 1) % SIDES, 2 + i).unwrap());
    let start = std::time::Instant::now();
    let loaded = read(text, "").unwrap();
    assert!(start.elapsed() < std::time::Duration::from_secs(20), "{:?}", start.elapsed());
    let mesh = &loaded.scene.meshes[0];
    let apex = mesh.positions.iter().position(|&position| position == [0.0, 1.0, 0.0]).unwrap();
    assert_close(&mesh.normals[apex], &[0.0, 1.0, 0.0], 1e-3);
}
