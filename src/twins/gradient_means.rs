//! The gradient without pairs: means of strata, their filter, and the resulting λ and ρ.

use super::bench::{Bench, SIZES, Texel};
use super::codec::{assert_close, depth, float, luminance, pack_rgb, unpack_normal, unpack_rgb, word};
use super::last_frame::Given;
use super::outliers;
use super::plane::{V, dot, sub};
use super::random::Random;
use crate::passes::{Nth, Step, gradient_means, gradient_means_filter, gradient_of_means};
use crate::plan::{Feature, Features};
use crate::{FilterSettings, Settings};

/// Means of new samples and of histories, with the variance of their difference by the histories' own variance and as sums of
/// squares.
#[derive(Clone, Copy, Debug, Default)]
struct Means {
    now: V,
    before: V,
    /// The histories' variance V; l(s)²; l(s)·l(m); l(m)².
    squares: [f64; 4],
}

impl Means {
    fn pack(&self) -> [Texel; 2] {
        let [known, now, product, before] = self.squares.map(word);
        let texel = |color, a, b| {
            let [x, y] = pack_rgb(color);
            [x, y, a, b]
        };
        [texel(self.now, now, known), texel(self.before, before, product)]
    }

    fn unpack([now, before]: [Texel; 2]) -> Self {
        let color = |t: Texel| unpack_rgb([t[0], t[1]]);
        let squares = [now[3], now[2], before[3], before[2]].map(float);
        Self { now: color(now), before: color(before), squares }
    }

    fn add(&mut self, other: &Self, weight: f64) {
        for c in 0..3 {
            self.now[c] += weight * other.now[c];
            self.before[c] += weight * other.before[c];
        }
        for (sum, square) in self.squares.iter_mut().zip(other.squares) {
            *sum += weight * weight * square;
        }
    }

    fn scaled(&self, s: f64) -> Self {
        Self {
            now: self.now.map(|x| x * s),
            before: self.before.map(|x| x * s),
            squares: self.squares.map(|x| x * s * s),
        }
    }

    /// All numbers, each with its tolerance: a colour has 18 bits of its largest channel.
    fn numbers(&self) -> Vec<(f64, f64)> {
        let of_color = |color: V| {
            let step = color.into_iter().fold(0.0, f64::max) * 2.0_f64.powi(-16);
            color.map(|x| (x, step))
        };
        let squares = self.squares.map(|x| (x, 0.0));
        of_color(self.now).into_iter().chain(of_color(self.before)).chain(squares).collect()
    }
}

/// The variance of one sample's luminance: unbiased, and until the fifth sample mixed with the deviation of two means.
fn sample_variance(variance: f64, mean: f64, n: f64) -> f64 {
    let unbiased = if n < 8.0 { variance * n / (n - 1.0).max(0.5) } else { variance };
    let known = ((n - 1.0) / 4.0).min(1.0);
    known * unbiased + (1.0 - known) * (2.0 * mean).powi(2)
}

