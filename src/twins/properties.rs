//! Promises of the formulas for every input, tested on the twins with inputs that `proptest` generates and shrinks.

use super::atrous;
use super::bench::{Bench, Texel};
use super::codec::{Kept, luminance, pack_normal, pack_rgb, pack_tap, unpack_rgb, unpack_tap, word};
use super::last_frame::Given;
use super::plane::{V, unit};
use crate::plan::Feature::{self, FullKernel, LocalLinearFit};
use crate::plan::Features;
use crate::{Camera, FilterSettings, Settings};
use proptest::prelude::*;

const SIZE: [u32; 2] = [9, 9];
const COUNT: usize = (SIZE[0] * SIZE[1]) as usize;

/// A pixel of an image: colour, deviation, slope of the normal, depth, and true if it sees nothing.
type Pixel = (V, f64, [f64; 2], f64, bool);

fn pixel() -> impl Strategy<Value = Pixel> {
    // Numbers go from black to brighter than any renderer's light.
    let number = || prop_oneof![Just(0.0), 1e-6..1e-3, 1e-3..1.0, 1.0..1e6];
    let color = [number(), number(), number()];
    let slope = [-0.3..0.3, -0.3..0.3];
    (color, number(), slope, 3.9..4.1, prop::bool::weighted(0.9))
}

fn pixels() -> impl Strategy<Value = Vec<Pixel>> {
    prop::collection::vec(pixel(), COUNT)
}

/// The taps of an image of a surface that faces the camera.
fn taps(pixels: &[Pixel]) -> Vec<Texel> {
    let tap = |&(color, deviation, [x, y], depth, seen): &Pixel| {
        let [a, b] = pack_tap(color, deviation);
        if seen { [a, b, pack_normal(unit([x, y, 1.0])), word(depth)] } else { [0; 4] }
    };
    pixels.iter().map(tap).collect()
}

fn bench(filter: FilterSettings) -> Bench {
    let camera = Camera { eye: [0.0, 0.0, 4.0], target: [0.0; 3], ..Default::default() };
    let bench = Bench::new(SIZE, Settings { filter, ..Settings::adaptive() });
    Bench { camera, previous: camera, ..bench }
}

/// A spatial iteration over the whole image: colours and deviations, `None` for misses.
fn filtered(bench: &Bench, features: &[Feature], iteration: u32, image: &[Texel]) -> Vec<Option<(V, f64)>> {
    let of = |(x, y): (i32, i32)| {
        let seen = image[bench.at(x, y).unwrap()][3] != 0;
        seen.then(|| {
            let (color, deviation, _) = atrous::twin(bench, Features::of(features), iteration, image, x, y);
            (color, deviation)
        })
    };
    bench.pixels().map(of).collect()
}

fn config() -> ProptestConfig {
    // Regressions become tests of their own, not files beside the sources.
    ProptestConfig { cases: 64, failure_persistence: None, ..Default::default() }
}

