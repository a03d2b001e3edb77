//! One spatial iteration: l̂(p) = Σ h·w·l(q) / Σ h·w.

use super::bench::{Bench, SIZES, Texel};
use super::codec::{
    assert_close, depth, luminance, pack_reflection, pack_tap, radiance, unpack_normal, unpack_reflection, unpack_rgb,
    unpack_tap,
};
use super::plane::{V, add, dot, scale, sub};
use super::random::Random;
use super::strata::falloff;
use crate::passes::{Nth, Step, atrous};
use crate::plan::{Feature, Features};
use crate::{FilterSettings, Settings, Stops};

/// Filters a pixel by the documented formulas: colour, standard deviation, and the plain mean; the pixel's own values if it has
/// converged. `image` has colour and deviation in the first half of its texels, normal and depth in the second.
pub(super) fn twin(bench: &Bench, features: Features, iteration: u32, image: &[Texel], x: i32, y: i32) -> (V, f64, V) {
    glossy_twin(bench, features, iteration, image, &[], [x, y])
}

/// The exponent that only specular light has, for a tap this many pixels away: unlike roughnesses, and beyond twice the width of the lobe,
/// f·α·h/(z + h) = α/|du|·h/(z + h).
fn gloss_stop(bench: &Bench, [own, other]: [[u32; 2]; 2], reflected: f64, pixels: f64) -> f64 {
    let roughness = |guide: [u32; 2]| f64::from((guide[1] & 255) - 1) / 254.0;
    let focal = f64::from(bench.size[1]) / (2.0 * (f64::from(bench.camera.fov_y) / 2.0).tan());
    let width = focal * roughness(own).powi(2) * reflected / (depth(own) + reflected);
    ((roughness(other) - roughness(own)) / 0.05).powi(2) + 0.5 * (pixels / (2.0 * width).max(2.0)).powi(2)
}

