//! The gradient: pairs of radiances, their filter, λ's numerator and denominator, and their filter.

use super::bench::{Bench, SIZES, Texel};
use super::codec::{
    Kept, assert_close, float, luminance, pack_history, pack_rgb, radiance, unpack_history, unpack_rgb, word,
};
use super::outliers;
use super::plane::V;
use super::random::Random;
use crate::passes::{Nth, Step, gradient, gradient_filter, gradient_pairs, gradient_pairs_filter};
use crate::plan::{Feature, Features};
use crate::{FilterSettings, Settings};

struct Images {
    bench: Bench,
    records: Vec<Texel>,
    radiance: Vec<Texel>,
    before: Vec<Texel>,
}

impl Images {
    fn new(size: [u32; 2], settings: Settings, seed: u64) -> Self {
        let bench = Bench::new(size, settings);
        let mut random = Random(seed);
        let guide = bench.guide(&mut random);
        let records = bench.records(&guide, &mut random);
        let mut image = || -> Vec<Texel> {
            let texel = |r: &mut Random| {
                let [a, b] = pack_rgb(radiance(r));
                [a, b, 0, 0]
            };
            (0..size[0] * size[1]).map(|_| texel(&mut random)).collect()
        };
        let (radiance, before) = (image(), image());
        Self { bench, records, radiance, before }
    }

    /// Radiances of a stratum's path, now and before.
    fn pair(&self, x: i32, y: i32) -> Option<(V, V)> {
        let record = self.records[self.bench.stratum(x, y).unwrap()];
        if record[0] == 0 {
            return None;
        }
        let (px, py) = Bench::sample_pixel(record, x, y);
        let now = self.radiance[self.bench.at(px, py).unwrap()];
        let before = self.before[self.bench.at((record[1] & 0xffff) as i32, (record[1] >> 16) as i32).unwrap()];
        Some((unpack_rgb([now[0], now[1]]), unpack_rgb([before[0], before[1]])))
    }
}

/// A filtered pair of a stratum: colour and l² now and before, l·l'.
type FilteredPair = ([f64; 4], [f64; 4], f64);

/// Packs a filtered pair into two texels: f, l², l·l'; f', l'².
fn pack_pair((now, before, product): &FilteredPair) -> [Texel; 2] {
    let texel = |p: &[f64; 4], last: f64| {
        let [a, b] = pack_rgb([p[0], p[1], p[2]]);
        [a, b, word(p[3]), word(last)]
    };
    [texel(now, *product), texel(before, 0.0)]
}

fn unpack_pair([now, before]: [Texel; 2]) -> FilteredPair {
    let four = |t: Texel| {
        let [r, g, b] = unpack_rgb([t[0], t[1]]);
        [r, g, b, float(t[2])]
    };
    (four(now), four(before), float(now[3]))
}

/// Filtered pairs of very different sizes.
fn some_pairs(count: usize, random: &mut Random) -> Vec<FilteredPair> {
    let mut number = || 10.0_f64.powf(random.between(-6.0, 4.0));
    (0..count).map(|_| ([0; 4].map(|_| number()), [0; 4].map(|_| number()), number())).collect()
}

/// Both images of the pairs.
fn texels(pairs: &[FilteredPair]) -> [Vec<Texel>; 2] {
    [0, 1].map(|which| pairs.iter().map(|p| pack_pair(p)[which]).collect())
}

/// Random strata of four numbers, of very different sizes.
fn numbers(count: usize, random: &mut Random) -> Vec<Texel> {
    (0..count).map(|_| [0; 4].map(|_| word(10.0_f64.powf(random.between(-6.0, 4.0))))).collect()
}

