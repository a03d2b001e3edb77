//! The three estimators have the same mean, and the combined one is never the worst.

use super::{ROUNDING, SAMPLINGS, channel, from_above, images, over_floor, tracer};
use crate::common::plane::{V, unit};
use crate::common::scenes::{emitter, floor, lambert, quad, scene};
use asvgf::Camera;
use asvgf::scene::{Environment, Material, Scene, builtin};
use std::f64::consts::PI;

/// Asserts that all samplings agree, and that the variance of `Both` is no worse than the worse of the others.
fn assert_agreement(scene: &Scene, camera: Camera, bounces: u32, what: &str) {
    let [both, lights, scattered] =
        SAMPLINGS.map(|s| channel(&images(scene.clone(), camera, tracer(s, bounces), 96), 1));
    println!("{what}: both {both:.5?}, lights {lights:.5?}, scattered {scattered:.5?}");
    both.assert_agrees(lights, ROUNDING, &format!("{what}, both and lights"));
    both.assert_agrees(scattered, ROUNDING, &format!("{what}, both and scattered"));
    // The error of an error from 96 images is 7 %.
    assert!(both.error <= 1.2 * lights.error.max(scattered.error), "{what}: weighting makes it worse");
}

#[test]
fn in_the_box_of_cornell() {
    for animation in ["static", "all"] {
        let scene = builtin::scene("cornell", animation).unwrap();
        let view = scene.camera_view(&scene.pose(None, 0.0), scene.camera_node().unwrap()).unwrap();
        let camera = Camera { fov_y: 0.4, ..view };
        assert_agreement(&scene, camera, 2, animation);
    }
}

/// A sky with a bright spot, and brighter to one side.
fn sky() -> Environment {
    let (width, height) = (8, 4);
    let radiance = (0..width * height).map(|i| [0.1 * i as f32, 0.05 + 0.02 * (i % 5) as f32, 0.3]).collect();
    let mut sky = Environment { width, height, radiance };
    sky.radiance[11] = [20.0, 15.0, 10.0];
    sky
}

/// Radiance of the sky in a direction by its documented mapping: u = ½ + atan2(z, x)/2π, v = acos(y)/π.
fn sky_radiance(sky: &Environment, d: V) -> f64 {
    let u = 0.5 + d[2].atan2(d[0]) / (2.0 * PI);
    let v = d[1].acos() / PI;
    let x = ((u * f64::from(sky.width)) as u32).min(sky.width - 1);
    let y = ((v * f64::from(sky.height)) as u32).min(sky.height - 1);
    sky.radiance[(y * sky.width + x) as usize][1].into()
}

#[test]
fn under_a_sky_with_a_bright_spot() {
    let floor = floor(0);
    let scene = Scene { environment: Some(sky()), ..scene(vec![lambert([0.6; 3])], vec![floor]) };
    assert_agreement(&scene, from_above(), 0, "sky");
    // Cosine-weighted mean over the upper half by the midpoint rule, in equal steps of cos² and azimuth.
    let (rows, columns) = (400, 800);
    let mut sum = 0.0;
    for i in 0..rows * columns {
        let y = ((f64::from(i / columns) + 0.5) / f64::from(rows)).sqrt();
        let azimuth = (f64::from(i % columns) + 0.5) / f64::from(columns) * 2.0 * PI;
        let r = (1.0 - y * y).sqrt();
        sum += sky_radiance(&sky(), unit([r * azimuth.cos(), y, r * azimuth.sin()]));
    }
    let expected = over_floor(|_| 0.6 * sum / f64::from(rows * columns));
    for sampling in SAMPLINGS {
        let found = channel(&images(scene.clone(), from_above(), tracer(sampling, 0), 96), 1);
        // The midpoint rule is wrong at the borders of texels, by a row in 400 at worst.
        found.assert_is(expected, 2e-3, &format!("sky, {sampling:?}"));
    }
}

#[test]
fn on_glossy_metal_and_coated_floors() {
    for (name, metallic, roughness) in [("metal", 1.0, 0.4), ("smoother metal", 1.0, 0.25), ("coat", 0.0, 0.5)] {
        let gloss = Material { metallic, roughness, specular: [0.04; 3], ..lambert([0.8, 0.6, 0.3]) };
        let floor = quad([-3.0, 0.0, 3.0], [6.0, 0.0, 0.0], [0.0, 0.0, -6.0], 0);
        let lamp = quad([-1.0, 1.5, -2.0], [2.0, 0.0, 0.0], [0.0, 0.5, 0.5], 1);
        let mut scene = scene(vec![gloss, Material { double_sided: true, ..emitter([4.0; 3]) }], vec![floor, lamp]);
        scene.environment = Some(sky());
        let camera = Camera { eye: [0.0, 1.2, 2.5], target: [0.0, 0.0, -0.2], fov_y: 0.3, ..Default::default() };
        assert_agreement(&scene, camera, 1, name);
    }
}
