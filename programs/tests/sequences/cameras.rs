//! Cameras of sequences: written, read, and derived from their images.

use crate::folder::Folder;
use asvgf_programs::sequence::Eye;
use asvgf_programs::sequence::camera::{Camera, Lens, Raster, dot};
use asvgf_programs::sequence::camera_fit::{Fit, fit};
use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, LayerAttributes, Vec2, WritableImage as _};
use serde_json::json;

const SIZE: [u32; 2] = [96, 54];

/// Returns a camera turned about all axes; its image is mirrored if `side` is −1.
fn turned(side: f64, lens: Lens) -> Camera {
    let ([sin_a, cos_a], [sin_b, cos_b]) = ([0.6, 0.8], [0.28, 0.96]);
    let right = [cos_a, 0.0, -sin_a].map(|x| side * x);
    let up = [sin_a * sin_b, cos_b, cos_a * sin_b];
    let forward = [-sin_a * cos_b, sin_b, -cos_a * cos_b];
    Camera { eye: [0.2, -0.1, 0.3], ..Camera::looking([right, up, forward], lens) }
}

/// Returns the depth at which a ray leaves the box −1…1 around the origin, and the wall's normal there.
fn wall_of(camera: &Camera, pixel: [u32; 2], raster: Raster) -> (f64, [f32; 3]) {
    let near = camera.position(pixel, 0.0, raster);
    let far = camera.position(pixel, 1.0, raster);
    let ray: [f64; 3] = std::array::from_fn(|k| far[k] - near[k]);
    let distance = |axis: usize| (ray[axis].signum() - near[axis]) / ray[axis];
    let axis = (0..3).min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap();
    (distance(axis), std::array::from_fn(|k| if k == axis { -ray[axis].signum() as f32 } else { 0.0 }))
}

/// Returns normals and depths in that box, or distances along the rays.
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
    // In an orthographic view, the motion is the same at any depth.
    let flat = Camera { lens: Lens::Orthographic(2.0), ..now };
    let left = Camera { eye: [-1.0, 0.0, 0.0], ..flat };
    for depth in [0.5, 20.0] {
        assert!((flat.motion_to(&left, [10, 5], depth, raster)[0] - 24.0).abs() < 1e-9);
    }
}

/// A crop sees the same as the whole picture's pixels, off-centre and with pixels that are not square.
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
        // The crop is off the middle of its picture.
        let crop = Raster { size: [70, 50], offset: [20, 3], ..whole };
        let (normals, depths) = look(&camera, crop, false);
        assert_found(&camera, fit(&normals, &depths, crop, false, None));
    }
    let parallel = turned(1.0, Lens::Orthographic(0.8));
    let (normals, depths) = look(&parallel, whole, false);
    assert_found(&parallel, fit(&normals, &depths, whole, false, None));
}

/// A room along the axes of the view fits every field of view.
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

type Matrix = [[f64; 4]; 4];

/// Multiplies matrices for row vectors, as files have them.
fn times(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|k| a[i][k] * b[k][j]).sum()))
}