/// The record and the means of a stratum, and true if a threshold was near.
fn means(given: &Given, sx: i32, sy: i32) -> (Option<usize>, Means, bool) {
    let bench = &given.bench;
    let (mut sum, mut count, mut unsure) = (Means::default(), 0.0, false);
    let mut reference = None::<(usize, usize)>;
    for place in (4..9).chain(0..4) {
        let (x, y) = (3 * sx + place as i32 % 3, 3 * sy + place as i32 / 3);
        let Some(i) = bench.at(x, y).filter(|&i| depth(given.guide[i]) > 0.0) else { continue };
        let position = |i: usize| {
            let [x, y] = [i as i32 % bench.size[0] as i32, i as i32 / bench.size[0] as i32];
            bench.position(x, y, depth(given.guide[i]))
        };
        let normal = |i: usize| unpack_normal(given.guide[i][0]);
        if let Some((r, _)) = reference {
            let off = dot(normal(r), sub(position(i), position(r))).abs() / (0.02 * depth(given.guide[r]));
            let cosine = dot(normal(r), normal(i));
            unsure |= (off - 1.0).abs() < 1e-3 || (cosine - 0.9).abs() < 1e-5;
            if off > 1.0 || cosine < 0.9 {
                continue;
            }
        }
        let Some(sample) = given.sample(i) else { continue };
        let (history, doubtful) = given.bilinear_history(i, x, y);
        unsure |= doubtful;
        let Some((before, variance, length)) = history else { continue };
        if given.has(Feature::Outliers) {
            let limit = given.limit[bench.stratum(sx, sy).unwrap()];
            let history = [luminance(before), length];
            let (believed, near) = outliers::believed(&bench.settings, limit, history, luminance(sample), 1.0);
            unsure |= near;
            if !believed {
                continue;
            }
        }
        reference.get_or_insert((i, place));
        let n = length.clamp(1.0, bench.settings.filter.max_history.into());
        let v = sample_variance(variance, luminance(before), n);
        let (l, b) = (luminance(sample), luminance(before));
        // Each pixel counts once.
        sum.add(&Means { now: sample, before, squares: [v + v / n, l * l, l * b, b * b] }, 1.0);
        count += 1.0;
    }
    (reference.map(|(_, place)| place), sum.scaled(1.0 / f64::max(count, 1.0)), unsure)
}

#[test]
fn strata_compare_new_samples_with_their_histories() {
    let (mut compared, mut unsure_ones, mut empty) = (0, 0, 0);
    let kinds = [vec![], vec![Feature::Objects, Feature::MissingSamples], vec![Feature::Outliers]];
    for features in kinds {
        for (size, moving) in SIZES.into_iter().flat_map(|size| [(size, false), (size, true)]) {
            let given = Given::new(size, &features, Settings::adaptive(), moving);
            let step = Step::new(&gradient_means::PASS, Features::of(&features));
            let written = given.bench.run(&step, &given.inputs(&step));
            for (x, y) in given.bench.strata() {
                let s = given.bench.stratum(x, y).unwrap();
                let (place, expected, unsure) = means(&given, x, y);
                compared += 1;
                if unsure {
                    unsure_ones += 1;
                    continue;
                }
                let record = written["samples_out"][s];
                let what = || format!("{size:?} ({x}, {y}), moving {moving}, {features:?}");
                let Some(place) = place else {
                    empty += 1;
                    assert_eq!(record, [0; 4], "{}", what());
                    continue;
                };
                let at = given.bench.at(3 * x + place as i32 % 3, 3 * y + place as i32 / 3).unwrap();
                assert_eq!(record, [place as u32 + 1, 0, given.guide[at][0], given.guide[at][1]], "{}", what());
                let found = Means::unpack([written["now_out"][s], written["before_out"][s]]);
                // The spread of the taps' means is a difference of f32 squares.
                let rounding = 1e-6 * expected.squares[3];
                let pairs = found.numbers().into_iter().zip(expected.numbers());
                for (number, ((found, _), (expected, step))) in pairs.enumerate() {
                    assert_close(found, expected, 2e-3 * expected.abs() + step + rounding + 1e-12, || {
                        format!("{}, number {number}", what())
                    });
                }
            }
        }
    }
    println!("{compared} strata, {empty} without a history, {unsure_ones} at a threshold");
    assert!(unsure_ones * 5 <= compared && empty * 2 <= compared, "the test has lost its grip");
}

#[test]
fn a_first_frame_has_nothing_to_compare_with() {
    let mut given = Given::new([33, 17], &[], Settings::adaptive(), false);
    given.bench.continued = false;
    let step = Step::new(&gradient_means::PASS, Features::default());
    let written = given.bench.run(&step, &given.inputs(&step));
    assert!(written["samples_out"].iter().all(|record| *record == [0; 4]));
}

/// Means of very different brightness.
fn some_means(count: usize, random: &mut Random) -> Vec<Means> {
    let mut one = || {
        let scale = 10.0_f64.powf(random.between(-6.0, 4.0));
        let [now, before] = [0; 2].map(|_| [0; 3].map(|_| scale * random.unit()));
        Means { now, before, squares: [0; 4].map(|_| scale * scale * random.unit()) }
    };
    // The numbers as the textures hold them.
    (0..count).map(|_| Means::unpack(one().pack())).collect()
}

