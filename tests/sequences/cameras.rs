//! Cameras of sequences: written, read, and derived from what they saw.

use crate::camera::{Camera, dot};
use crate::camera_fit;
use serde_json::json;

const SIZE: [u32; 2] = [96, 54];

/// Turned about all axes; its image is mirrored if `side` is −1.
fn turned(side: f64) -> Camera {
    let ([sin_a, cos_a], [sin_b, cos_b]) = ([0.6, 0.8], [0.28, 0.96]);
    let right = [cos_a, 0.0, -sin_a].map(|x| side * x);
    let up = [sin_a * sin_b, cos_b, cos_a * sin_b];
    let forward = [-sin_a * cos_b, sin_b, -cos_a * cos_b];
    Camera { eye: [0.2, -0.1, 0.3], forward, right, up, slope: 1.2, jitter: [0.0; 2] }
}

/// Normals and depths in the box −1…1 around the origin.
fn look(camera: &Camera) -> (Vec<f32>, Vec<f32>) {
    let (mut normals, mut depths) = (Vec::new(), Vec::new());
    for i in 0..SIZE[0] * SIZE[1] {
        let ray = camera.ray([i % SIZE[0], i / SIZE[0]], SIZE);
        let distance = |axis: usize| (ray[axis].signum() - camera.eye[axis]) / ray[axis];
        let axis = (0..3).min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap();
        normals.extend((0..3).map(|k| if k == axis { -ray[axis].signum() as f32 } else { 0.0 }));
        depths.push(distance(axis) as f32);
    }
    (normals, depths)
}

#[test]
fn a_camera_is_read_as_it_was_written() {
    let camera = Camera { jitter: [0.25, -0.5], ..turned(1.0) };
    assert_eq!(Camera::from_json(&camera.to_json()), Ok(camera));
    let error = Camera::from_json(&json!({"th": 0.5, "o": [0, 0, 0], "fw": "north"})).unwrap_err();
    assert_eq!(error, "fw must be three numbers");
}

#[test]
fn a_point_at_rest_moves_against_the_camera() {
    let now = Camera::at_rest(0.8, SIZE);
    // One unit to the left, where the pixel at depth 2 was further right.
    let before = Camera { eye: [-1.0, 0.0, 0.0], ..now };
    let [x, y] = now.motion_to(&before, [48, 27], 2.0, SIZE);
    let expected = 0.5 / now.slope * f64::from(SIZE[0]) / 2.0;
    assert!((x - expected).abs() < 1e-9 && y.abs() < 1e-9, "{x}, {y}, not {expected}, 0");
    assert!(now.motion_to(&Camera { eye: [0.0, 0.0, -5.0], ..now }, [48, 27], 2.0, SIZE)[0].is_nan(), "it was behind");
}

#[test]
fn a_camera_is_derived_from_planes() {
    for side in [1.0, -1.0] {
        let camera = turned(side);
        let (normals, depths) = look(&camera);
        let found = camera_fit::fit(&normals, &depths, SIZE).expect("walls, and floor or ceiling, are in sight");
        for (axis, expected) in [(found.right, camera.right), (found.up, camera.up), (found.forward, camera.forward)] {
            assert!(dot(axis, expected) > 0.999_99, "{found:?} is not {camera:?}");
        }
        assert!((found.slope - camera.slope).abs() < 1e-3, "{} is not {}", found.slope, camera.slope);
    }
}

#[test]
fn nothing_is_derived_from_noise() {
    let (normals, mut depths) = look(&turned(1.0));
    for (i, depth) in depths.iter_mut().enumerate() {
        *depth *= 1.0 + 0.1 * ((i * 7919) % 13) as f32;
    }
    assert_eq!(camera_fit::fit(&normals, &depths, SIZE), None);
    assert_eq!(camera_fit::fit(&[], &[], [0, 0]), None);
}