/// The same of specular light, of which the pass also knows the distances of what is reflected.
fn glossy_twin(
    bench: &Bench,
    features: Features,
    iteration: u32,
    image: &[Texel],
    reflected: &[f64],
    [x, y]: [i32; 2],
) -> (V, f64, V) {
    let f = &bench.settings.filter;
    let glossy = features.has(Feature::SpecularSignal);
    let sigma_luminance = f64::from(if glossy { f.gloss_sigma_luminance } else { f.sigma_luminance });
    let stride = 1 << iteration;
    let guide = |i: usize| [image[i][2], image[i][3]];
    let here = bench.at(x, y).unwrap();
    let (normal, z) = (unpack_normal(guide(here)[0]), depth(guide(here)));
    let (own, deviation) = unpack_tap(image[here]);
    let position = bench.position(x, y, z);
    let existing = |x: i32, y: i32| bench.at(x, y).filter(|&i| depth(guide(i)) > 0.0);
    let mut variance = deviation * deviation;
    if features.has(Feature::FirstIteration) {
        // The variance is smoothed by (1 2 1)² over the neighbours that exist.
        let (mut sum, mut weights) = (0.0, 0.0);
        for (dx, dy) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy))) {
            if let Some(i) = existing(x + dx, y + dy) {
                let w = f64::from((2 - dx.abs()) * (2 - dy.abs()));
                sum += w * unpack_tap(image[i]).1.powi(2);
                weights += w;
            }
        }
        variance = sum / weights;
    }
    if variance <= (f64::from(f.converged) * luminance(own)).powi(2) {
        return (own, deviation, own);
    }
    let spline = |d: i32| [1.0, 2.0 / 3.0, 1.0 / 6.0][d.unsigned_abs() as usize];
    let mut taps: Vec<Tap> = vec![(1.0, [0.0; 2], own, deviation * deviation)];
    for (dx, dy) in (-2..=2).flat_map(|dy: i32| (-2..=2).map(move |dx: i32| (dx, dy))) {
        let within = if features.has(Feature::SmallKernel) {
            dx.abs().max(dy.abs()) <= 1
        } else {
            features.has(Feature::FullKernel) || dx.abs() + dy.abs() <= 2
        };
        if (dx, dy) == (0, 0) || !within {
            continue;
        }
        let Some(i) = existing(x + dx * stride, y + dy * stride) else { continue };
        let (color, other_deviation) = unpack_tap(image[i]);
        let other = other_deviation * other_deviation;
        let cosine = dot(normal, unpack_normal(guide(i)[0]));
        let difference = luminance(color) - luminance(own);
        let far = depth(guide(i));
        let pixels = f64::from(stride) * f64::from(dx).hypot(f64::from(dy));
        let of_gloss = if glossy { gloss_stop(bench, [guide(here), guide(i)], reflected[here], pixels) } else { 0.0 };
        let stop = if features.has(Feature::ClassicStops) {
            // ∇z·Δp of the tangent plane: d(1/z) is affine in the pixel, so z's derivative is −z·(n·∂ray)/(n·ray).
            let moved = sub(bench.ray(x + dx * stride, y + dy * stride), bench.ray(x, y));
            let along = dot(normal, bench.ray(x, y));
            let along = if along.abs() < 1e-4 { -1e-4 } else { along };
            let change = (z * dot(normal, moved) / along).abs();
            let exponent = (far - z).abs() / (f64::from(f.sigma_depth) * change + 1e-3 * z)
                + difference.abs() / (sigma_luminance * variance.sqrt() + 1e-6 * luminance(own) + 1e-37)
                + of_gloss;
            cosine.clamp(0.0, 1.0).powf(f.sigma_normal.into()) * (-exponent).exp()
        } else {
            let there = bench.position(x + dx * stride, y + dy * stride, far);
            let distance = dot(normal, sub(there, position)).abs() / (f64::from(f.sigma_depth) * z);
            let excess = (difference * difference - variance - variance.min(other)).max(0.0);
            let sigma = sigma_luminance.powi(2);
            let slant = f64::from(f.sigma_foreshortening) * foreshortening(bench, [x, y], [dx, dy], normal);
            let exponent = slant
                + distance
                + f64::from(f.sigma_normal) * (1.0 - cosine)
                + excess / (sigma * (variance + other) + 1e-37)
                + of_gloss;
            falloff(exponent)
        };
        taps.push((spline(dx) * spline(dy) * stop, [dx, dy].map(f64::from), color, other));
    }
    let weight: f64 = taps.iter().map(|t| t.0).sum();
    let mean = scale(taps.iter().fold([0.0; 3], |s, t| add(s, scale(t.2, t.0))), 1.0 / weight);
    let spread = taps.iter().map(|t| t.0 * t.0 * t.3).sum::<f64>().sqrt() / weight;
    let noise = features.has(Feature::RidgeByNoise).then_some(f64::from(f.ridge_noise));
    let color =
        if features.has(Feature::LocalLinearFit) { fit(&taps, weight, mean, f.ridge.into(), noise) } else { mean };
    (color, spread, mean)
}

/// Foreshortening: the length of a step on the tangent plane through a pixel, divided by its length on a plane that faces the
/// camera, both a unit away. Rays are affine in the pixel and meet the plane at different depths, so the limit of their difference
/// is the derivative of ray/(n·ray).
fn foreshortening(bench: &Bench, [x, y]: [i32; 2], [dx, dy]: [i32; 2], normal: V) -> f64 {
    let ray = bench.ray(x, y);
    let step = sub(bench.ray(x + dx, y + dy), ray);
    let facing = match dot(normal, ray) {
        small if small.abs() < 1e-4 => -1e-4,
        facing => facing,
    };
    let moved = sub(step, scale(ray, dot(normal, step) / facing));
    ((dot(moved, moved) / dot(step, step)).sqrt() - 1.0).max(0.0)
}

/// A tap: weight, offset in strides, colour, variance.
type Tap = (f64, [f64; 2], V, f64);