#[test]
fn the_filter_is_a_weighted_mean_over_the_same_surface() {
    for size in SIZES {
        for level in [0, 1, 3] {
            let bench = Bench::new(size, Settings::adaptive());
            let mut random = Random(21);
            let guide = bench.guide(&mut random);
            let records = bench.records(&guide, &mut random);
            let given = some_means(records.len(), &mut random);
            let [now, before] = [0, 1].map(|which| given.iter().map(|m| m.pack()[which]).collect::<Vec<_>>());
            let inputs = [("samples", records.clone()), ("now", now), ("before", before)];
            let written = bench
                .run(&Step::nth(&gradient_means_filter::PASS, Features::default(), Nth::iteration(level)), &inputs);
            for (x, y) in bench.strata() {
                let s = bench.stratum(x, y).unwrap();
                let (mut sum, mut largest, mut weights) = (Means::default(), vec![0.0; 10], 0.0);
                if records[s][0] != 0 {
                    for (i, [w, _]) in bench.strata_taps(&records, x, y, 1 << level) {
                        sum.add(&given[i], w);
                        weights += w;
                        for (most, (x, _)) in largest.iter_mut().zip(given[i].numbers()) {
                            *most = f64::max(*most, x);
                        }
                    }
                }
                let expected = sum.scaled(1.0 / f64::max(weights, 1.0));
                let found = Means::unpack([written["now_out"][s], written["before_out"][s]]);
                let pairs = found.numbers().into_iter().zip(expected.numbers()).zip(largest);
                for (number, (((found, _), (expected, step)), largest)) in pairs.enumerate() {
                    // Weights are precise to 1e-4.
                    assert_close(found, expected, 3e-4 * largest + step, || {
                        format!("{size:?} ({x}, {y}), number {number}, level {level}")
                    });
                }
            }
        }
    }
}

/// λ, and ρ of red, green, blue and luminance, from the coarsest of the levels to the finest.
fn change(levels: &[Means; 3], with_ratio: bool) -> (f64, [f64; 4]) {
    let (mut lambda, mut ratio) = (0.0_f64, [1.0; 4]);
    for means in levels {
        let (s, m) = (luminance(means.now), luminance(means.before));
        let [known, now, product, before] = means.squares;
        let r = ratio[3];
        let larger = s.max(r * m);
        if larger <= 1e-17 {
            continue;
        }
        let d = s - r * m;
        let noise = (r * r * known).max(now - 2.0 * r * product + r * r * before);
        lambda = lambda.max((d * d - 6.0 * noise).max(0.0).sqrt() / larger);
        if with_ratio && m > 1e-6 * s {
            let e = 0.05 * m;
            let level = (s + e * r) / (m + e);
            let color = [0, 1, 2].map(|c| {
                let own = (means.now[c] + e * ratio[c]) / (means.before[c] + e);
                own.clamp(level / 1.5, level * 1.5)
            });
            let believed = if d == 0.0 { 0.0 } else { (1.0 - 6.0 * noise / (d * d)).max(0.0) };
            for (ratio, level) in ratio.iter_mut().zip(color.into_iter().chain([level])) {
                *ratio += (level - *ratio) * believed;
            }
        }
    }
    if with_ratio {
        // Beyond ¼…4 the history fades; at half or twice of that, nothing is left.
        lambda = lambda.max((2.0 - 8.0 * ratio[3]).max(ratio[3] / 4.0 - 1.0).clamp(0.0, 1.0));
    }
    (lambda, ratio.map(|r| r.clamp(0.25, 4.0)))
}

