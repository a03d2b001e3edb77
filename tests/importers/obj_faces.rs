//! OBJ files: polygons, and broken faces.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use asvgf::scene::{Loaded, Scene};
use glam::{DVec3, Quat, Vec3};

use crate::common::*;
use crate::obj::{SQUARE, corners, read};

#[test]
fn polygons_are_triangulated() {
    let loaded = read(format!("{SQUARE}f 1 2 3 4\nf 1 2 3\n"), "").unwrap();
    assert_warnings(&loaded, &[]);
    assert_eq!(loaded.scene.triangle_count(), 3);
    assert_eq!(area(&loaded), 1.5);
    let pentagon = read(format!("{SQUARE}v -0.5 0.5 0\nf 1 2 3 4 5\n"), "").unwrap();
    assert_eq!((pentagon.scene.triangle_count(), area(&pentagon)), (3, 1.25));
    let material = &pentagon.scene.materials[pentagon.scene.meshes[0].material];
    assert_eq!((material.base_color, material.metallic, material.specular), ([0.8, 0.8, 0.8, 1.0], 0.0, [0.0; 3]));
    assert!(material.double_sided);
}

/// An arrow head whose third corner is concave.
const DART: &[[f32; 2]] = &[[0.0, -0.8], [0.8, 0.8], [0.0, 0.0], [-0.8, 0.8]];
/// A rectangle with a notch.
const C: &[[f32; 2]] =
    &[[0.0, 0.0], [1.0, 0.0], [1.0, 0.75], [0.2, 0.75], [0.2, 1.25], [1.0, 1.25], [1.0, 2.0], [0.0, 2.0]];

/// Loads one polygon, with each corner mapped.
fn polygon(ring: &[[f32; 2]], place: impl Fn(Vec3) -> Vec3) -> Loaded {
    let mut text = String::new();
    for &[x, y] in ring {
        let Vec3 { x, y, z } = place(Vec3::new(x, y, 0.0));
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    text.push('f');
    (1..=ring.len()).for_each(|corner| write!(text, " {corner}").unwrap());
    read(text, "").unwrap()
}

/// The vector areas of all triangles.
fn areas(scene: &Scene) -> Vec<DVec3> {
    let triangle = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a) / 2.0;
    let corner = |corner: [f32; 3]| Vec3::from(corner).as_dvec3();
    corners(scene).as_chunks::<3>().0.iter().map(|corners| triangle(corners.map(corner))).collect()
}

#[test]
fn concave_polygons_from_any_corner_in_any_plane() {
    let tilts = [Quat::IDENTITY, Quat::from_rotation_x(1.0), Quat::from_rotation_y(-2.0), Quat::from_rotation_x(3.0)];
    let tilts = tilts.into_iter().chain([Quat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -2.5)]);
    for (tilt, (ring, expected)) in tilts.flat_map(|tilt| [(DART, 0.64), (C, 1.6)].map(|ring| (tilt, ring))) {
        for first in 0..ring.len() {
            for reversed in [false, true] {
                let mut ring = [&ring[first..], &ring[..first]].concat();
                if reversed {
                    ring.reverse();
                }
                let front = tilt * Vec3::Z * if reversed { -1.0 } else { 1.0 };
                for (scale, offset) in [(1.0, 0.0), (1.0, 1000.0), (1e-12, 0.0), (1e9, 1e9)] {
                    let loaded = polygon(&ring, |corner| tilt * corner * scale + Vec3::new(1.0, -1.0, 0.5) * offset);
                    assert_warnings(&loaded, &[]);
                    assert_eq!(loaded.scene.triangle_count(), ring.len() - 2);
                    let areas = areas(&loaded.scene);
                    let unit = f64::from(scale).powi(2);
                    let area = (areas.iter().sum::<DVec3>() / unit).as_vec3();
                    let whole = (areas.iter().map(|area| area.length()).sum::<f64>() / unit) as f32;
                    let message = format!("{ring:?} {tilt} {scale} {offset}");
                    assert!((whole - expected).abs() < 1e-3, "{message}: {whole}");
                    assert!((area - front * expected).length() < 1e-3, "{message}: {area}");
                }
            }
        }
    }
}

#[test]
fn repeated_corners_count_once() {
    let loaded = read(format!("{SQUARE}v 1 1 0\nf 1 2 3 3 5 4 4 1\n"), "").unwrap();
    assert_warnings(&loaded, &[]);
    assert_eq!((loaded.scene.triangle_count(), area(&loaded)), (2, 1.0));
    let triangle = read(format!("{SQUARE}f 1 2 3 1\n"), "").unwrap();
    assert_eq!((triangle.scene.triangle_count(), area(&triangle)), (1, 0.5));
}