/// Weighted least squares of a plane with a ridge on its slopes: the value at the centre, within half and one and a half of
/// the mean. With `noise`, the ridge follows the variance of Σw·(x − m)·l/Σw, and of the same in y, over the square of the
/// slope of the luminance l.
fn fit(taps: &[Tap], weight: f64, mean: V, ridge: f64, noise: Option<f64>) -> V {
    let average = |g: &dyn Fn(&Tap) -> f64| taps.iter().map(|t| t.0 * g(t)).sum::<f64>() / weight;
    let m = [0, 1].map(|i| average(&|t| t.1[i]));
    let ridge = noise.map_or(ridge, |noise| {
        let slope = [0, 1].map(|i| average(&|t| (t.1[i] - m[i]) * luminance(t.2)));
        let far = |t: &Tap| (t.1[0] - m[0]).powi(2) + (t.1[1] - m[1]).powi(2);
        let variance = taps.iter().map(|t| (t.0 / weight).powi(2) * t.3 * far(t)).sum::<f64>();
        ridge * (noise * variance / (slope[0].powi(2) + slope[1].powi(2) + 1e-37)).clamp(0.5, 8.0)
    });
    let covariance = |i: usize, j: usize| average(&|t| (t.1[i] - m[i]) * (t.1[j] - m[j]));
    let (a, b, c) = (covariance(0, 0) + ridge, covariance(0, 1), covariance(1, 1) + ridge);
    [0, 1, 2].map(|channel| {
        let [x, y] = [0, 1].map(|i| average(&|t| (t.1[i] - m[i]) * (t.2[channel] - mean[channel])));
        let determinant = a * c - b * b;
        let slopes = [(c * x - b * y) / determinant, (a * y - b * x) / determinant];
        let value = mean[channel] - slopes[0] * m[0] - slopes[1] * m[1];
        value.clamp(0.5 * mean[channel], 1.5 * mean[channel])
    })
}

fn check(settings: &Settings, features: &[Feature], iteration: u32) {
    let features = Features::of(features);
    let features = if iteration == 0 { features.with(Feature::FirstIteration) } else { features };
    check_step(settings, &Step::nth(&atrous::PASS, features, Nth::iteration(iteration)));
}

