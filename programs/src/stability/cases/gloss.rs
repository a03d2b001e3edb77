//! Specular light in a host's frames. tests/gpu/host/gloss.rs tests every subset of the views.

use super::outliers::{self, noisy, tiles};
use super::painted::{GlossViews, Painted, Path, Views, adaptive, grey, with};
use super::{Breaks, Case, Named, Worst, unusable};
use crate::stability::common::statistics::{Rgb, mean};
use asvgf::{Camera, FilterSettings};

const SIZE: [u32; 2] = [24, 18];

pub const CASES: &[Case] = &[
    Case {
        name: "roughness, distance, reflectance, curvature",
        varied: "roughness 0, 1; distance 0, −1, NaN, 10⁻³⁰, 10³⁰, ∞; reflectance 0, 1, 2, 10, 1000; normals of a needle; everywhere and in pixels at random; \
            light without noise, before a camera that slides by ¾ pixel a frame",
        quantity: "largest relative difference of a pixel from diffuse and specular light together",
        bound: 4e-3,
        origin: "both histories of a pixel hold the same light, so the choice must not matter; histories have 13 bits, and taps 10",
        measure: constant,
        breaks: Breaks::Known("specular light of a surface whose reflectance is 0 is not shown"),
    },
    Case {
        name: "the same with noise",
        varied: "the same; specular light with noise of ±100 %, frames 8 to 39",
        quantity: "largest relative difference of the mean from that of the samples",
        bound: 0.02,
        origin: "the clamp takes in twice the third largest neighbour, and uniform noise is within twice its mean",
        measure: noise,
        breaks: Breaks::Known("light that few paths find: the clamp keeps some of it back, see docs/filter.md"),
    },
    Case {
        name: "a burst of specular outliers",
        varied: "12 pixels of 10¹⁰, 3.4·10³⁸, −5, NaN, ∞ in each of eight frames, in specular radiance",
        quantity: "largest relative difference of a tile of 12×12 pixels from a clean run, three frames later",
        bound: 0.02,
        origin: "a pixel whose sample is not believed has one sample fewer than in the clean run, and noise of its own",
        measure: bursts,
        breaks: Breaks::Found(bursts_break),
    },
    Case {
        name: "other settings of gloss in each frame",
        varied: "11 sets: powers 0, 64, luminance stops 0, 10⁶, clamps 0, 10⁻⁶, 10⁶, parallax 0, 1000, no outlier limit, no iterations; light by lobe, and one radiance",
        quantity: "pixels that are not finite and ≥ 0",
        bound: 0.0,
        origin: "all settings that `check` accepts are usable after any other",
        measure: settings,
        breaks: Breaks::Known("settings outside of their range, infinite and NaN are refused by name"),
    },
];

const DIFFUSE: Rgb = [0.5, 0.25, 1.5];
const SPECULAR: Rgb = [2.0, 0.75, 0.125];

/// A value of a view of specular light, for some of the pixels.
type Set = Named<fn(&mut GlossViews, &mut Vec<Rgb>, usize)>;

const SETS: [Set; 14] = [
    ("roughness 0", |v, _, i| v.roughness[i] = [0.0]),
    ("roughness 1", |v, _, i| v.roughness[i] = [1.0]),
    ("distance 0", |v, _, i| v.hit_distance[i] = [0.0]),
    ("distance −1", |v, _, i| v.hit_distance[i] = [-1.0]),
    ("distance NaN", |v, _, i| v.hit_distance[i] = [f32::NAN]),
    ("distance 10⁻³⁰", |v, _, i| v.hit_distance[i] = [1e-30]),
    ("distance 10³⁰", |v, _, i| v.hit_distance[i] = [1e30]),
    ("distance ∞", |v, _, i| v.hit_distance[i] = [f32::INFINITY]),
    ("reflectance 0", |v, _, i| v.reflectance[i] = [0.0; 3]),
    ("reflectance 1", |v, _, i| v.reflectance[i] = [1.0; 3]),
    ("reflectance 2", |v, _, i| v.reflectance[i] = [2.0; 3]),
    ("reflectance 10", |v, _, i| v.reflectance[i] = [10.0; 3]),
    ("reflectance 1000", |v, _, i| v.reflectance[i] = [1e3; 3]),
    // From one pixel to the next the normal turns by up to half a right angle.
    ("a needle's normals", |_, normals, i| normals[i] = [[-0.6, 0.0, 0.8], [0.0, 0.0, 1.0], [0.6, 0.0, 0.8]][i % 3]),
];

