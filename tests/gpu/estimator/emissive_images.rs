//! A lamp with an image: light comes from its bright spots, and light samples find them.

use super::area::{ALBEDO, HEIGHT, LAMP, RADIANCE, below, expected, lamp_over_floor};
use super::{ROUNDING, SAMPLINGS, channel, images, tracer};
use crate::common::scenes::{emitter, lambert, quad, scene};
use crate::common::stage::Stage;
use crate::common::statistics::{Estimate, Rgb};
use asvgf::plan::Feature;
use asvgf::scene::{
    Alpha, Animation, Channel, Image, Interpolation, Material, MorphTarget, Node, Scene, Target, Texture, Transform,
    Wrap,
};
use asvgf::{Sampling, Settings};
use std::ops::Range;

/// Texels of the image along each axis, and those of its bright spot: 1.6 % of the lamp.
const TEXELS: u32 = 32;
const SPOT: [Range<u32>; 2] = [20..24, 9..13];

/// An image that is white in the spot and black elsewhere.
fn spot() -> Image {
    let [columns, rows] = SPOT;
    let color = |x: u32, y: u32| if columns.contains(&x) && rows.contains(&y) { [255; 4] } else { [0, 0, 0, 255] };
    let texels = (0..TEXELS * TEXELS).map(|i| color(i % TEXELS, i / TEXELS)).collect();
    Image { width: TEXELS, height: TEXELS, texels, ..Default::default() }
}

/// The spot on the lamp, whose u runs along x and whose v runs along z.
fn rectangle() -> [[f64; 2]; 2] {
    let place = |axis: usize, texel: u32| {
        let [low, high] = LAMP[axis];
        low + (high - low) * f64::from(texel) / f64::from(TEXELS)
    };
    [0, 1].map(|axis| [place(axis, SPOT[axis].start), place(axis, SPOT[axis].end)])
}

fn with_image(material: Material) -> Material {
    Material { emissive_texture: Some(Texture { nearest: true, ..Texture::new(0) }), ..material }
}

/// The lamp of [`lamp_over_floor`], black but for a spot.
fn spotted_lamp() -> Scene {
    Scene { images: vec![spot()], ..lamp_over_floor(with_image(emitter(RADIANCE))) }
}

#[track_caller]
fn assert_spot_lights_floor(scene: &Scene, samplings: &[Sampling], what: &str) {
    for &sampling in samplings {
        // One scattered ray in 300 meets the spot.
        let count = if sampling == Sampling::Scattered { 256 } else { 64 };
        let found = images(scene.clone(), below(), tracer(sampling, 0), count);
        for i in 0..3 {
            channel(&found, i).assert_is(expected(rectangle(), i), ROUNDING, &format!("{what}, {sampling:?}"));
        }
    }
}

#[test]
fn a_bright_spot_of_a_lamp_lights_the_floor_by_its_form_factor() {
    assert_spot_lights_floor(&spotted_lamp(), &SAMPLINGS, "spot");
    let mut back = spotted_lamp();
    back.meshes[1].triangles.iter_mut().for_each(|t| t.swap(1, 2));
    back.materials[1].double_sided = true;
    assert_spot_lights_floor(&back, &[Sampling::Both, Sampling::Lights], "spot of the back");
}

#[test]
fn the_spot_is_where_the_texture_is_placed() {
    let mut scene = spotted_lamp();
    // The second set of coordinates is turned by a quarter and four times as large, and lies two images beside the first.
    scene.meshes[1].uvs[1] = scene.meshes[1].uvs[0].iter().map(|[u, v]| [4.0 * v + 8.0, -4.0 * u]).collect();
    let texture = Texture {
        uv_set: 1,
        transform: [[0.0, -0.25, 0.0], [0.25, 0.0, 0.0]],
        ..scene.materials[1].emissive_texture.unwrap()
    };
    scene.materials[1].emissive_texture = Some(texture);
    assert_spot_lights_floor(&scene, &SAMPLINGS, "second set");
    // Mirrored images in every other place.
    scene.materials[1].emissive_texture = Some(Texture {
        wrap: [Wrap::Repeat, Wrap::Mirror],
        transform: [[0.0, -0.25, 0.0], [-0.25, 0.0, 0.0]],
        ..texture
    });
    assert_spot_lights_floor(&scene, &[Sampling::Both, Sampling::Lights], "mirrored image");
}