#[test]
fn pairs_are_what_one_path_brought_now_and_before() {
    let mut dropped = 0;
    for (size, limited) in SIZES.into_iter().flat_map(|size| [(size, false), (size, true)]) {
        let images = Images::new(size, Settings::adaptive(), 4);
        let limit = outliers::limits(&images.bench, &mut Random(14));
        let mut random = Random(15);
        let history: Vec<Kept> = (0..size[0] * size[1])
            .map(|_| {
                let color = radiance(&mut random);
                let length = 1.0 + 90.0 * random.unit();
                unpack_history(pack_history(Kept { color, variance: 0.0, length }))
            })
            .collect();
        let mut inputs = vec![
            ("samples", images.records.clone()),
            ("radiance", images.radiance.clone()),
            ("radiance_previous", images.before.clone()),
        ];
        let mut features = Features::default();
        if limited {
            features = features.with(Feature::Outliers);
            let texel = |&kept: &Kept| {
                let [a, b] = pack_history(kept);
                [a, b, 0, 0]
            };
            inputs.extend([("limit", limit.clone()), ("history_previous", history.iter().map(texel).collect())]);
        }
        let written = images.bench.run(&Step::new(&gradient_pairs::PASS, features), &inputs);
        for (x, y) in images.bench.strata() {
            let i = images.bench.stratum(x, y).unwrap();
            let (mut now, mut before) = images.pair(x, y).unwrap_or_default();
            if limited && images.records[i][0] != 0 {
                // The pixel of the surface's former place.
                let place = images.records[i][1];
                let kept = history[images.bench.at((place & 0xffff) as i32, (place >> 16) as i32).unwrap()];
                let brighter = luminance(now).max(luminance(before));
                let kept = [luminance(kept.color), kept.length];
                let (believed, near) = outliers::believed(&images.bench.settings, limit[i], kept, brighter, 1.6);
                if near {
                    continue;
                }
                if !believed {
                    dropped += 1;
                    (now, before) = ([0.0; 3], [0.0; 3]);
                }
            }
            let (l, l_before) = (luminance(now), luminance(before));
            let found = unpack_pair([written["now_out"][i], written["before_out"][i]]);
            let what = || format!("{size:?} ({x}, {y})");
            for (found, (color, square)) in
                [found.0, found.1].into_iter().zip([(now, l * l), (before, l_before.powi(2))])
            {
                assert_eq!(found[..3], color, "{}", what());
                assert_close(found[3], square, 1e-6 * square, what);
            }
            assert_close(found.2, l * l_before, 1e-6 * l * l_before, what);
        }
    }
    assert!(dropped > 5, "{dropped} pairs are not believed: the test has lost its grip");
}

#[test]
fn both_filters_are_weighted_means_over_the_same_surface() {
    for size in SIZES {
        for iteration in [0, 1, 2] {
            let images = Images::new(size, Settings::adaptive(), 5);
            let count = images.records.len();
            let mut random = Random(6);
            let pairs = some_pairs(count, &mut random);
            let gradient = numbers(count, &mut random);
            let [now, before] = texels(&pairs);
            let inputs = [("samples", images.records.clone()), ("now", now.clone()), ("before", before.clone())];
            let mut written = images
                .bench
                .run(&Step::nth(&gradient_pairs_filter::PASS, Features::default(), Nth::iteration(iteration)), &inputs);
            let inputs = [("samples", images.records.clone()), ("gradient", gradient.clone())];
            let across = Features::of(&[Feature::AcrossSurfaces]);
            written.append(
                &mut images.bench.run(&Step::nth(&gradient_filter::PASS, across, Nth::iteration(iteration)), &inputs),
            );
            // A stratum has thirteen numbers: both colours with their squares, the product, the gradient.
            let all = |now: &[Texel], before: &[Texel], gradient: &[Texel], i: usize| -> Vec<f64> {
                let (n, b, product) = unpack_pair([now[i], before[i]]);
                n.into_iter().chain(b).chain([product]).chain(gradient[i].map(float)).collect()
            };
            let given: Vec<Vec<f64>> = (0..count).map(|i| all(&now, &before, &gradient, i)).collect();
            for (x, y) in images.bench.strata() {
                let i = images.bench.stratum(x, y).unwrap();
                let taps = match images.records[i][0] {
                    0 => Vec::new(),
                    _ => images.bench.strata_taps(&images.records, x, y, 1 << iteration),
                };
                let found = all(&written["now_out"], &written["before_out"], &written["gradient_out"], i);
                for (channel, &found) in found.iter().enumerate() {
                    // The gradient's last two numbers are the ones across surfaces.
                    let blind = usize::from(channel >= 11);
                    let weight: f64 = taps.iter().map(|t| t.1[blind]).sum::<f64>().max(1.0);
                    let mean = |c: usize| taps.iter().map(|t| t.1[blind] * given[t.0][c]).sum::<f64>() / weight;
                    // Exponents are precise to some 1e-4. A tap with a weight of e⁻⁸ may be cut or not: an error of 1e-4 of the largest.
                    let largest = taps.iter().map(|t| given[t.0][channel]).fold(0.0, f64::max);
                    // Colours have 18 bits of the largest channel.
                    let brightest = match channel {
                        0..=2 => (0..3).map(mean).fold(0.0, f64::max),
                        4..=6 => (4..7).map(mean).fold(0.0, f64::max),
                        _ => 0.0,
                    };
                    let tolerance = 2e-4 * largest + brightest * 2.0_f64.powi(-17);
                    assert_close(found, mean(channel), tolerance, || {
                        format!("{size:?} ({x}, {y}), number {channel}, {iteration}")
                    });
                }
            }
        }
    }
}