/// Predicate of the pixels that have the value.
type IsSet = fn(usize) -> bool;

const WHERE: [Named<IsSet>; 2] =
    [("everywhere", |_| true), ("at random", |i| Path { pixel: [i as u32, 0], seed: 0, frame: 0 }.uniform(9) < 0.5)];

/// Moves the camera along the wall, by ¾ of a pixel a frame.
fn slide(host: &mut Painted, views: &mut Views) {
    let pixel = 2.0 * 2.0 * 0.4_f64.tan() / f64::from(SIZE[1]);
    let x = 0.75 * pixel * f64::from(host.index);
    host.camera = Camera { eye: [x, 0.0, 0.0], target: [x, 0.0, -1.0], fov_y: 0.8, ..Default::default() };
    views.motion.fill([0.75, 0.0]);
}

/// Returns the next frame with a value in some of its pixels.
fn frame_of(host: &mut Painted, noise: bool, (_, set): Set, is_set: IsSet) -> Views {
    let light = |path: &Path, light: Rgb| if noise { light.map(|c| c * path.noise() as f32) } else { light };
    let mut views = host.glossy_views(&|path| light(path, DIFFUSE), &|path| light(path, SPECULAR));
    slide(host, &mut views);
    let Views { gloss: Some(gloss), normal, .. } = &mut views else { unreachable!("glossy views have gloss") };
    (0..normal.len()).filter(|&i| is_set(i)).for_each(|i| set(gloss, normal, i));
    // A surface that reflects more shows more light, and none shows more than all of it.
    for (light, reflectance) in gloss.radiance.iter_mut().zip(&gloss.reflectance) {
        *light = [0, 1, 2].map(|c| light[c] * reflectance[c].min(1.0));
    }
    for pair in &mut gloss.pairs {
        let lit = pair.iter_mut().zip(&gloss.reflectance).filter(|(light, _)| light[0] >= 0.0);
        lit.for_each(|(light, reflectance)| *light = [0, 1, 2].map(|c| light[c] * reflectance[c].min(1.0)));
    }
    views
}

/// Returns the light of a frame's samples.
fn samples(views: &Views) -> Vec<Rgb> {
    let gloss = views.gloss.as_ref().expect("glossy views");
    let lights = views.radiance.iter().zip(&gloss.radiance);
    lights.map(|(diffuse, specular)| [0, 1, 2].map(|c| diffuse[c] + specular[c])).collect()
}

fn constant() -> Worst {
    let mut worst = Worst::default();
    for (set, (place, is_set)) in SETS.into_iter().flat_map(|set| WHERE.map(|place| (set, place))) {
        let mut host = Painted::new(SIZE, adaptive());
        for frame in 0..8 {
            let views = frame_of(&mut host, false, set, is_set);
            let expected = samples(&views);
            let image = host.denoise(&views);
            let each = image.iter().zip(&expected).flat_map(|(found, expected)| {
                let largest = expected.iter().fold(0.0, |m: f32, x| m.max(*x));
                [0, 1, 2].map(|c| f64::from((found[c] - expected[c]).abs() / largest))
            });
            let off = each.fold(0.0, |m, d| if d.is_nan() { f64::INFINITY } else { f64::max(m, d) });
            worst.add(off, || format!("{}, {place}, frame {frame}", set.0));
        }
    }
    worst
}

fn noise() -> Worst {
    let mut worst = Worst::default();
    for (set, (place, is_set)) in SETS.into_iter().flat_map(|set| WHERE.map(|place| (set, place))) {
        let mut host = Painted::new(SIZE, adaptive());
        let mut sums = [0.0; 2];
        for frame in 0..40 {
            let views = frame_of(&mut host, true, set, is_set);
            let image = host.denoise(&views);
            if frame >= 8 {
                sums[0] += mean(&image);
                sums[1] += mean(&samples(&views));
            }
        }
        worst.add((sums[0] / sums[1] - 1.0).abs(), || format!("{}, {place}", set.0));
    }
    worst
}

