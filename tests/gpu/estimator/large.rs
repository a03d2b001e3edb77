//! Environments with more texels than the table has cells, and images larger than a storage binding.

use super::{ROUNDING, SAMPLINGS, SIZE, channel, from_above, images, tracer};
use crate::common::scenes::{floor, lambert, quad, scene};
use crate::common::stage::Stage;
use crate::common::statistics::{Estimate, Rgb};
use asvgf::scene::{Environment, Image, Material, Scene, Texture};
use asvgf::{Mode, Sampling, Settings};
use std::f64::consts::PI;

const ALBEDO: f64 = 0.6;

/// A floor in the middle of an environment.
fn floor_under(environment: Environment) -> Scene {
    let floor = floor(0);
    Scene { environment: Some(environment), ..scene(vec![lambert([ALBEDO as f32; 3])], vec![floor]) }
}

/// Radiance that the floor reflects. The integral of the cosine over a texel is 2π/width · ½ (cos² of its row's upper edge − cos²
/// of its lower edge).
fn reflected(environment: &Environment, channel: usize) -> f64 {
    let (width, height) = (environment.width as usize, f64::from(environment.height));
    let squared = |row: usize| (PI * (row as f64 / height).min(0.5)).cos().powi(2);
    let rows = environment.radiance.chunks(width).enumerate();
    let irradiance = rows.map(|(row, texels)| {
        let sum: f64 = texels.iter().map(|c| f64::from(c[channel])).sum();
        sum * PI / width as f64 * (squared(row) - squared(row + 1))
    });
    ALBEDO / PI * irradiance.sum::<f64>()
}

/// A sky that is brighter to one side and above, and black in places.
fn sky(width: u32, height: u32) -> Environment {
    let texel = |i: u32| {
        let (x, y) = ((i % width) as f32 / width as f32, (i / width) as f32 / height as f32);
        if (25.0 * x) as u32 % 5 == 3 { [0.0; 3] } else { [1.0 - y, 0.5 + x * x, 0.3 + x * y] }
    };
    Environment { width, height, radiance: (0..width * height).map(texel).collect() }
}

/// Adds a sun of one texel, half way up, ten times as bright as all the rest.
fn add_sun(sky: &mut Environment) {
    let texel = sky.height / 4 * sky.width + sky.width / 3;
    let radiance = 5.0 * (sky.width * sky.height) as f32;
    sky.radiance[texel as usize] = [radiance, 0.9 * radiance, 0.7 * radiance];
}

/// The same picture with each texel repeated in both directions.
fn repeated(sky: &Environment, times: u32) -> Environment {
    let (width, height) = (sky.width * times, sky.height * times);
    let texel = |i: u32| sky.radiance[(i / width / times * sky.width + i % width / times) as usize];
    Environment { width, height, radiance: (0..width * height).map(texel).collect() }
}

#[test]
fn a_floor_reflects_what_a_large_sky_sheds_on_it() {
    let mut sky = sky(2100, 1100);
    for sampling in SAMPLINGS {
        let found = images(floor_under(sky.clone()), from_above(), tracer(sampling, 0), 96);
        for i in 0..3 {
            // The texel that a scattered ray finds depends on the adapter's arc functions; lavapipe's are precise to some 10⁻⁴.
            channel(&found, i).assert_is(reflected(&sky, i), 5e-4, &format!("large sky, {sampling:?}"));
        }
    }
    add_sun(&mut sky);
    for sampling in [Sampling::Both, Sampling::Lights] {
        let found = images(floor_under(sky.clone()), from_above(), tracer(sampling, 0), 96);
        for i in 0..3 {
            let found = channel(&found, i);
            println!("sun, {sampling:?}: {found:?}, exactly {}", reflected(&sky, i));
            found.assert_is(reflected(&sky, i), ROUNDING, &format!("large sky with a sun, {sampling:?}"));
            assert!(found.error < 2e-3 * found.mean, "a sun of one texel is found");
        }
    }
}

#[test]
fn more_texels_of_the_same_light_change_nothing() {
    let mut small = sky(525, 275);
    add_sun(&mut small);
    let expected = reflected(&small, 1);
    // The cells have one texel, two, and eight.
    let found = [1, 2, 4].map(|times| {
        let large = repeated(&small, times);
        assert!((reflected(&large, 1) / expected - 1.0).abs() < 1e-9);
        channel(&images(floor_under(large), from_above(), tracer(Sampling::Lights, 0), 96), 1)
    });
    println!("{found:?}, exactly {expected}");
    for estimate in found {
        estimate.assert_is(expected, ROUNDING, "repeated");
        // The noise is the same, so the table tells the texels of a cell apart. The error of an error from 96 images is 7 %.
        assert!((estimate.error / found[0].error - 1.0).abs() < 0.25, "the noise is another: {found:?}");
    }
}