/// A neighbour may have a vertex at such a corner: an edge without it would have a crack.
#[test]
fn corners_on_an_edge_are_kept() {
    let ring = [[0.0, 0.0], [0.25, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 0.5], [1.0, 1.0], [0.0, 1.0]];
    for first in 0..ring.len() {
        let loaded = polygon(&[&ring[first..], &ring[..first]].concat(), |corner| corner);
        assert_warnings(&loaded, &[]);
        assert_eq!((loaded.scene.triangle_count(), area(&loaded)), (5, 1.0));
        assert_eq!(loaded.scene.meshes[0].positions.len(), 7);
    }
    // The quad has a corner on an edge.
    let loaded = polygon(&[[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [0.0, 1.0]], |corner| corner);
    assert_eq!((loaded.scene.triangle_count(), area(&loaded)), (2, 0.5));
    assert!(areas(&loaded.scene).iter().all(|area| area.z == 0.25), "{:?}", areas(&loaded.scene));
}

#[test]
fn quads_are_split_along_the_shorter_diagonal() {
    let kite = [[0.0, 0.0], [1.0, -0.2], [3.0, 0.0], [1.0, 0.2]];
    for first in 0..4 {
        let loaded = polygon(&[&kite[first..], &kite[..first]].concat(), |corner| corner);
        for triangle in corners(&loaded.scene).as_chunks::<3>().0 {
            assert!(triangle.contains(&[1.0, -0.2, 0.0]) && triangle.contains(&[1.0, 0.2, 0.0]), "{triangle:?}");
        }
    }
    // The diagonals have the same length: the one from the first corner is taken.
    let square = read(format!("{SQUARE}f 2 3 4 1\n"), "").unwrap();
    assert!(corners(&square.scene).as_chunks::<3>().0.iter().all(|triangle| triangle.contains(&[1.0, 0.0, 0.0])));
    // The quad is not planar: it becomes a roof over the shorter diagonal.
    let roof = read("v 0 0 0\nv 1 0 0.5\nv 1 1 0\nv 0 1 0.6\nf 1 2 3 4\n", "").unwrap();
    assert_warnings(&roof, &[]);
    assert!(corners(&roof.scene).as_chunks::<3>().0.iter().all(|triangle| triangle.contains(&[1.0, 1.0, 0.0])));
}

#[test]
fn polygons_without_a_proper_area() {
    let flat = "f 1 2 5 1\nf 1 1 1 1 1\nf 1 2 1 2\nf 1 2 5 2 1\n";
    let loaded = read(format!("{SQUARE}v 2 0 0\n{flat}f 1 2 3 4\n"), "").unwrap();
    assert_warnings(&loaded, &[("line 7", "no area; the face is left out (3 faces like this)")]);
    // The first face is a triangle after the loss of its last corner.
    assert_eq!((loaded.scene.triangle_count(), area(&loaded)), (3, 1.0));
    let loaded = read(format!("{SQUARE}v 2 0 0\nf 1 2 1 2\n"), "");
    assert_error(loaded, "test.obj", "line 6", "no area; the face is left out; no face of the file can be drawn");

    // The corners are rounded positions on a line.
    let tilted: Vec<_> = [0.0, 1.0, 2.0, 3.5, 5.0].iter().map(|along| [along * 0.3, along * 0.7]).collect();
    let text = |corners: usize| (1..=corners).fold("f".to_owned(), |face, corner| format!("{face} {corner}"));
    let line: String = tilted.iter().map(|[x, y]| format!("v {x} {y} {}\n", x * 0.1_f32)).collect();
    let loaded = read(format!("{line}{}\n{}\nv 1 0 0\nf 1 6 5\n", text(5), text(4)), "").unwrap();
    assert_warnings(&loaded, &[("line 6", "no area; the face is left out (2 faces like this)")]);

    let bow_tie = read(format!("{SQUARE}f 1 3 2 4\n"), "").unwrap();
    assert_warnings(&bow_tie, &[("line 5", "its edges cross")]);
    assert_eq!(bow_tie.scene.triangle_count(), 2);
    let star: Vec<_> = (0..5).map(|i| (i as f32 * 4.0 * std::f32::consts::PI / 5.0).sin_cos().into()).collect();
    assert_warnings(&polygon(&star, |corner| corner), &[("line 6", "its edges cross")]);
}

/// Corners of a polygon around a centre, with a varying radius.
fn round(count: usize, radius: impl Fn(usize) -> f32) -> Vec<[f32; 2]> {
    let turn = |i| (i as f32 / count as f32 * std::f32::consts::TAU).sin_cos();
    (0..count).map(|i| [turn(i).1 * radius(i), turn(i).0 * radius(i)]).collect()
}

#[test]
fn polygons_with_very_many_corners() {
    const COUNT: usize = 100_000;
    let circle = round(COUNT, |_| 1.0);
    let gear = round(COUNT, |i| if i % 2 == 0 { 1.0 } else { 0.5 });
    let mut comb = vec![[COUNT as f32, -1.0], [0.0, -1.0]];
    comb.extend((0..COUNT).map(|i| [i as f32, if i % 2 == 0 { 0.0 } else { 100.0 }]));
    comb.reverse();
    for (ring, name) in [(circle, "circle"), (gear, "gear"), (comb, "comb")] {
        let start = Instant::now();
        let loaded = polygon(&ring, |corner| corner);
        assert!(loaded.scene.triangle_count() >= ring.len() - 3, "{name}: {}", loaded.scene.triangle_count());
        println!("{name}: {:?} {:?}", start.elapsed(), loaded.warnings);
        assert!(start.elapsed() < Duration::from_secs(30), "{name}: {:?}", start.elapsed());
    }
}

#[test]
fn faces_that_are_wrong() {
    let face = |face: &str, reason: &str| {
        let reason = &format!("{reason}; the face is left out");
        let text = format!("{SQUARE}vt 0 0\nvn 0 0 1\nf {face}\n");
        assert_error(read(&text, ""), "test.obj", "line 7", &format!("{reason}; no face of the file can be drawn"));
        let loaded = read(format!("{text}f {face}\nf 1 2 3 4\n"), "").unwrap();
        assert_warnings(&loaded, &[("line 7", &format!("{reason} (2 faces like this)"))]);
        assert_eq!(area(&loaded), 1.0);
    };
    face("1 2 5", "index 5 is out of range: there are 4 vertices");
    face("1 2 -5", "index -5 is out of range: there are 4 vertices");
    face("0 1 2", "index 0 is out of range: there are 4 vertices");
    face("1 2", "2 corners, where 3 or more belong");
    face("1", "1 corners, where 3 or more belong");
    face("", "0 corners, where 3 or more belong");
    face("a b c", "\"a\" is not an index");
    face("1.5 2 3", "\"1.5\" is not an index");
    face("/1 2 3", "\"/1\" is not an index");
    face("9223372036854775807 1 2", "index 9223372036854775807 is out of range: there are 4 vertices");
    face("-9223372036854775808 1 2", "index -9223372036854775808 is out of range: there are 4 vertices");
    face("99999999999999999999 1 2", "\"99999999999999999999\" is not an index");
}

#[test]
fn attributes_that_are_wrong_cost_themselves() {
    let face = |face: &str, reason: &str| {
        let loaded = read(format!("{SQUARE}vt 0 0\nvt 1 1\nvn 0 1 0\nf {face}\n"), "").unwrap();
        assert_warnings(&loaded, &[("line 8", reason)]);
        assert_eq!(area(&loaded), 0.5);
        loaded.scene.meshes[0].clone()
    };
    for index in ["3", "0", "-3", "x", "1e9"] {
        let mesh = face(&format!("1/{index} 2/2 3/2"), "; 0 is used");
        assert_eq!(mesh.uvs[0], [[0.0, 1.0], [1.0, 0.0], [1.0, 0.0]], "{index}");
        let mesh = face(&format!("1//{index} 2//1 3//1"), "; the normal of the face is used");
        assert_eq!(mesh.normals, [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0]], "{index}");
    }
    face("1/2 2/1 3/9", "index 9 is out of range: there are 2 texture coordinates");
    face(
        "1//9 2//1 3//9",
        "index 9 is out of range: there are 1 normals; the normal of the face is used (2 corners like this)",
    );
    face("1/1/1/1 2/1/1 3/1/1", "more than three indices; the first three are used");
    face("1/1 2 3/1", "only some corners");
}

