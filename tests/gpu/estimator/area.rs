//! A rectangular lamp over a floor, with a known form factor (Siegel and Howell, configuration 3 of the catalogue).

use super::{ROUNDING, SAMPLINGS, channel, from_above, images, over_floor, tracer};
use crate::common::plane::V;
use crate::common::scenes::{emitter, floor, lambert, quad, scene};
use asvgf::Sampling;
use asvgf::scene::{Alpha, Image, Material, Scene, Texture, Transform};
use std::f64::consts::PI;

pub const ALBEDO: f64 = 0.7;
pub const RADIANCE: [f32; 3] = [5.0, 2.0, 1.0];

/// The lamp's extents in x and z, at a height.
pub const LAMP: [[f64; 2]; 2] = [[-0.4, 0.5], [-0.3, 0.9]];
pub const HEIGHT: f64 = 1.1;

/// Form factor from a point of the floor to a parallel rectangle with a corner above it.
fn corner(a: f64, b: f64) -> f64 {
    let (ra, rb) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
    (a / ra * (b / ra).atan() + b / rb * (a / rb).atan()) / (2.0 * PI)
}

/// Form factor to any rectangle, as the signed sum of four.
fn form_factor(p: V, [[x0, x1], [z0, z1]]: [[f64; 2]; 2]) -> f64 {
    let c = |x: f64, z: f64| corner((x - p[0]) / HEIGHT, (z - p[2]) / HEIGHT);
    c(x1, z1) - c(x0, z1) - c(x1, z0) + c(x0, z0)
}

/// A floor and a lamp that shines down.
pub fn lamp_over_floor(material: Material) -> Scene {
    let floor = floor(0);
    let [[x0, x1], [z0, z1]] = LAMP.map(|r| r.map(|v| v as f32));
    // x × z points down.
    let lamp = quad([x0, HEIGHT as f32, z0], [x1 - x0, 0.0, 0.0], [0.0, 0.0, z1 - z0], 1);
    scene(vec![lambert([ALBEDO as f32; 3]), material], vec![floor, lamp])
}

/// A camera below the lamp's height, because the lamp must not hide the floor from it.
pub fn below() -> asvgf::Camera {
    asvgf::Camera { eye: [0.3, 1.0, 0.2], fov_y: 0.6, ..from_above() }
}

pub fn expected(rectangle: [[f64; 2]; 2], i: usize) -> f64 {
    // The lower camera sees other points of the floor than `from_above`.
    let spread = (0.3_f64).tan() / (0.15_f64).tan() / 3.0;
    over_floor(|p| {
        let seen = [0.3 + (p[0] - 0.3) * spread, 0.0, 0.2 + (p[2] - 0.2) * spread];
        ALBEDO * f64::from(RADIANCE[i]) * form_factor(seen, rectangle)
    })
}

fn assert_floor_is_lit(scene: &Scene, share: f64, what: &str) {
    for sampling in SAMPLINGS {
        let found = images(scene.clone(), below(), tracer(sampling, 0), 64);
        for i in 0..3 {
            channel(&found, i).assert_is(share * expected(LAMP, i), ROUNDING, &format!("{what}, {sampling:?}"));
        }
    }
}

#[test]
fn a_lamp_lights_the_floor_by_its_form_factor() {
    assert_floor_is_lit(&lamp_over_floor(emitter(RADIANCE)), 1.0, "lamp");
}

#[test]
fn a_lamp_has_a_dark_back() {
    let mut scene = lamp_over_floor(emitter(RADIANCE));
    scene.meshes[1].triangles.iter_mut().for_each(|t| t.swap(1, 2));
    assert_floor_is_lit(&scene, 0.0, "lamp that shines up");
    scene.materials[1].double_sided = true;
    assert_floor_is_lit(&scene, 1.0, "lamp that shines up and down");
}