#[test]
fn the_gradient_is_what_exceeds_the_noise() {
    let bench = Bench::new([33, 17], Settings { filter: FilterSettings::default(), ..Settings::adaptive() });
    let mut random = Random(22);
    let guide = bench.guide(&mut random);
    let records = bench.records(&guide, &mut random);
    // All levels see a change, with more or less noise; now and then there is none at all, or one that starts from black.
    let levels: Vec<[Means; 2]> = (0..records.len())
        .map(|_| {
            let kind = random.below(8);
            let change = if kind == 0 { 1.0 } else { 10.0_f64.powf(random.between(-1.0, 1.0)) };
            let noise = 10.0_f64.powf(random.between(-3.0, -0.5));
            let before = [0; 3].map(|_| if kind == 1 { 0.0 } else { random.between(0.1, 1.0) });
            [0; 2].map(|_| {
                let now = before.map(|b| (if kind == 1 { 0.3 } else { b }) * change * random.between(0.9, 1.1));
                let (l, b) = (luminance(now), luminance(before));
                let [n, p] = [noise * l * l, noise * l * b];
                let means = Means { now, before, squares: [noise * b * b * random.unit(), n, p, noise * b * b * 1.05] };
                Means::unpack(means.pack())
            })
        })
        .collect();
    let texels = |level: usize, which: usize| levels.iter().map(|l| l[level].pack()[which]).collect::<Vec<_>>();
    let nth = Nth::iteration(gradient_of_means::STORED.into());
    // The pass makes the coarsest level from the middle one.
    let inputs = [("samples", records.clone()), ("now", texels(0, 0)), ("before", texels(0, 1))];
    let coarse = bench.run(&Step::nth(&gradient_means_filter::PASS, Features::default(), nth), &inputs);
    let [fine_now, fine_before] = [0, 1].map(|which| texels(1, which));
    let inputs = inputs.into_iter().chain([("now_fine", fine_now), ("before_fine", fine_before)]).collect::<Vec<_>>();
    let mut changed = 0;
    for with_ratio in [false, true] {
        let features = if with_ratio { Features::of(&[Feature::HistoryRatio]) } else { Features::default() };
        let written = bench.run(&Step::nth(&gradient_of_means::PASS, features, nth), &inputs);
        for (s, levels) in levels.iter().enumerate() {
            let what = |name| format!("stratum {s}, ratio {with_ratio}: {name}");
            let there = records[s][0] != 0;
            let coarsest = Means::unpack([coarse["now_out"][s], coarse["before_out"][s]]);
            let levels = [coarsest, levels[0], levels[1]];
            let (lambda, ratio) = if there { change(&levels, with_ratio) } else { (0.0, [1.0; 4]) };
            changed += usize::from(lambda > 0.1);
            let found = written["gradient_out"][s].map(float);
            assert_close(found[0], lambda, 2e-3, || what("λ"));
            assert_eq!(found[1], 1.0, "{}", what("its weight"));
            if with_ratio {
                for (found, expected) in written["ratio_out"][s].map(float).into_iter().zip(ratio) {
                    assert_close(found, expected, 2e-3 * expected, || what("ρ"));
                }
            }
        }
    }
    assert!(changed > 20, "the test has lost its grip");
}

/// One path in twenty finds the light: its rare hits are no change.
#[test]
fn a_single_bright_sample_is_no_change_and_many_are() {
    let of_hits = |hits: usize| {
        // The mean is over 400 samples, and the history has forgotten how rare its light is.
        let samples = (0..400).map(|i| if i < hits { 20.0 } else { 0.0 });
        let mut sum = Means::default();
        for sample in samples {
            sum.add(
                &Means { now: [sample; 3], before: [0.05; 3], squares: [1e-4, sample * sample, 0.05 * sample, 0.0025] },
                1.0,
            );
        }
        let means = sum.scaled(1.0 / 400.0);
        change(&[means; 3], true)
    };
    let (lambda, ratio) = of_hits(4);
    assert_eq!((lambda, ratio[3]), (0.0, 1.0), "four samples of 400");
    let (lambda, ratio) = of_hits(60);
    assert!(lambda > 0.5 && ratio[3] > 1.0, "60 of 400: λ {lambda}, ρ {ratio:?}");
}