#[test]
fn corners_as_exporters_write_them() {
    let text = format!("{SQUARE}vt 0 0\nvn 0 0 1\n");
    for face in
        ["1/1/ 2/1/ 3/1/", "1// 2// 3//", "1/ 2/ 3/", "1.0 2.0 3.0", "\t1  2\t 3 ", "1 2 3 # note", "1 2 3#", "+1 2 3"]
    {
        let loaded = read(format!("{text}f {face}\n"), "").unwrap();
        assert_warnings(&loaded, &[]);
        assert_eq!(area(&loaded), 0.5, "{face}");
    }
    assert_eq!(area(&read(format!("{text}F 1 2 3\nfo 1 3 4"), "").unwrap()), 1.0);
}

#[test]
fn faces_may_stand_before_what_they_use() {
    let loaded = read(format!("f 1/1/1 2/1/1 3/1/1\n{SQUARE}f 1 3 4\nvt 0.5 0\nvn 0 1 0\n"), "").unwrap();
    assert_warnings(&loaded, &[]);
    assert_eq!(area(&loaded), 1.0);
    let mesh = loaded.scene.meshes.iter().find(|mesh| !mesh.normals.is_empty()).unwrap();
    assert_eq!((mesh.uvs[0][0], mesh.normals[0]), ([0.5, 1.0], [0.0, 1.0, 0.0]));
    assert_error(read("f 1 2 3\nv 0 0 0\nv 1 0 0\n", ""), "test.obj", "line 1", "there are 2 vertices");
}