/// Returns means over tiles of the last of 15 frames, in eight of which twelve pixels are spoilt.
fn last_of_burst(value: Option<f32>, everywhere: bool) -> Vec<f64> {
    let mut host = Painted::new(outliers::SIZE, adaptive());
    let mut image = Vec::new();
    for frame in 0..15 {
        let mut views = host.glossy_views(&noisy, &noisy);
        let count = views.depth.len() as f64;
        let gloss = views.gloss.iter_mut().filter(|_| (4..12).contains(&frame));
        for (gloss, value) in gloss.zip(value) {
            for k in 0..12 {
                let i = (Path { pixel: [k, 0], seed: frame, frame }.uniform(3) * count) as usize;
                gloss.radiance[i] = [value; 3];
                if everywhere {
                    gloss.reflectance[i] = [value; 3];
                    gloss.roughness[i] = [value];
                    gloss.hit_distance[i] = [value];
                    gloss.motion[i] = [value; 2];
                    gloss.pairs.iter_mut().for_each(|pair| pair[i] = [value; 3]);
                }
            }
        }
        image = host.denoise(&views);
    }
    tiles(&image)
}

/// Measures bursts of values, in radiance or in all views of specular light.
fn bursts_in(values: &[f32], everywhere: bool) -> Worst {
    let mut worst = Worst::default();
    let truth = last_of_burst(None, false);
    for &value in values {
        for (found, truth) in last_of_burst(Some(value), everywhere).iter().zip(&truth) {
            worst.add((found / truth - 1.0).abs(), || format!("{value:e}"));
        }
    }
    worst
}

fn bursts() -> Worst {
    bursts_in(&[1e10, f32::MAX, -5.0, f32::NAN, f32::INFINITY], false)
}

fn bursts_break() -> String {
    let part = |values: &[f32]| format!("{:.1} %", 100.0 * bursts_in(values, true).value);
    format!(
        "in all views of specular light at once: {} for values that are finite and above 1, {} for the others",
        part(&[1e10, f32::MAX]),
        part(&[-5.0, f32::NAN, f32::INFINITY])
    )
}

/// Returns filters at the limits of the accepted ranges.
fn extremes() -> Vec<FilterSettings> {
    let default = FilterSettings::default;
    vec![
        default(),
        FilterSettings { gloss_history_power: 0.0, ..default() },
        FilterSettings { gloss_history_power: 64.0, ..default() },
        FilterSettings { gloss_sigma_luminance: 0.0, ..default() },
        FilterSettings { gloss_sigma_luminance: 1e6, ..default() },
        FilterSettings { gloss_clamp: 0.0, ..default() },
        FilterSettings { gloss_clamp: 1e-6, ..default() },
        FilterSettings { gloss_clamp: 1e6, gloss_parallax: 1e3, ..default() },
        FilterSettings { gloss_parallax: 0.0, outlier_limit: 0.0, ..default() },
        FilterSettings { iterations: 0, gloss_parallax: 1e3, ..default() },
        FilterSettings { feedback: true, ..FilterSettings::classic() },
    ]
}

fn settings() -> Worst {
    let mut worst = Worst::default();
    for one_radiance in [false, true] {
        let mut host = Painted::new(SIZE, adaptive());
        for round in 0..3 {
            for (i, filter) in extremes().into_iter().enumerate() {
                host.denoiser.set_settings(with(filter)).unwrap();
                for _ in 0..=round {
                    let light = |path: &Path| grey(if path.frame % 7 == 3 { 0.0 } else { path.noise() });
                    let mut views = host.glossy_views(&light, &light);
                    slide(&mut host, &mut views);
                    views.gloss.iter_mut().for_each(|gloss| gloss.is_one_radiance = one_radiance);
                    worst.add(unusable(&host.denoise(&views)) as f64, || {
                        format!("round {round}, set {i}, one radiance: {one_radiance}")
                    });
                }
            }
        }
    }
    worst
}