/// ρ for red, green, blue and luminance, from the filtered pairs: a prior of 5 %, colour within 1½ of the luminance's ρ, shrunk
/// towards 1 by the ratio's own variance with 90 samples, within ¼…4. Also returns its distance outside of those limits (1 at half or
/// twice), and the larger luminance.
fn ratio(now: [f64; 4], before: [f64; 4], product: f64) -> ([f64; 4], f64, f64) {
    let [l, l_before] = [now, before].map(|p| luminance([p[0], p[1], p[2]]));
    if l.max(l_before) <= 7.9e-31 || l_before <= 1e-6 * l {
        return ([1.0; 4], 0.0, l.max(l_before));
    }
    let e = 0.05 * l_before;
    let r = (l + e) / (l_before + e);
    let variance = (now[3] - 2.0 * r * product + r * r * before[3]).max(0.0) / (90.0 * l_before * l_before);
    let kept = if r == 1.0 {
        f64::from(u8::from(variance == 0.0))
    } else {
        (1.0 - variance / (r - 1.0).powi(2).max(1e-9)).max(0.0)
    };
    let color = |i: usize| ((now[i] + e) / (before[i] + e)).clamp(r / 1.5, r * 1.5);
    let rho = [color(0), color(1), color(2), r].map(|q| 1.0 + (q - 1.0) * kept);
    let beyond = ((0.25 - rho[3]) / 0.125).max((rho[3] - 4.0) / 4.0).clamp(0.0, 1.0);
    (rho.map(|q| q.clamp(0.25, 4.0)), beyond, l.max(l_before))
}

#[test]
fn the_gradient_is_what_the_ratio_does_not_explain() {
    for size in SIZES {
        let kinds = [(0.0, false), (0.5, false), (0.5, true), (1.0, true)];
        for ((gamma, with_ratio), signed) in kinds.into_iter().flat_map(|k| [(k, false), (k, true)]) {
            let filter = FilterSettings { gradient_gamma: gamma, ..Default::default() };
            let images = Images::new(size, Settings { filter, ..Settings::adaptive() }, 8);
            let mut random = Random(9);
            let count = images.records.len();
            // The pairs are smooth, like a filter's output: means, and products with some noise.
            let filtered: Vec<FilteredPair> = (0..count)
                .map(|_| {
                    let before = [0; 3].map(|_| random.between(0.1, 1.0));
                    let change = random.between(0.05, 6.0);
                    let now = before.map(|b| b * change * random.between(0.8, 1.25));
                    let (l, b) = (luminance(now), luminance(before));
                    let noise = random.between(1.0, 5.0);
                    (
                        [now[0], now[1], now[2], l * l * noise],
                        [before[0], before[1], before[2], b * b * noise],
                        l * b * noise,
                    )
                })
                .collect();
            let mut inputs = vec![
                ("samples", images.records.clone()),
                ("radiance", images.radiance.clone()),
                ("radiance_previous", images.before.clone()),
            ];
            if with_ratio {
                let [now, before] = texels(&filtered);
                inputs.extend([("now_filtered", now), ("before_filtered", before)]);
            }
            let mut features = if with_ratio { Features::of(&[Feature::HistoryRatio]) } else { Features::default() };
            if signed {
                features = features.with(Feature::SignedGradient);
            }
            let written = images.bench.run(&Step::new(&gradient::PASS, features), &inputs);
            for (x, y) in images.bench.strata() {
                let i = images.bench.stratum(x, y).unwrap();
                let what = || format!("{size:?} ({x}, {y}), γ {gamma}, ratio {with_ratio}");
                let (rho, beyond, brighter) = match images.pair(x, y) {
                    Some(_) if with_ratio => {
                        // Take the numbers as the textures hold them.
                        let (now, before, product) = unpack_pair(pack_pair(&filtered[i]));
                        ratio(now, before, product)
                    }
                    _ => ([1.0; 4], 0.0, 0.0),
                };
                if with_ratio {
                    for (channel, expected) in rho.into_iter().enumerate() {
                        let found = float(written["ratio_out"][i][channel]);
                        // The variance is a difference of products, divided by (ρ − 1)².
                        let near = 1e-6 / (rho[3] - 1.0).abs().max(1e-3);
                        assert_close(found, expected, 1e-4 + 20.0 * near, || format!("{}: ρ", what()));
                    }
                }
                let found = [0, 1].map(|c| float(written["gradient_out"][i][c]));
                let (now, before) = images.pair(x, y).map_or((0.0, 0.0), |(n, b)| (luminance(n), luminance(b)));
                let before = before * if with_ratio { float(written["ratio_out"][i][3]) } else { 1.0 };
                let larger = now.max(before);
                let expected = if larger > 7.9e-31 {
                    let difference = if signed { now - before } else { (now - before).abs() };
                    [difference * larger.powf(gamma_less_one(gamma)), larger.powf(gamma.into())]
                } else {
                    [0.0; 2]
                };
                // Beyond the limits, all of the history is dropped.
                let expected = expected.map(|g| g + (brighter.powf(gamma.into()) - g) * beyond);
                // pow is exp2 of a product in f32: up to 10⁵, 17 bits are before the point.
                assert_close(found[0], expected[0], 3e-4 * expected[1], || format!("{}: numerator", what()));
                assert_close(found[1], expected[1], 3e-4 * expected[1], || format!("{}: denominator", what()));
                let texel = written["gradient_out"][i];
                assert_eq!(texel[..2], texel[2..], "{}: what is gathered from any surface", what());
            }
        }
    }
}