fn check_step(settings: &Settings, step: &Step) {
    let iteration = step.iteration;
    let glossy = step.features.has(Feature::SpecularSignal);
    for size in SIZES {
        let bench = Bench::new(size, settings.clone());
        let mut random = Random(u64::from(size[0]) + 100 * u64::from(iteration));
        let image: Vec<Texel> = bench
            .guide(&mut random)
            .into_iter()
            .map(|g| match g {
                [_, 0] => [0; 4],
                // Deviations go from 0 to far beyond the colour.
                _ => {
                    let [a, b] = pack_tap(radiance(&mut random), random.unit().powi(4) * 3.0);
                    if !glossy {
                        return [a, b, g[0], g[1]];
                    }
                    // The depth of specular light ends with the code of the roughness: a mirror's, the roughest, and those between.
                    let code = [1, 255, 100, 101, 105, 1 + random.below(255) as u32][random.below(6)];
                    [a, b, g[0], g[1] & !255 | code]
                }
            })
            .collect();
        // What is reflected touches the surface, or is the sky, or is anywhere between.
        let codes: Vec<[u32; 2]> = image
            .iter()
            .map(|_| {
                let distance = [0.0, 1e-9, 8e9, 0.3, 4.0, random.between(0.0, 10.0)][random.below(6)];
                pack_reflection([random.between(-9.0, 9.0), 0.0, distance], 1)
            })
            .collect();
        let reflected: Vec<f64> = codes.iter().map(|&code| unpack_reflection(code)[2]).collect();
        let half = |first: usize| image.iter().map(|t| [t[first], t[first + 1], 0, 0]).collect::<Vec<Texel>>();
        let mut inputs = vec![("color", half(0)), ("guide", half(2))];
        if glossy {
            inputs.push(("reflection", codes.iter().map(|c| [c[0], c[1], 0, 0]).collect()));
        }
        let written = bench.run(step, &inputs);
        for (x, y) in bench.pixels() {
            let i = bench.at(x, y).unwrap();
            let out = written["color_out"][i];
            let what = || format!("{size:?} ({x}, {y}), {:?}, iteration {iteration}", step.features);
            if image[i][3] == 0 {
                assert_eq!(out, [0; 4], "{}: a miss", what());
                continue;
            }
            let (color, deviation, mean) = glossy_twin(&bench, step.features, iteration, &image, &reflected, [x, y]);
            let (found, spread) = unpack_tap(out);
            for channel in 0..3 {
                // Results are stored to 2⁻¹². Exponents reach some ten; their distances are differences of numbers a hundred times as
                // large, so f32 has them to 1e-5. The slopes of the plane add some of the mean's own error.
                let tolerance = 1.5e-3 * mean[channel] + 1e-9;
                assert_close(found[channel], color[channel], tolerance, || format!("{}: colour", what()));
            }
            assert_close(spread, deviation, 1.5e-3 * deviation + 1e-9, || format!("{}: deviation", what()));
            if let Some(feedback) = written.get("feedback_out") {
                let fed = unpack_rgb([feedback[i][0], feedback[i][1]]);
                for channel in 0..3 {
                    let tolerance = 1.5e-3 * mean[channel] + 1e-5 * color.into_iter().fold(0.0, f64::max) + 1e-9;
                    assert_close(fed[channel], color[channel], tolerance, || format!("{}: feedback", what()));
                }
            }
        }
    }
}

#[test]
fn the_default_stops() {
    use Feature::*;
    let sets: [&[Feature]; 5] = [
        &[],
        &[LocalLinearFit],
        &[LocalLinearFit, RidgeByNoise],
        &[FullKernel],
        &[FullKernel, LocalLinearFit, Feedback],
    ];
    for features in sets {
        for iteration in [0, 1, 3] {
            check(&Settings::adaptive(), features, iteration);
        }
    }
}

#[test]
fn the_last_iteration_takes_the_nearest_taps() {
    use Feature::*;
    for features in [Features::of(&[LocalLinearFit, RidgeByNoise]), Features::of(&[FullKernel])] {
        check_step(
            &Settings::adaptive(),
            &Step::nth(&atrous::PASS, features.with(Feature::SmallKernel), Nth::after(4)),
        );
    }
}

#[test]
fn the_stops_of_specular_light() {
    use Feature::*;
    let sets: [&[Feature]; 3] = [
        &[SpecularSignal],
        &[SpecularSignal, LocalLinearFit, RidgeByNoise],
        &[SpecularSignal, FullKernel, LocalLinearFit],
    ];
    for features in sets {
        for iteration in [0, 1, 3] {
            check(&Settings::adaptive(), features, iteration);
        }
    }
    check(&Settings::classic(), &[SpecularSignal, ClassicStops, FullKernel], 1);
}

#[test]
fn the_published_stops() {
    use Feature::*;
    let sets: [&[Feature]; 3] =
        [&[ClassicStops, FullKernel, Feedback], &[ClassicStops], &[ClassicStops, LocalLinearFit]];
    for features in sets {
        for iteration in [0, 2] {
            check(&Settings::classic(), features, iteration);
        }
    }
}

#[test]
fn other_numbers() {
    let filter = FilterSettings {
        sigma_luminance: 1.5,
        sigma_depth: 0.05,
        sigma_normal: 30.0,
        sigma_foreshortening: 2.0,
        ridge: 0.02,
        stops: Stops::NoiseSubtracted,
        ..Default::default()
    };
    check(&Settings { filter, ..Settings::adaptive() }, &[Feature::LocalLinearFit], 0);
}
