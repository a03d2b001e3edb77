//! Cameras of sequences: written, read, and derived from what they saw.

use crate::camera::{Camera, Lens, Raster, dot};
use crate::sequence::{Fit, fit};
use serde_json::json;

const SIZE: [u32; 2] = [96, 54];

/// Turned about all axes; its image is mirrored if `side` is −1.
fn turned(side: f64, lens: Lens) -> Camera {
    let ([sin_a, cos_a], [sin_b, cos_b]) = ([0.6, 0.8], [0.28, 0.96]);
    let right = [cos_a, 0.0, -sin_a].map(|x| side * x);
    let up = [sin_a * sin_b, cos_b, cos_a * sin_b];
    let forward = [-sin_a * cos_b, sin_b, -cos_a * cos_b];
    Camera { eye: [0.2, -0.1, 0.3], ..Camera::looking([right, up, forward], lens) }
}

/// Where a ray leaves the box −1…1 around the origin, and the wall's normal there.
fn wall_of(camera: &Camera, pixel: [u32; 2], raster: Raster) -> (f64, [f32; 3]) {
    let near = camera.position(pixel, 0.0, raster);
    let far = camera.position(pixel, 1.0, raster);
    let ray: [f64; 3] = std::array::from_fn(|k| far[k] - near[k]);
    let distance = |axis: usize| (ray[axis].signum() - near[axis]) / ray[axis];
    let axis = (0..3).min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap();
    (distance(axis), std::array::from_fn(|k| if k == axis { -ray[axis].signum() as f32 } else { 0.0 }))
}

/// Normals and depths in that box, or distances along the rays.
fn look(camera: &Camera, raster: Raster, along_ray: bool) -> (Vec<f32>, Vec<f32>) {
    let (mut normals, mut depths) = (Vec::new(), Vec::new());
    for i in 0..raster.size[0] * raster.size[1] {
        let pixel = [i % raster.size[0], i / raster.size[0]];
        let (depth, normal) = wall_of(camera, pixel, raster);
        normals.extend(normal);
        depths.push((depth * if along_ray { camera.ray_length(pixel, raster) } else { 1.0 }) as f32);
    }
    (normals, depths)
}

#[track_caller]
fn assert_found(camera: &Camera, found: Option<Fit>) {
    let found = found.expect("walls, and floor or ceiling, are in sight");
    assert!(found.determined, "{found:?}");
    let found = found.camera;
    for (axis, expected) in [(found.right, camera.right), (found.up, camera.up), (found.forward, camera.forward)] {
        assert!(dot(axis, expected) > 0.999_99, "{found:?} is not {camera:?}");
    }
    assert_eq!(found.is_orthographic(), camera.is_orthographic());
    assert!((found.slope() / camera.slope() - 1.0).abs() < 2e-3, "{} is not {}", found.slope(), camera.slope());
}

#[test]
fn a_camera_is_read_as_it_was_written() {
    let camera = Camera { jitter: [0.25, -0.5], shift: [0.1, -0.2], ..turned(1.0, Lens::Perspective(1.2)) };
    assert_eq!(Camera::from_json(&camera.to_json()), Ok(camera));
    let camera = turned(-1.0, Lens::Orthographic(0.6));
    assert_eq!(Camera::from_json(&camera.to_json()), Ok(camera));
    let error = Camera::from_json(&json!({"th": 0.5, "o": [0, 0, 0], "fw": "north"})).unwrap_err();
    assert_eq!(error, "fw must be three numbers");
    assert_eq!(Camera::from_json(&json!({"ortho": 0})).unwrap_err(), "ortho must be a number above 0");
}