/// Mean of the images under a sky of this size, and the bytes of the scene.
fn under_a_sky_of(width: u32, height: u32) -> (Estimate, f64, u64) {
    let mut sky = Environment { width, height, radiance: vec![[0.5; 3]; (width * height) as usize] };
    add_sun(&mut sky);
    let expected = reflected(&sky, 1);
    let settings = Settings { mode: Mode::Noisy, tracer: tracer(Sampling::Both, 0), ..Settings::adaptive() };
    let mut stage = Stage::new(floor_under(sky), SIZE, settings);
    stage.camera = Some(from_above());
    let pose = stage.pose_at(0);
    let images: Vec<Vec<Rgb>> = (0..48).map(|_| stage.frame_in(&pose).image()).collect();
    (channel(&images, 1), expected, stage.uploaded.memory())
}

#[test]
fn skies_of_4096_and_8192_texels_fit_the_default_limits() {
    for [width, height] in [[4096, 2048], [8192, 4096]] {
        let (found, expected, memory) = under_a_sky_of(width, height);
        found.assert_is(expected, ROUNDING, &format!("{width} × {height}"));
        assert!(found.error < 4e-3 * found.mean, "a sun of one texel is found");
        let bytes = u64::from(width * height * 8);
        assert!((bytes..bytes + (18 << 20)).contains(&memory), "{memory} bytes");
    }
}

#[test]
fn a_sky_that_is_too_wide_is_named() {
    let sky = Environment { width: 8193, height: 1, radiance: vec![[1.0; 3]; 8193] };
    let gpu = crate::common::gpu::gpu();
    let error = asvgf::scene::GpuScene::new(&gpu.device, &gpu.queue, &floor_under(sky)).unwrap_err();
    assert_eq!(error.element, "environment");
    assert!(error.reason.contains("scale the picture down") && !error.reason.contains("triangle"), "{error}");
}

#[test]
fn six_images_of_4096_texels_a_side_fit_the_default_limits() {
    const COUNT: u32 = 6;
    const SIDE: u32 = 4096;
    let at = |i: u32| [(700 * i + 5) % SIDE, (SIDE - 1).wrapping_sub(31 * i) % SIDE];
    let color = |i: u32| [40 * i as u8 + 10, 255 - 30 * i as u8, 100 + i as u8, 255];
    let image = |i: u32| {
        let mut texels = vec![[0, 0, 0, 255]; (SIDE * SIDE) as usize];
        let [x, y] = at(i);
        texels[(y * SIDE + x) as usize] = color(i);
        Image { width: SIDE, height: SIDE, texels, ..Default::default() }
    };
    // Each material shows one texel of its image; all others are black.
    let material = |i: u32| {
        let constant = |x: u32| [0.0, 0.0, (x as f32 + 0.5) / SIDE as f32];
        let transform = at(i).map(constant);
        let texture = Texture { transform, nearest: true, ..Texture::new(i as usize) };
        Material { base_color_texture: Some(texture), unlit: true, ..Default::default() }
    };
    // The meshes are stripes from left to right.
    let (left, width) = (0.3 - 3.0 * 0.15_f32.tan() * 1.5, 3.0 * 0.15_f32.tan() * 3.0 / COUNT as f32);
    let stripe = |i: u32| quad([left + i as f32 * width, 0.0, 9.0], [width, 0.0, 0.0], [0.0, 0.0, -18.0], i as usize);
    let scene = scene((0..COUNT).map(material).collect(), (0..COUNT).map(stripe).collect());
    let scene = Scene { images: (0..COUNT).map(image).collect(), ..scene };
    let settings = Settings { mode: Mode::Noisy, ..Settings::adaptive() };
    let mut stage = Stage::new(scene, SIZE, settings);
    stage.camera = Some(from_above());
    assert!(stage.uploaded.contents().folded_images);
    let picture = stage.frame().image();
    let linear = |c: u8| ((f64::from(c) / 255.0 + 0.055) / 1.055).powf(2.4);
    for i in 0..COUNT {
        let pixel = picture[(SIZE[1] / 2 * SIZE[0] + (2 * i + 1) * SIZE[0] / COUNT / 2) as usize];
        for (found, encoded) in pixel.into_iter().zip(color(i)) {
            // Below 10.3 of 255, the sRGB curve is a line.
            let expected = if encoded > 10 { linear(encoded) } else { f64::from(encoded) / 255.0 / 12.92 };
            assert!((f64::from(found) - expected).abs() < 1e-3, "image {i}: {pixel:?}, not {:?}", color(i));
        }
    }
    let bytes = u64::from(COUNT * SIDE * SIDE * 4);
    assert!((bytes..bytes + (1 << 20)).contains(&stage.uploaded.memory()), "{} bytes", stage.uploaded.memory());
}
