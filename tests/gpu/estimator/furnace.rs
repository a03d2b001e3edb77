//! White furnaces: where the same light arrives from everywhere, the reflected light follows from the albedo alone.

use super::{ROUNDING, SAMPLINGS, channel, from_above, images, tracer};
use crate::common::scenes::{floor, lambert, quad, scene};
use asvgf::scene::{Environment, Material, Mesh, Scene};
use asvgf::{Camera, Sampling, TracerSettings};
use std::f64::consts::PI;

/// The inside of a cube of side 2 about the origin.
fn room(material: Material) -> Scene {
    let (p, m, d) = (1.0, -1.0, 2.0);
    let sides: [[[f32; 3]; 3]; 6] = [
        [[m, m, m], [0.0, 0.0, d], [d, 0.0, 0.0]],
        [[m, p, m], [d, 0.0, 0.0], [0.0, 0.0, d]],
        [[m, m, m], [d, 0.0, 0.0], [0.0, d, 0.0]],
        [[m, m, p], [0.0, d, 0.0], [d, 0.0, 0.0]],
        [[m, m, m], [0.0, d, 0.0], [0.0, 0.0, d]],
        [[p, m, m], [0.0, 0.0, d], [0.0, d, 0.0]],
    ];
    let meshes: Vec<Mesh> = sides.iter().map(|&[corner, u, v]| quad(corner, u, v, 0)).collect();
    scene(vec![material], meshes)
}

#[test]
fn a_room_of_glowing_walls_shows_the_partial_sums_of_the_albedos_powers() {
    let albedo = [0.8, 0.5, 0.2_f32];
    let material = Material { emissive: [1.0; 3], ..lambert(albedo) };
    let camera = Camera { eye: [0.1, -0.2, 0.3], target: [0.5, 0.1, -1.0], fov_y: 1.2, ..Default::default() };
    for sampling in SAMPLINGS {
        for bounces in [0, 1, 4] {
            let found = images(room(material.clone()), camera, tracer(sampling, bounces), 32);
            for (i, &a) in albedo.iter().enumerate() {
                // The sum of the wall's emission and of the light that it reflects after 1, 2 … bounces + 1 reflections.
                let expected: f64 = (0..=bounces + 1).map(|k| f64::from(a).powi(k as i32)).sum();
                channel(&found, i).assert_is(expected, ROUNDING, &format!("{sampling:?}, {bounces} bounces"));
            }
        }
    }
}

#[test]
fn roulette_changes_no_mean() {
    let material = Material { emissive: [1.0; 3], ..lambert([0.5; 3]) };
    let camera = Camera { eye: [0.1, -0.2, 0.3], target: [0.5, 0.1, -1.0], fov_y: 1.2, ..Default::default() };
    let settings = TracerSettings { roulette: 0, ..tracer(Sampling::Both, 64) };
    // The sum is Σ ½ᵏ over all k, to 2⁻⁶⁵.
    channel(&images(room(material), camera, settings, 64), 0).assert_is(2.0, ROUNDING, "roulette from the start");
}

/// A floor under a sky of radiance 1.
fn under_the_sky(material: Material) -> Scene {
    let floor = floor(0);
    Scene { environment: Some(Environment::uniform([1.0; 3])), ..scene(vec![material], vec![floor]) }
}

#[test]
fn a_flat_surface_under_a_white_sky_shows_its_albedo() {
    let albedo = [0.9, 0.3, 0.04_f32];
    for sampling in SAMPLINGS {
        let found = images(under_the_sky(lambert(albedo)), from_above(), tracer(sampling, 3), 32);
        for (i, &a) in albedo.iter().enumerate() {
            channel(&found, i).assert_is(a.into(), ROUNDING, &format!("{sampling:?}"));
        }
    }
}

/// Fraction of the light from everywhere that white GGX metal reflects in one scattering towards a viewer at this angle: the
/// integral of D·G₂/(4·cos) with height-correlated Smith masking (Heitz 2014, eq. 99), by the midpoint rule.
fn ggx_albedo(alpha: f64, view: f64) -> f64 {
    let lambda = |c: f64| 0.5 * ((1.0 + alpha * alpha * (1.0 - c * c) / (c * c)).sqrt() - 1.0);
    let steps = 600;
    let sine = (1.0 - view * view).sqrt();
    let mut sum = 0.0;
    for i in 0..steps {
        let z = (f64::from(i) + 0.5) / f64::from(steps);
        for j in 0..steps {
            let azimuth = (f64::from(j) + 0.5) / f64::from(steps) * PI;
            // The half vector's squared length is 2 + 2·cos of the angle between the two directions.
            let between = view * z + sine * (1.0 - z * z).sqrt() * azimuth.cos();
            let h = (view + z) / (2.0 + 2.0 * between).sqrt();
            let d = alpha * alpha / (PI * (h * h * (alpha * alpha - 1.0) + 1.0).powi(2));
            sum += d / (4.0 * view * (1.0 + lambda(view) + lambda(z)));
        }
    }
    sum * 2.0 * PI / f64::from(steps * steps)
}

#[test]
fn white_metal_reflects_what_one_scattering_leaves() {
    // At α = 1, seen from straight above, the integral is 1 − ln 2.
    assert!((ggx_albedo(1.0, 1.0) - (1.0 - 2.0_f64.ln())).abs() < 1e-5);
    for roughness in [0.5, 0.75, 1.0_f32] {
        for (eye, view) in
            [([0.0, 3.0, 0.0], 1.0), ([0.0, 1.8, 2.4], 0.6), ([0.0, 0.6, 2.4], 0.6_f64 / 6.12_f64.sqrt())]
        {
            let metal = Material { metallic: 1.0, roughness, ..lambert([1.0; 3]) };
            let up = [0.0, 0.5, -1.0];
            let camera = Camera { eye, target: [0.0; 3], up, fov_y: 0.01, ..Default::default() };
            let expected = ggx_albedo(f64::from(roughness).powi(2), view);
            for sampling in SAMPLINGS {
                let found = channel(&images(under_the_sky(metal.clone()), camera, tracer(sampling, 0), 48), 0);
                let what = format!("roughness {roughness}, cosine {view:.2}, {sampling:?}");
                found.assert_is(expected, 1e-3, &what);
            }
        }
    }
}

#[test]
fn a_mirror_loses_nothing() {
    let mirror = Material { metallic: 1.0, roughness: 0.0, ..lambert([1.0; 3]) };
    let grazing = Camera { eye: [0.0, 0.6, 3.0], target: [0.0; 3], fov_y: 0.1, ..Default::default() };
    for camera in [from_above(), grazing] {
        let found = channel(&images(under_the_sky(mirror.clone()), camera, tracer(Sampling::Scattered, 0), 16), 0);
        found.assert_is(1.0, 1e-3, "mirror");
    }
}