#[test]
fn a_point_at_rest_moves_against_the_camera() {
    let raster = Raster::whole(SIZE);
    let now = Camera::at_rest(0.8, raster);
    // One unit to the left, where the pixel at depth 2 was further right.
    let before = Camera { eye: [-1.0, 0.0, 0.0], ..now };
    let [x, y] = now.motion_to(&before, [48, 27], 2.0, raster);
    let expected = 0.5 / now.slope() * f64::from(SIZE[0]) / 2.0;
    assert!((x - expected).abs() < 1e-9 && y.abs() < 1e-9, "{x}, {y}, not {expected}, 0");
    let behind = Camera { eye: [0.0, 0.0, -5.0], ..now };
    assert!(now.motion_to(&behind, [48, 27], 2.0, raster)[0].is_nan(), "it was behind");
    // In an orthographic view, as far at any depth.
    let flat = Camera { lens: Lens::Orthographic(2.0), ..now };
    let left = Camera { eye: [-1.0, 0.0, 0.0], ..flat };
    for depth in [0.5, 20.0] {
        assert!((flat.motion_to(&left, [10, 5], depth, raster)[0] - 24.0).abs() < 1e-9);
    }
}

/// A crop sees what the same pixels of the whole picture see, off-centre and with pixels that are not square.
#[test]
fn a_crop_sees_what_the_picture_sees() {
    for lens in [Lens::Perspective(0.7), Lens::Orthographic(0.7)] {
        let camera = Camera { shift: [0.2, -0.1], jitter: [0.3, -0.2], ..turned(1.0, lens) };
        let whole = Raster { aspect: 1.25, ..Raster::whole(SIZE) };
        let crop = Raster { size: [20, 10], offset: [50, 30], ..whole };
        let [a, b] = [camera.position([57, 33], 2.0, whole), camera.position([7, 3], 2.0, crop)];
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12), "{a:?} is not {b:?}");
        let (place, depth) = camera.project(a, crop);
        assert!((place[0] - 7.8).abs() < 1e-9 && (place[1] - 3.3).abs() < 1e-9 && (depth - 2.0).abs() < 1e-12);
    }
}

#[test]
fn a_camera_is_derived_from_planes() {
    let whole = Raster::whole(SIZE);
    for side in [1.0, -1.0] {
        let camera = turned(side, Lens::Perspective(1.2));
        let (normals, depths) = look(&camera, whole, false);
        assert_found(&camera, fit(&normals, &depths, whole, false, None));
        let (normals, distances) = look(&camera, whole, true);
        assert_found(&camera, fit(&normals, &distances, whole, true, None));
        // Outside of the middle of its picture.
        let crop = Raster { size: [70, 50], offset: [20, 3], ..whole };
        let (normals, depths) = look(&camera, crop, false);
        assert_found(&camera, fit(&normals, &depths, crop, false, None));
    }
    let parallel = turned(1.0, Lens::Orthographic(0.8));
    let (normals, depths) = look(&parallel, whole, false);
    assert_found(&parallel, fit(&normals, &depths, whole, false, None));
}

/// A room along the axes of the view is one for every field of view.
#[test]
fn a_field_of_view_that_nothing_tells_is_not_told() {
    let raster = Raster::whole(SIZE);
    let square = Camera { eye: [0.1, 0.2, 0.3], ..Camera::at_rest(0.9, raster) };
    let (normals, depths) = look(&square, raster, false);
    let found = fit(&normals, &depths, raster, false, None).unwrap();
    assert!(!found.determined && dot(found.camera.forward, square.forward) > 0.999, "{found:?}");
    let found = fit(&normals, &depths, raster, false, Some(square.slope())).unwrap();
    assert!(found.camera.slope() == square.slope() && dot(found.camera.forward, square.forward) > 0.999, "{found:?}");
}

#[test]
fn nothing_is_derived_from_noise() {
    let raster = Raster::whole(SIZE);
    let (normals, mut depths) = look(&turned(1.0, Lens::Perspective(1.2)), raster, false);
    for (i, depth) in depths.iter_mut().enumerate() {
        *depth *= 1.0 + 0.1 * ((i * 7919) % 13) as f32;
    }
    for along_ray in [false, true] {
        assert!(fit(&normals, &depths, raster, along_ray, None).is_none());
    }
    assert!(fit(&[], &[], Raster::whole([0, 0]), false, None).is_none());
}