#[test]
fn a_mirrored_lamp_shines_where_its_mirror_image_would() {
    for movable in [false, true] {
        let mut scene = lamp_over_floor(emitter(RADIANCE));
        // The lamp is mirrored twice in space and once in its mesh: the same rectangle, still facing down.
        scene.meshes[1].positions.iter_mut().for_each(|p| p[0] = -p[0]);
        scene.meshes[1].triangles.iter_mut().for_each(|t| t.swap(1, 2));
        scene.nodes[1].transform =
            Transform::Trs { translation: [0.0; 3], rotation: [0.0, 0.0, 0.0, 1.0], scale: [-1.0, 1.0, 1.0] };
        scene.nodes[1].movable = movable;
        assert_floor_is_lit(&scene, 1.0, &format!("mirrored, movable: {movable}"));
        // The lamp is mirrored in height and lifted back: it faces up.
        let up = Transform::Trs {
            translation: [0.0, 2.0 * HEIGHT as f32, 0.0],
            rotation: [0.0, 0.0, 0.0, 1.0],
            scale: [-1.0, -1.0, 1.0],
        };
        scene.nodes[1].transform = up;
        assert_floor_is_lit(&scene, 0.0, &format!("upside down, movable: {movable}"));
    }
}

#[test]
fn a_texture_decides_where_a_lamp_shines() {
    let mut scene = lamp_over_floor(emitter(RADIANCE));
    // u runs along x, so the left half is dark.
    scene.images = vec![Image { width: 2, height: 1, texels: vec![[0, 0, 0, 255], [255; 4]], ..Default::default() }];
    scene.materials[1].emissive_texture = Some(Texture { nearest: true, ..Texture::new(0) });
    let half = [[0.5 * (LAMP[0][0] + LAMP[0][1]), LAMP[0][1]], LAMP[1]];
    for sampling in SAMPLINGS {
        let found = images(scene.clone(), below(), tracer(sampling, 0), 64);
        channel(&found, 0).assert_is(expected(half, 0), ROUNDING, &format!("half a lamp, {sampling:?}"));
    }
}

#[test]
fn colours_of_vertices_do_not_tint_emission() {
    let mut scene = lamp_over_floor(emitter(RADIANCE));
    scene.meshes[1].colors = vec![[1.0, 0.0, 0.0, 1.0], [0.0; 4], [0.0, 0.2, 0.0, 0.5], [0.3; 4]];
    assert_floor_is_lit(&scene, 1.0, "lamp with coloured corners");
}

#[test]
fn light_passes_where_a_mask_leaves_nothing() {
    for (opacity, passed) in [(0.2, 1.0), (0.8, 0.0)] {
        let mut scene = lamp_over_floor(emitter(RADIANCE));
        // The sheet is just below the lamp, above the camera.
        let sheet = quad([-9.0, 1.05, 9.0], [18.0, 0.0, 0.0], [0.0, 0.0, -18.0], 2);
        scene.materials.push(Material {
            base_color: [0.0, 0.0, 0.0, opacity],
            alpha: Alpha::Mask(0.5),
            ..Default::default()
        });
        scene.meshes.push(sheet);
        scene.nodes.push(asvgf::scene::Node { meshes: vec![2], ..Default::default() });
        assert_floor_is_lit(&scene, passed, &format!("mask of opacity {opacity}"));
    }
}

#[test]
fn a_mask_may_come_from_a_texture() {
    let mut scene = lamp_over_floor(emitter(RADIANCE));
    let [[x0, x1], [z0, z1]] = LAMP.map(|r| r.map(|v| v as f32));
    // The sheet is right below the lamp and as large. Its left half is opaque, its right half is a hole.
    let y = HEIGHT as f32 - 1e-3;
    scene.images = vec![Image { width: 2, height: 1, texels: vec![[0, 0, 0, 255], [0; 4]], ..Default::default() }];
    scene.materials.push(Material {
        base_color_texture: Some(Texture { nearest: true, ..Texture::new(0) }),
        alpha: Alpha::Mask(0.5),
        ..Default::default()
    });
    scene.meshes.push(quad([x0, y, z0], [x1 - x0, 0.0, 0.0], [0.0, 0.0, z1 - z0], 2));
    scene.nodes.push(asvgf::scene::Node { meshes: vec![2], ..Default::default() });
    let half = [[0.5 * (LAMP[0][0] + LAMP[0][1]), LAMP[0][1]], LAMP[1]];
    let found = images(scene, below(), tracer(Sampling::Both, 0), 64);
    // The sheet is 1 mm below the lamp, an error of 0.2 % of the light that it lets through.
    channel(&found, 0).assert_is(expected(half, 0), 4e-3, "half a sheet");
}