#[test]
fn the_spot_moves_with_its_lamp() {
    let mut mirrored = spotted_lamp();
    mirrored.meshes[1].positions.iter_mut().for_each(|p| p[0] = -p[0]);
    mirrored.meshes[1].triangles.iter_mut().for_each(|t| t.swap(1, 2));
    let scale = [-1.0, 1.0, 1.0];
    mirrored.nodes[1].transform = Transform::Trs { translation: [0.0; 3], rotation: [0.0, 0.0, 0.0, 1.0], scale };
    for movable in [false, true] {
        mirrored.nodes[1].movable = movable;
        assert_spot_lights_floor(&mirrored, &SAMPLINGS, &format!("mirrored, movable: {movable}"));
    }
    // The mesh is half as large at rest, and grows to the lamp.
    let mut growing = spotted_lamp();
    let positions = growing.meshes[1].positions.clone();
    let half = positions.iter().map(|p| p.map(|x| -0.5 * x)).collect::<Vec<_>>();
    growing.meshes[1].positions = positions.iter().zip(&half).map(|(p, h)| [0, 1, 2].map(|i| p[i] + h[i])).collect();
    let grown = half.iter().map(|h| h.map(|x| -x)).collect();
    growing.meshes[1].targets =
        vec![MorphTarget { vertices: (0..4).collect(), positions: grown, ..Default::default() }];
    growing.animations = vec![Animation {
        channels: vec![Channel {
            target: Target::Weight { node: 1, target: 0 },
            interpolation: Interpolation::Step,
            times: vec![0.0],
            values: vec![[1.0, 0.0, 0.0, 0.0]],
        }],
        ..Default::default()
    }];
    growing.validate().unwrap();
    assert_spot_lights_floor(&growing, &SAMPLINGS, "growing");
    // Of two instances of one mesh, one is far away.
    let mut two = spotted_lamp();
    two.nodes[1].movable = true;
    let translation = [0.0, 5000.0, 0.0];
    let far = Transform::Trs { translation, rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] };
    two.nodes.push(Node { transform: far, ..two.nodes[1].clone() });
    assert_spot_lights_floor(&two, &SAMPLINGS, "instances");
}

#[test]
fn black_parts_of_an_image_are_no_lights() {
    // A second lamp, whose part of the image is black, is beside the first.
    let mut scene = spotted_lamp();
    let mut black = quad([-0.4, HEIGHT as f32, 1.0], [0.9, 0.0, 0.0], [0.0, 0.0, 5.0], 1);
    black.uvs[0].iter_mut().for_each(|uv| *uv = [0.1 + 0.3 * uv[0], 0.6 + 0.3 * uv[1]]);
    scene.meshes.push(black);
    scene.nodes.push(Node { meshes: vec![2], ..Default::default() });
    assert_spot_lights_floor(&scene, &SAMPLINGS, "beside a black lamp");
    // Without light, nothing is sampled.
    scene.images[0].texels.fill([0, 0, 0, 255]);
    let mut stage = Stage::new(scene, [4, 4], Settings::adaptive());
    stage.camera = Some(below());
    stage.frames(2);
    assert!(stage.image().iter().all(|color| *color == [0.0; 3]));
    let features = stage.denoiser.plan().unwrap().features;
    assert!(
        !features.has(Feature::Emitters) && !features.has(Feature::Lights) && !features.has(Feature::EmitterPieces)
    );
}

