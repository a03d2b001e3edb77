//! Clear coats against closed forms: what the coat mirrors, and what it leaves to the surface below it.

use super::{SAMPLINGS, channel, images, tracer};
use crate::common::scenes::{block, emitter, floor, glass, lambert, scene, textured_floor};
use crate::common::statistics::Estimate;
use asvgf::scene::{Clearcoat, Environment, Material, Scene, Texture};
use asvgf::{Camera, Sampling};

const BLACK: [f32; 3] = [0.0; 3];

fn coated(weight: f32, roughness: f32, below: Material) -> Material {
    Material { clearcoat: Clearcoat { weight, roughness, ..Default::default() }, ..below }
}

/// A camera all of whose rays meet the floor at this angle from its normal, in degrees. It looks along −Z.
fn at(angle: f64) -> Camera {
    let (sin, cos) = angle.to_radians().sin_cos();
    let up = [0.0, sin.max(0.1) as f32, -cos.max(0.1) as f32];
    Camera { eye: [0.2, 3.0 * cos, 3.0 * sin + 0.1], target: [0.2, 0.0, 0.1], up, fov_y: 0.002, ..Default::default() }
}

/// Schlick's reflectance of a coat whose index of refraction is 1.5.
fn mirrored(angle: f64) -> f64 {
    0.04 + 0.96 * (1.0 - angle.to_radians().cos()).powi(5)
}

fn under_the_sky(scene: Scene, camera: Camera, sampling: Sampling) -> Estimate {
    let scene = Scene { environment: Some(Environment::uniform([1.0; 3])), ..scene };
    channel(&images(scene, camera, tracer(sampling, 0), 24), 0)
}

const ANGLES: [f64; 4] = [0.0, 40.0, 70.0, 85.0];

#[test]
fn a_white_surface_under_a_coat_is_white_in_a_white_furnace() {
    for roughness in [0.0, 0.3, 1.0] {
        for angle in ANGLES {
            let mirror = Material { metallic: 1.0, roughness: 0.0, ..lambert([1.0; 3]) };
            for (below, name) in [(lambert([1.0; 3]), "matte"), (mirror, "a mirror"), (glass(1.5, 0.4, None), "glass")]
            {
                let scene = scene(vec![coated(0.8, roughness, below)], vec![floor(0)]);
                for sampling in [Sampling::Both, Sampling::Scattered] {
                    let found = under_the_sky(scene.clone(), at(angle), sampling);
                    found.assert_is(1.0, 2e-3, &format!("{name}, roughness {roughness}, {angle}°, {sampling:?}"));
                }
            }
        }
    }
}

#[test]
fn a_coat_mirrors_as_schlick_says_and_leaves_the_rest() {
    for (weight, color) in [(1.0, 0.0), (0.5, 0.0), (1.0, 0.6_f32)] {
        for (roughness, angle) in [(0.0, 0.0), (0.5, 40.0), (0.2, 70.0), (1.0, 85.0)] {
            let scene = scene(vec![coated(weight, roughness, lambert([color; 3]))], vec![floor(0)]);
            let coat = f64::from(weight) * mirrored(angle);
            let expected = coat + (1.0 - coat) * f64::from(color);
            for sampling in SAMPLINGS {
                if sampling == Sampling::Lights && roughness < 0.3 {
                    // Light samples alone miss narrow lobes.
                    continue;
                }
                let found = under_the_sky(scene.clone(), at(angle), sampling);
                found.assert_is(expected, 3e-3, &format!("{weight} over {color}, {roughness}, {angle}°, {sampling:?}"));
            }
        }
    }
}

#[test]
fn a_coat_lies_over_what_the_surface_emits() {
    for angle in ANGLES {
        let scene = scene(vec![coated(1.0, 0.1, emitter([2.0; 3]))], vec![floor(0)]);
        let found = channel(&images(scene, at(angle), tracer(Sampling::Both, 0), 4), 0);
        found.assert_is(2.0 * (1.0 - mirrored(angle)), 1e-3, &format!("{angle}°"));
    }
}

#[test]
fn a_coat_of_a_body_of_glass_loses_no_light() {
    let white = coated(1.0, 0.2, glass(1.5, 0.0, Some(BLACK)));
    let plate = scene(vec![white], block([-9.0, -1.0, -9.0], [9.0, 0.0, 9.0], 0));
    let inside = Camera { eye: [0.2, -0.4, 0.1], target: [0.9, 0.0, -0.2], ..at(0.0) };
    for (camera, place) in [(at(40.0), "outside"), (inside, "inside")] {
        for sampling in SAMPLINGS {
            let found = under_the_sky(plate.clone(), camera, sampling);
            found.assert_is(1.0, 2e-3, &format!("{place}, {sampling:?}"));
        }
    }
}

#[test]
fn textures_of_a_coat_have_their_channels() {
    let texture = Some(Texture::new(0));
    let weighted = Clearcoat { weight: 0.9, weight_texture: texture, ..Default::default() };
    let found = under_the_sky(
        textured_floor([102, 255, 0], Material { clearcoat: weighted, ..lambert(BLACK) }),
        at(60.0),
        Sampling::Both,
    );
    found.assert_is(0.9 * 0.4 * mirrored(60.0), 2e-3, "red is the weight");
    // Under a sun off the mirrored direction, a coat shines if it is rough.
    let coat = Clearcoat { weight: 1.0, roughness: 1.0, roughness_texture: texture, ..Default::default() };
    let lit = |green: u8| {
        let mut scene = textured_floor([255, green, 255], Material { clearcoat: coat, ..lambert(BLACK) });
        let kind = asvgf::scene::LightKind::Directional;
        crate::common::scenes::shine(&mut scene, kind, [1.0; 3], f32::INFINITY, [0.0; 3]);
        channel(&images(scene, at(30.0), tracer(Sampling::Both, 0), 4), 0).mean
    };
    assert!(lit(0) < 1e-6 && lit(255) > 1e-3, "green is the roughness: {} and {}", lit(0), lit(255));
}

#[test]
fn a_coat_has_a_normal_map_of_its_own() {
    let texel = [190, 128, 238];
    let [x, _, z] = texel.map(|byte| f64::from(byte) / 127.5 - 1.0);
    let tilt = x.atan2(z).to_degrees();
    let texture = Some(Texture::new(0));
    let of_coat = Clearcoat { weight: 1.0, normal_texture: texture, ..Default::default() };
    let flat = Clearcoat { normal_texture: None, ..of_coat };
    for (clearcoat, normal_texture, angle, what) in [
        (of_coat, None, tilt, "its own map tilts the coat"),
        (flat, texture, 0.0, "the map of the surface does not"),
        (Clearcoat { normal_scale: 0.0, ..of_coat }, None, 0.0, "a scale of 0 flattens it"),
    ] {
        let material = Material { clearcoat, normal_texture, ..lambert(BLACK) };
        let found = under_the_sky(textured_floor(texel, material), at(0.0), Sampling::Both);
        found.assert_is(mirrored(angle), 3e-3, what);
    }
}