fn gamma_less_one(gamma: f32) -> f64 {
    f64::from(gamma) - 1.0
}

#[test]
fn a_hosts_pairs_go_the_same_way() {
    for size in SIZES {
        let images = Images::new(size, Settings::adaptive(), 12);
        let strata = images.bench.strata();
        // Put the radiances of a stratum's path at the stratum's place, instead of in the images.
        let [now, before] = [0, 1].map(|which| -> Vec<Texel> {
            let texel = |&(x, y): &(i32, i32)| {
                let (now, before) = images.pair(x, y)?;
                let [a, b] = pack_rgb([now, before][which]);
                Some([a, b, 0, 0])
            };
            strata.iter().map(|s| texel(s).unwrap_or_default()).collect()
        });
        let filtered = texels(&some_pairs(strata.len(), &mut Random(13)));
        let run = |pairs: bool| {
            let (features, now, before) = if pairs {
                (Features::of(&[Feature::Pairs]), &now, &before)
            } else {
                (Features::default(), &images.radiance, &images.before)
            };
            let mut inputs = vec![
                ("samples", images.records.clone()),
                ("radiance", now.clone()),
                ("radiance_previous", before.clone()),
            ];
            let mut written = images.bench.run(&Step::new(&gradient_pairs::PASS, features), &inputs);
            inputs.extend(["now_filtered", "before_filtered"].into_iter().zip(filtered.clone()));
            written.append(
                &mut images.bench.run(&Step::new(&gradient::PASS, features.with(Feature::HistoryRatio)), &inputs),
            );
            written
        };
        assert_eq!(run(true), run(false), "{size:?}");
    }
}

#[test]
fn where_nothing_changed_the_ratio_is_exactly_one_and_the_gradient_exactly_zero() {
    let mut images = Images::new([33, 17], Settings::adaptive(), 10);
    images.before = images.radiance.clone();
    let strata = images.bench.strata();
    for (x, y) in &strata {
        let i = images.bench.stratum(*x, *y).unwrap();
        let (px, py) = Bench::sample_pixel(images.records[i], *x, *y);
        // The path is in the same pixel as before, so that both radiances have the same bits.
        images.records[i][1] = px as u32 | (py as u32) << 16;
    }
    let same = some_pairs(strata.len(), &mut Random(11)).into_iter().map(|(now, ..)| (now, now, now[3]));
    let [now, before] = texels(&same.collect::<Vec<_>>());
    let inputs = [
        ("samples", images.records.clone()),
        ("radiance", images.radiance.clone()),
        ("radiance_previous", images.before.clone()),
        ("now_filtered", now),
        ("before_filtered", before),
    ];
    let written = images.bench.run(&Step::new(&gradient::PASS, Features::of(&[Feature::HistoryRatio])), &inputs);
    assert!(written["ratio_out"].iter().flatten().all(|&w| w == 1.0_f32.to_bits()));
    assert!(written["gradient_out"].iter().all(|t| t[0] == 0));
    assert!(written["gradient_out"].iter().any(|t| t[1] != 0), "there was something to compare");
}