/// A camera in the conventions of programs: looking along +Z or −Z of its own space, with a picture of −1…1 or of 0…1,
/// y up or down in it.
#[test]
fn attributes_describe_cameras() {
    let raster = Raster::whole(SIZE);
    for (lens, sign, unit, down) in [
        (Lens::Perspective(0.6), 1.0, true, false),
        (Lens::Perspective(0.6), 1.0, true, true),
        (Lens::Perspective(0.6), -1.0, false, false),
        (Lens::Orthographic(1.5), -1.0, false, false),
        (Lens::Orthographic(1.5), 1.0, true, true),
    ] {
        let camera = Camera { shift: [0.1, -0.05], ..turned(1.0, lens) };
        let to_view = |v: [f64; 3]| [dot(v, camera.right), dot(v, camera.up), sign * dot(v, camera.forward)];
        let axis = |k: usize| to_view(std::array::from_fn(|i| f64::from(u8::from(i == k))));
        let moved = to_view(camera.eye.map(|x| -x));
        let row = |v: [f64; 3], w: f64| [v[0], v[1], v[2], w];
        let world_to_camera = [row(axis(0), 0.0), row(axis(1), 0.0), row(axis(2), 0.0), row(moved, 1.0)];
        // x/(s·z) − shift, y/(s·z·h/w) − shift/(h/w).
        let (s, tall) = (camera.slope(), raster.height_over_width());
        let shift = [camera.shift[0], camera.shift[1] / tall];
        let mut to_picture = [[0.0; 4]; 4];
        (to_picture[0][0], to_picture[1][1], to_picture[2][2]) = (1.0 / s, 1.0 / (s * tall), sign);
        let last = if camera.is_orthographic() { 3 } else { 2 };
        let w = if camera.is_orthographic() { 1.0 } else { sign };
        (to_picture[last][0], to_picture[last][1], to_picture[last][3]) = (-shift[0] * w, -shift[1] * w, w);
        // Converts from −1…1 to the program's range.
        let (scale, offset) = if unit { (0.5, 0.5) } else { (1.0, 0.0) };
        let flip = if down { -1.0 } else { 1.0 };
        let to_program =
            [[scale, 0.0, 0.0, 0.0], [0.0, flip * scale, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [offset, offset, 0.0, 1.0]];
        let world_to_ndc = times(&times(&world_to_camera, &to_picture), &to_program);

        let folder = Folder::new();
        let path = folder.0.join("frame_0000.exr");
        let mut attributes = LayerAttributes::default();
        let flat = |m: &Matrix| std::array::from_fn(|i| m[i / 4][i % 4] as f32);
        attributes.world_to_camera = Some(flat(&world_to_camera));
        attributes.world_to_normalized_device = Some(flat(&world_to_ndc));
        let size = Vec2(SIZE[0] as usize, SIZE[1] as usize);
        let channel = |name: &str| AnyChannel::new(name, FlatSamples::F32(vec![0.5; size.area()]));
        let channels = AnyChannels::sort(
            ["B", "G", "R", "depth.Z", "normal.X", "normal.Y", "normal.Z"].map(channel).into_iter().collect(),
        );
        let part = exr::prelude::Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, channels);
        Image::from_layer(part).write().to_file(&path).unwrap();

        let sequence = folder.open().unwrap();
        assert_eq!(sequence.eye, Eye::Described);
        let found = sequence.camera(0);
        let pixels = [[0, 0], [95, 0], [40, 53]];
        for pixel in pixels {
            let [a, b] = [&found, &camera].map(|camera| camera.position(pixel, 2.0, raster));
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-4), "{found:?} is not {camera:?}: {a:?}, {b:?}");
        }
    }
}

/// Cameras in the world, with normals of the world or of their own space: both read the same.
#[test]
fn the_space_of_normals_is_found() {
    let raster = Raster::whole(SIZE);
    let camera = turned(1.0, Lens::Perspective(1.2));
    let (normals, depths) = look(&camera, raster, false);
    let own = |sign: f64| -> Vec<f32> {
        let turned = |n: &[f32; 3]| {
            let n = n.map(f64::from);
            [dot(n, camera.right), dot(n, camera.up), sign * dot(n, camera.forward)].map(|x| x as f32)
        };
        normals.as_chunks::<3>().0.iter().flat_map(turned).collect()
    };
    for (written, expected) in [(normals.clone(), None), (own(-1.0), Some(-1.0)), (own(1.0), Some(1.0))] {
        let folder = Folder::new();
        let component = |k: usize| written.iter().skip(k).step_by(3).copied().collect::<Vec<f32>>();
        let names = ["normal.X", "normal.Y", "normal.Z"].iter().enumerate();
        let mut channels: Vec<(String, Vec<f32>)> = names.map(|(k, name)| ((*name).to_owned(), component(k))).collect();
        channels.extend(["R", "G", "B"].map(|name| (name.to_owned(), vec![0.5; depths.len()])));
        channels.push(("depth.Z".into(), depths.clone()));
        folder.write(0, &asvgf::image_io::Channels { width: SIZE[0], height: SIZE[1], channels });
        let manifest = json!({ "cameras": [camera.to_json()] }).to_string();
        std::fs::write(folder.0.join("manifest.json"), manifest).unwrap();
        let sequence = folder.open().unwrap();
        assert_eq!(sequence.normals_of_view, expected);
        let pixels = sequence.read(0).unwrap();
        let found = pixels.get(asvgf_programs::sequence::layers::Layer::Normal).unwrap();
        assert!(found.iter().zip(&normals).all(|(a, b)| (a - b).abs() < 1e-5));
    }
}