proptest! {
    #![proptest_config(config())]

    /// A weighted mean is within the range of its terms, and the fitted plane is within half and one and a half of that mean. No
    /// weights increase the noise.
    #[test]
    fn spatial_filter_stays_within_the_range_of_its_taps(
        pixels in pixels(),
        iteration in 0_u32..3,
        full in any::<bool>(),
        linear in any::<bool>(),
    ) {
        let image = taps(&pixels);
        let kernel = if full { vec![FullKernel] } else { Vec::new() };
        let features = if linear { [kernel.as_slice(), &[LocalLinearFit]].concat() } else { kernel };
        let seen: Vec<(V, f64)> = image.iter().filter(|t| t[3] != 0).map(|&t| unpack_tap(t)).collect();
        let range = |channel: usize| {
            seen.iter().map(|(c, _)| c[channel]).fold([f64::INFINITY, 0.0], |[low, high], x| [low.min(x), high.max(x)])
        };
        let (below, above) = if linear { (0.5, 1.5) } else { (1.0, 1.0) };
        let noisiest = seen.iter().map(|(_, d)| *d).fold(0.0, f64::max);
        for (color, deviation) in filtered(&bench(FilterSettings::default()), &features, iteration, &image).into_iter().flatten() {
            for (channel, x) in color.into_iter().enumerate() {
                let [low, high] = range(channel);
                prop_assert!(x >= below * low * (1.0 - 1e-9) && x <= above * high * (1.0 + 1e-9), "{x} of {low}…{high}");
            }
            prop_assert!(deviation <= noisiest * (1.0 + 1e-9), "{deviation} of {noisiest}");
        }
    }

    /// A uniform image does not change, whatever the noise and the shape of the surface.
    #[test]
    fn spatial_filter_keeps_what_is_equal(pixels in pixels(), color in [0.0..1e3, 0.0..1e3, 0.0..1e3], linear in any::<bool>()) {
        let equal: Vec<Pixel> = pixels.into_iter().map(|(_, d, n, z, s)| (color, d, n, z, s)).collect();
        let image = taps(&equal);
        let features: &[Feature] = if linear { &[LocalLinearFit] } else { &[] };
        let [a, b] = pack_tap(color, 0.0);
        let (stored, _) = unpack_tap([a, b, 0, 0]);
        for (found, _) in filtered(&bench(FilterSettings::default()), features, 0, &image).into_iter().flatten() {
            for channel in 0..3 {
                prop_assert!((found[channel] - stored[channel]).abs() <= 1e-9 * stored[channel]);
            }
        }
    }

    /// On a wall where noise stops no tap, the kernel is the same everywhere: each pixel gains what another one loses.
    #[test]
    fn spatial_filter_keeps_energy(lit in 0.0..1e3, full in any::<bool>()) {
        let filter = FilterSettings { sigma_luminance: 1e6, ..Default::default() };
        let bench = bench(filter);
        let wall = |color: f64| ([color; 3], 1e3, [0.0; 2], 4.0, true);
        let mut pixels = vec![wall(0.0); COUNT];
        // A pixel whose light reaches the middle has all its taps.
        pixels[bench.at(4, 4).unwrap()] = wall(lit);
        let image = taps(&pixels);
        let features: &[Feature] = if full { &[FullKernel] } else { &[] };
        let given: f64 = image.iter().map(|&t| luminance(unpack_tap(t).0)).sum();
        let found: f64 = filtered(&bench, features, 0, &image).into_iter().flatten().map(|(c, _)| luminance(c)).sum();
        prop_assert!((found - given).abs() <= 1e-6 * given, "{found} of {given}");
    }

    /// A mirrored image is filtered to the mirror image of the result.
    #[test]
    fn spatial_filter_knows_no_left_nor_right(pixels in pixels(), iteration in 0_u32..3, linear in any::<bool>()) {
        let mirror = |i: usize| i / 9 * 9 + 8 - i % 9;
        let mirrored: Vec<Pixel> = (0..COUNT)
            .map(|i| {
                let (color, deviation, [x, y], depth, seen) = pixels[mirror(i)];
                (color, deviation, [-x, y], depth, seen)
            })
            .collect();
        let features: &[Feature] = if linear { &[LocalLinearFit] } else { &[] };
        let bench = bench(FilterSettings::default());
        let [image, other] = [&pixels, &mirrored].map(|p| filtered(&bench, features, iteration, &taps(p)));
        for i in 0..COUNT {
            match (image[i], other[mirror(i)]) {
                (Some((a, da)), Some((b, db))) => {
                    let scale = a.into_iter().chain(b).fold(1e-30, f64::max);
                    for channel in 0..3 {
                        prop_assert!((a[channel] - b[channel]).abs() <= 1e-6 * scale, "{a:?}, {b:?}");
                    }
                    prop_assert!((da - db).abs() <= 1e-6 * da.max(1e-30));
                }
                (a, b) => prop_assert!(a.is_none() && b.is_none()),
            }
        }
    }

    /// The running mean and variance of n samples are their mean and variance (West 1979), to the rounding of a sample to 18
    /// bits.
    #[test]
    fn history_is_the_mean_and_the_variance_of_its_samples(samples in prop::collection::vec(0.0..100.0_f64, 2..40)) {
        let mut given = Given::new([1, 1], &[Feature::VarianceOfMean], Settings::adaptive().constant(0.0), false);
        given.motion = vec![[0.0, 0.0, 4.0]];
        let guide = [pack_normal([0.0, 0.0, 1.0]), word(4.0)];
        (given.guide, given.guide_before) = (vec![guide], vec![guide]);
        let mut last = None;
        for &sample in &samples {
            let [a, b] = pack_rgb([sample; 3]);
            given.radiance = vec![[a, b, 0, 0]];
            given.bench.continued = last.is_some();
            let out = given.twin(0, 0);
            given.history = vec![Kept { color: out.color, variance: out.variance, length: out.length }];
            last = Some(out);
        }
        let out = last.unwrap();
        let n = samples.len() as f64;
        let mean = samples.iter().sum::<f64>() / n;
        let variance = samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n;
        prop_assert!((out.mean - mean).abs() <= 1e-4 * 100.0, "{} is not {mean}", out.mean);
        prop_assert!((out.variance - variance).abs() <= 1e-3 * 100.0 * 100.0_f64.min(1.0 + variance), "{} is not {variance}", out.variance);
    }

    /// A blend is within the range of the rescaled history and the sample; lengths and λ are within their own ranges.
    #[test]
    fn temporal_filter_stays_within_the_range_of_what_it_blends(alpha in 0.0..1.0_f32, power in 0.0..10.0_f32, moving in any::<bool>()) {
        let filter = FilterSettings { alpha, history_power: power, max_history: 16.0, ..Default::default() };
        let features = [Feature::Gradient, Feature::InPlace, Feature::HistoryRatio, Feature::VarianceOfMean];
        let given = Given::new([7, 5], &features, Settings { filter, ..Settings::adaptive() }, moving);
        let samples = given.radiance.iter().flat_map(|t| unpack_rgb([t[0], t[1]])).fold(0.0, f64::max);
        let history = given.history.iter().flat_map(|h| h.color).fold(0.0, f64::max);
        // The history is rescaled by at most 4.
        let most = samples.max(4.0 * history);
        for (x, y) in given.bench.pixels() {
            let out = given.twin(x, y);
            prop_assert!(out.color.into_iter().all(|c| c >= 0.0 && c <= most * (1.0 + 1e-9)));
            prop_assert!(out.variance >= 0.0 && (0.0..=1.0).contains(&out.lambda) && (1.0..=16.0).contains(&out.length));
        }
    }

    /// Only the difference between objects counts: other numbers for them, in any order, change nothing.
    #[test]
    fn order_of_objects_does_not_matter(numbers in Just([0_u32, 1, 5, 900, u32::MAX]).prop_shuffle()) {
        let features = [Feature::Objects, Feature::VarianceOfMean];
        let given = || Given::new([7, 5], &features, Settings::adaptive().constant(0.1), true);
        let (plain, mut renamed) = (given(), given());
        for object in renamed.object.iter_mut().chain(&mut renamed.object_before) {
            *object = numbers[*object as usize];
        }
        for (x, y) in plain.bench.pixels() {
            let [a, b] = [&plain, &renamed].map(|g| g.twin(x, y));
            prop_assert_eq!((a.color, a.variance, a.length), (b.color, b.variance, b.length));
        }
    }
}