#[test]
fn a_hole_of_a_lamp_emits_nothing_and_a_veil_as_much_as_it_covers() {
    // The lamp is opaque left of the middle, and has this opacity on the right.
    for (alpha, opacity, part) in [(Alpha::Mask(0.5), 0, 0.0), (Alpha::Mask(0.5), 200, 1.0), (Alpha::Blend, 51, 0.2)] {
        let mut scene = lamp_over_floor(Material { alpha, ..emitter(RADIANCE) });
        let texels = vec![[0, 0, 0, 255], [0, 0, 0, opacity]];
        scene.images = vec![Image { width: 2, height: 1, texels, ..Default::default() }];
        scene.materials[1].base_color = [1.0; 4];
        scene.materials[1].base_color_texture = Some(Texture { nearest: true, ..Texture::new(0) });
        let middle = 0.5 * (LAMP[0][0] + LAMP[0][1]);
        let [left, right] = [[LAMP[0][0], middle], [middle, LAMP[0][1]]].map(|columns| [columns, LAMP[1]]);
        let expected = |i| expected(left, i) + part * expected(right, i);
        for sampling in SAMPLINGS {
            let found = images(scene.clone(), below(), tracer(sampling, 0), 64);
            channel(&found, 0).assert_is(expected(0), ROUNDING, &format!("{alpha:?}, {opacity}, {sampling:?}"));
        }
    }
}

#[test]
fn a_smooth_image_has_one_mean_for_all_estimators() {
    let mut scene = spotted_lamp();
    let texture = scene.materials[1].emissive_texture.as_mut().unwrap();
    texture.nearest = false;
    // A wall beside the lamp is lit from near, and the light comes over two bounces.
    scene.meshes.push(quad([-0.5, 0.0, -2.0], [0.0, 0.0, 5.0], [0.0, 2.0, 0.0], 2));
    scene.materials.push(lambert([0.8, 0.5, 0.5]));
    scene.nodes.push(Node { meshes: vec![2], ..Default::default() });
    let mean = |sampling, count| channel(&images(scene.clone(), below(), tracer(sampling, 2), count), 0);
    let both = mean(Sampling::Both, 256);
    mean(Sampling::Lights, 256).assert_agrees(both, ROUNDING, "light samples");
    mean(Sampling::Scattered, 512).assert_agrees(both, ROUNDING, "scattered rays");
}

/// Standard deviation of a pixel from image to image, over its mean.
fn noise(scene: &Scene) -> f64 {
    let found: Vec<Vec<Rgb>> = images(scene.clone(), below(), tracer(Sampling::Lights, 0), 64);
    let pixel = |pixel: usize| {
        let estimate = Estimate::of(&found.iter().map(|image| f64::from(image[pixel][0])).collect::<Vec<_>>());
        estimate.error * (found.len() as f64).sqrt() / estimate.mean
    };
    (0..found[0].len()).map(pixel).sum::<f64>() / found[0].len() as f64
}

#[test]
fn the_spot_of_a_lamp_is_as_quiet_as_a_lamp_of_its_size() {
    let [[x0, x1], [z0, z1]] = rectangle().map(|range| range.map(|place| place as f32));
    let floor = lamp_over_floor(emitter(RADIANCE)).meshes[0].clone();
    let small = quad([x0, HEIGHT as f32, z0], [x1 - x0, 0.0, 0.0], [0.0, 0.0, z1 - z0], 1);
    let small = scene(vec![lambert([ALBEDO as f32; 3]), emitter(RADIANCE)], vec![floor, small]);
    let [small, spotted] = [small, spotted_lamp()].map(|scene| noise(&scene));
    println!("noise of a pixel: {spotted:.3} for the spot, {small:.3} for a small lamp");
    // One sample in ten goes to pieces that may hold light: the spot and what is around.
    let shared = (1.0 + small * small) / 0.9 - 1.0;
    assert!(spotted < 1.5 * shared.sqrt(), "{spotted}, not {shared}");
}
