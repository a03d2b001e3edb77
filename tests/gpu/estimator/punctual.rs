//! Lights without area over a floor: they make no noise, so every pixel is compared.

use super::{floor_points, from_above, images, tracer};
use crate::common::plane::{V, dot, length, scale, sub};
use crate::common::scenes::{floor, lambert, scene, shine};
use asvgf::Sampling;
use asvgf::scene::{LightKind, Scene, Transform};
use std::f64::consts::PI;

const ALBEDO: f64 = 0.6;
const INTENSITY: [f32; 3] = [3.0, 2.0, 0.5];
const PLACE: [f32; 3] = [0.8, 1.7, -0.4];

fn unlit() -> Scene {
    let floor = floor(0);
    scene(vec![lambert([ALBEDO as f32; 3])], vec![floor])
}

fn lit_by(kind: LightKind, range: f32) -> Scene {
    let mut scene = unlit();
    shine(&mut scene, kind, INTENSITY, range, PLACE);
    scene
}

/// Compares all pixels with a radiance per unit of intensity.
fn assert_floor_shows(scene: Scene, expected: impl Fn(V) -> f64, what: &str) {
    for sampling in [Sampling::Both, Sampling::Lights] {
        let image = images(scene.clone(), from_above(), tracer(sampling, 2), 1).remove(0);
        for (color, point) in image.iter().zip(floor_points()) {
            for (c, i) in color.iter().zip(INTENSITY) {
                let expected = f64::from(i) * expected(point);
                // Near the border of a cone, only the difference of two cosines is left, so the error is absolute.
                let allowed = 2e-4 * expected + 1e-6;
                assert!((f64::from(*c) - expected).abs() <= allowed, "{what}, {point:?}: {c}, not {expected}");
            }
        }
        let lit = image.iter().filter(|c| c[0] > 0.0).count();
        assert!(lit > image.len() / 10, "{what}: too little light to compare");
    }
}

/// Inverse square of the distance and cosine on the floor, and the cosine at a light that shines down.
fn falloff(point: V) -> (f64, f64, f64) {
    let way = sub(PLACE.map(f64::from), point);
    let distance = length(way);
    let cosine = dot(scale(way, 1.0 / distance), [0.0, 1.0, 0.0]);
    (ALBEDO / PI * cosine / (distance * distance), distance, cosine)
}

#[test]
fn a_point_light_falls_off_with_the_square() {
    assert_floor_shows(lit_by(LightKind::Point, f32::INFINITY), |p| falloff(p).0, "point");
}

#[test]
fn a_range_ends_it_smoothly() {
    // KHR_lights_punctual: max(min(1 − (d / range)⁴, 1), 0) / d²
    let expected = |p: V| {
        let (plain, distance, _) = falloff(p);
        plain * (1.0 - (distance / 1.9).powi(4)).clamp(0.0, 1.0)
    };
    assert_floor_shows(lit_by(LightKind::Point, 1.9), expected, "range");
}

#[test]
fn without_a_range_it_does_not_end() {
    let mut scene = unlit();
    // This light is as bright as the directional light below.
    shine(&mut scene, LightKind::Point, INTENSITY.map(|i| i * 1e20), f32::INFINITY, [0.0, 1e10, 0.0]);
    assert_floor_shows(scene, |_| ALBEDO / PI, "a light far away");
}

#[test]
fn a_spot_fades_from_its_inner_to_its_outer_angle() {
    let (inner, outer) = (0.15_f32, 0.5_f32);
    let expected = |p: V| {
        let (plain, _, cosine) = falloff(p);
        let [full, none] = [inner, outer].map(|a| f64::from(a).cos());
        plain * ((cosine - none) / (full - none)).clamp(0.0, 1.0).powi(2)
    };
    assert_floor_shows(lit_by(LightKind::Spot { inner, outer }, f32::INFINITY), expected, "spot");
}

#[test]
fn a_spot_may_fade_all_the_way_or_reach_all_around() {
    // From the axis to the horizon, the cone's part of the light is cos².
    let whole = LightKind::Spot { inner: 0.0, outer: std::f32::consts::FRAC_PI_2 };
    let expected = |p: V| {
        let (plain, _, cosine) = falloff(p);
        plain * cosine * cosine
    };
    assert_floor_shows(lit_by(whole, f32::INFINITY), expected, "spot of half a sphere");
    let hard = LightKind::Spot { inner: 0.4, outer: 0.4 };
    assert!(lit_by(hard, f32::INFINITY).validate().is_err());
}

