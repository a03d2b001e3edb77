//! The GPU's light samples of an environment against the picture itself.

use super::compute::compute_with;
use super::gpu::gpu;
use super::random::Random;
use crate::passes::trace;
use crate::plan::{Feature, Features};
use crate::scene::{Environment, GpuScene, Scene, pack, unpack};
use std::f64::consts::PI;

const SAMPLES: usize = 960_000;

/// Relative luminance of linear Rec. 709 colour (ITU-R BT.709-6).
fn luminance(c: [f32; 3]) -> f64 {
    let [r, g, b] = c.map(f64::from);
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// A picture that is brighter above, coloured, and black in places, with a sun of one texel.
fn picture(width: u32, height: u32) -> Environment {
    let texel = |i: u32| {
        let (x, y) = (i % width, i / width);
        let up = 1.0 - y as f32 / height as f32;
        if x % 11 == 3 { [0.0; 3] } else { [0.2 + up, 0.5 + up * up, 1.0 + (x % 5) as f32 * 0.1] }
    };
    let mut radiance: Vec<[f32; 3]> = (0..width * height).map(texel).collect();
    let sun = height / 4 * width + width * 2 / 3;
    // The sun is about as strong as all the rest together.
    radiance[sun as usize] = [1.0, 0.9, 0.7].map(|c| c * (width * height) as f32);
    Environment { width, height, radiance }
}

/// Light samples: direction, density, radiance.
fn draw(environment: &Environment, numbers: &[[f32; 4]]) -> Vec<[[f32; 4]; 2]> {
    let scene = Scene { environment: Some(environment.clone()), ..Default::default() };
    let uploaded = GpuScene::new(&gpu().device, &gpu().queue, &scene).unwrap();
    let features = Features::of(&[Feature::Lights, Feature::EnvironmentLight]);
    let results =
        compute_with(include_str!("sky.wgsl"), &trace::PASS, features, numbers, 2 * numbers.len(), &|binding| {
            uploaded.resource(binding)
        });
    results.as_chunks::<2>().0.to_vec()
}

fn check(width: u32, height: u32) {
    let environment = picture(width, height);
    let mut random = Random(5);
    // The numbers have 24 bits, like the path tracer's.
    let mut number = || ((random.unit() * 16_777_216.0) as u32 as f32) / 16_777_216.0;
    let numbers: Vec<[f32; 4]> = (0..SAMPLES).map(|_| [number(), number(), number(), 0.0]).collect();
    let seen: Vec<[f32; 3]> = environment.radiance.iter().map(|&c| unpack(pack(c))).collect();
    let edge = |row: u32| (PI * f64::from(row) / f64::from(height)).cos();
    let solid_angle = |row: u32| 2.0 * PI / f64::from(width) * (edge(row) - edge(row + 1));
    let total: f64 = (0..width * height).map(|i| luminance(seen[i as usize]) * solid_angle(i / width)).sum();
    let sun = height / 4 * width + width * 2 / 3;

    // Count the samples by regions of the picture, with the sun as its own.
    const SIDE: u32 = 8;
    let region = |i: u32| {
        if i == sun { SIDE * SIDE } else { i / width * SIDE / height * SIDE + i % width * SIDE / width }
    };
    let mut expected = vec![0.0; (SIDE * SIDE + 1) as usize];
    for i in 0..width * height {
        expected[region(i) as usize] += luminance(seen[i as usize]) * solid_angle(i / width) / total;
    }
    let mut found = vec![0.0; expected.len()];
    let mut at_edges = 0;
    for [[x, y, z, density], [r, g, b, _]] in draw(&environment, &numbers) {
        let (u, v) = (0.5 + f64::from(z).atan2(f64::from(x)) / (2.0 * PI), f64::from(y).clamp(-1.0, 1.0).acos() / PI);
        let (u, v) = (u * f64::from(width), v * f64::from(height));
        let texel = (v as u32).min(height - 1) * width + (u as u32).min(width - 1);
        found[region(texel) as usize] += 1.0 / SAMPLES as f64;
        // A direction in f32 may lie on the other side of a texel's edge.
        let precise = 1e-6 * f64::from(width) / f64::from(x).hypot(f64::from(z)).max(1e-9);
        let near = |t: f64, precise: f64| (t - t.round()).abs() < precise;
        if near(u, precise) || near(v, precise) {
            at_edges += 1;
            continue;
        }
        assert_eq!([r, g, b], seen[texel as usize], "radiance of {texel}");
        let exact = luminance([r, g, b]) / total;
        assert!((f64::from(density) / exact - 1.0).abs() < 1e-5, "{density}, not {exact}");
    }
    assert!(at_edges < SAMPLES / 20, "{at_edges} samples at edges");
    for (i, (&p, &q)) in expected.iter().zip(&found).enumerate() {
        let error = (p * (1.0 - p) / SAMPLES as f64).sqrt();
        assert!((p - q).abs() <= 4.5 * error + 1e-7, "{width} × {height}, region {i}: {q}, not {p} ± {error}");
    }
    println!("{width} × {height}: the sun has {:.5} of the samples, {:.5} of the light", found[64], expected[64]);
}

#[test]
fn texels_are_chosen_by_their_light() {
    for [width, height] in [[8, 8], [37, 19], [512, 256]] {
        check(width, height);
    }
}

#[test]
fn texels_of_pictures_with_more_texels_than_cells_too() {
    // The runs have 2 and 8 texels, and the last one of a row is shorter.
    for [width, height] in [[1030, 515], [2100, 1100]] {
        check(width, height);
    }
}