#[test]
fn a_narrow_spot_is_as_bright_in_its_middle_as_a_wide_one() {
    // KHR_lights_punctual: the intensity is the brightness inside the inner angle. The spot lights 1 m of the floor from 100 m above.
    let (inner, outer) = (0.003_f64, 0.01_f64);
    let mut scene = unlit();
    let place = [0.3, 100.0, 0.2];
    let kind = LightKind::Spot { inner: inner as f32, outer: outer as f32 };
    shine(&mut scene, kind, INTENSITY.map(|i| 1e4 * i), f32::INFINITY, place);
    let image = images(scene, from_above(), tracer(Sampling::Both, 0), 1).remove(0);
    for (color, point) in image.iter().zip(floor_points()) {
        let way = sub(place.map(f64::from), point);
        let angle = (way[0].hypot(way[2]) / way[1]).atan();
        let cone = ((angle.cos() - outer.cos()) / (inner.cos() - outer.cos())).clamp(0.0, 1.0).powi(2);
        let expected = f64::from(INTENSITY[0]) * 1e4 * ALBEDO / PI * angle.cos().powi(3) / (way[1] * way[1]) * cone;
        let found = f64::from(color[0]);
        // f32 leaves two digits of the difference of two cosines near 1.
        assert!((found - expected).abs() < 0.01, "{point:?}: {found}, not {expected}");
    }
}

#[test]
fn the_scale_of_a_node_changes_neither_intensity_nor_range_nor_cone() {
    let (inner, outer) = (0.15_f32, 0.5_f32);
    for scale in [[3.0; 3], [0.01, 0.01, 0.01], [2.0, 5.0, 0.5], [-2.0, 1.0, 4.0]] {
        let mut scene = lit_by(LightKind::Spot { inner, outer }, 1.9);
        let plain = images(scene.clone(), from_above(), tracer(Sampling::Both, 0), 1).remove(0);
        let node = scene.nodes.last_mut().unwrap();
        let Transform::Trs { scale: own, .. } = &mut node.transform else { unreachable!() };
        *own = scale;
        let scaled = images(scene, from_above(), tracer(Sampling::Both, 0), 1).remove(0);
        for (scaled, plain) in scaled.iter().zip(&plain) {
            assert!((scaled[0] - plain[0]).abs() <= 1e-4 * plain[0] + 1e-6, "{scale:?}: {scaled:?}, not {plain:?}");
        }
    }
}

#[test]
fn a_light_shines_along_minus_z_of_its_node() {
    // A node that is mirrored along z takes −Z of its space upwards.
    for (mirrored, lit) in [(false, true), (true, false)] {
        for kind in [LightKind::Directional, LightKind::Spot { inner: 0.15, outer: 0.5 }] {
            let mut scene = lit_by(kind, f32::INFINITY);
            let node = scene.nodes.last_mut().unwrap();
            let Transform::Trs { scale, .. } = &mut node.transform else { unreachable!() };
            scale[2] = if mirrored { -1.0 } else { 1.0 };
            let image = images(scene, from_above(), tracer(Sampling::Both, 0), 1).remove(0);
            assert_eq!(image.iter().any(|color| color[0] > 0.0), lit, "{kind:?}, mirrored: {mirrored}");
        }
    }
}

#[test]
fn a_directional_light_is_the_same_everywhere() {
    assert_floor_shows(lit_by(LightKind::Directional, f32::INFINITY), |_| ALBEDO / PI, "directional");
}

#[test]
fn two_lights_add_up() {
    let mut scene = lit_by(LightKind::Point, f32::INFINITY);
    shine(&mut scene, LightKind::Directional, INTENSITY, f32::INFINITY, [0.0; 3]);
    let images = images(scene, from_above(), tracer(Sampling::Both, 0), 64);
    let expected = super::over_floor(|p| falloff(p).0 + ALBEDO / PI) * f64::from(INTENSITY[0]);
    // Each path samples one of the two lights.
    super::channel(&images, 0).assert_is(expected, super::ROUNDING, "point and directional");
}
