//! The spatial filter's input: the colour, and the deviation of a mean; short histories take the deviation from 7×7 neighbours on
//! the same surface.

use super::bench::{Bench, SIZES, Texel};
use super::codec::{
    Kept, assert_close, depth, luminance, pack_history, pack_rgb, radiance, unpack_history, unpack_normal, unpack_rgb,
    unpack_tap,
};
use super::plane::{V, add, dot, scale, sub};
use super::random::Random;
use super::strata::falloff;
use crate::Settings;
use crate::passes::{Step, variance};
use crate::plan::{Feature, Features};

fn kept(texel: Texel) -> Kept {
    unpack_history([texel[0], texel[1]])
}

/// A pixel with a history, `offset` away on the same surface, and its weight.
pub(super) fn neighbour(
    bench: &Bench,
    guide: &[[u32; 2]],
    history: &[Texel],
    [x, y]: [i32; 2],
    [dx, dy]: [i32; 2],
) -> Option<(usize, f64)> {
    let i = bench.at(x, y).unwrap();
    let (normal, z) = (unpack_normal(guide[i][0]), depth(guide[i]));
    let there = |&q: &usize| depth(guide[q]) > 0.0 && kept(history[q]).length > 0.0;
    let q = bench.at(x + dx, y + dy).filter(there)?;
    let offset = sub(bench.position(x + dx, y + dy, depth(guide[q])), bench.position(x, y, z));
    let exponent = dot(normal, offset).abs() / (0.02 * z) + 64.0 * (1.0 - dot(normal, unpack_normal(guide[q][0])));
    Some((q, falloff(exponent)))
}

/// Fills a pixel without a history: the mean over neighbours of its surface, the mean's deviation, and the greatest square of a
/// luminance.
fn fill(bench: &Bench, guide: &[[u32; 2]], history: &[Texel], colors: &[V], x: i32, y: i32) -> (V, f64, f64) {
    let (mut sum, mut square, mut weights, mut squares) = ([0.0; 3], 0.0, 0.0, 0.0);
    for spacing in [1, 3, 9] {
        if weights >= 6.0 {
            break;
        }
        for (dx, dy) in (-3..=3).flat_map(|dy| (-3..=3).map(move |dx| (spacing * dx, spacing * dy))) {
            let Some((q, w)) = neighbour(bench, guide, history, [x, y], [dx, dy]) else { continue };
            let l = luminance(colors[q]);
            sum = add(sum, scale(colors[q], w));
            square += w * l * l;
            squares = f64::max(squares, l * l);
            weights += w;
        }
    }
    if weights <= 1e-3 {
        return ([0.0; 3], 0.0, squares);
    }
    let mean = scale(sum, 1.0 / weights);
    let variance = 4.0 * (square / weights - luminance(mean).powi(2)).max(0.0) / weights.max(1.0);
    (mean, variance.sqrt(), squares)
}

/// The deviation of noise that never changes, from triples of neighbours in the 3×3 around a pixel, and the greatest square of a
/// luminance. Each of four directions gives the mean of its triples, at most twenty times the fourth largest of them; the least of
/// the four counts.
fn bends(bench: &Bench, guide: &[[u32; 2]], history: &[Texel], x: i32, y: i32) -> (f64, f64) {
    let mut squares = 0.0;
    // The triples stay within the image.
    let [mx, my] =
        [(x, bench.size[0]), (y, bench.size[1])].map(|(at, size)| at.max(2).min((size as i32 - 3).max(2)) - at);
    let means = [[1, 0], [0, 1], [1, 1], [1, -1]].map(|[sx, sy]: [i32; 2]| {
        let (mut bends, mut weights) = (vec![0.0; 4], 0.0);
        for (dx, dy) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (mx + dx, my + dy))) {
            let triple = [-1, 0, 1].map(|k| neighbour(bench, guide, history, [x, y], [dx + k * sx, dy + k * sy]));
            let [Some(a), Some(b), Some(c)] = triple else { continue };
            let [l, m, r] = [a, b, c].map(|(q, _)| luminance(kept(history[q]).color));
            bends.push(a.1 * b.1 * c.1 * (m - 0.5 * (l + r)).powi(2) / 1.5);
            weights += a.1 * b.1 * c.1;
            squares = f64::max(squares, (l * l).max(m * m).max(r * r));
        }
        bends.sort_by(|a, b| b.total_cmp(a));
        let mean = (bends.iter().sum::<f64>() / weights).min(20.0 * bends[3]);
        if weights >= 5.5 { mean } else { f64::INFINITY }
    });
    let least = means.into_iter().fold(f64::INFINITY, f64::min);
    if least.is_infinite() {
        return (0.0, squares);
    }
    ((4.0 / 0.6 * least).sqrt(), squares)
}

/// The standard deviation that steers the luminance stop, and the scale of the numbers whose difference it is.
fn twin(bench: &Bench, features: Features, guide: &[[u32; 2]], history: &[Texel], x: i32, y: i32) -> (f64, f64) {
    let i = bench.at(x, y).unwrap();
    let n = kept(history[i]).length;
    let of_mean = features.has(Feature::VarianceOfMean);
    let own = kept(history[i]).variance;
    let center = luminance(kept(history[i]).color);
    let silent = n >= 2.0 && center > 0.0 && own <= 1e-6 * center.powi(2);
    if features.has(Feature::RepeatedNoise) && silent {
        let steady = twin(bench, features.without(Feature::RepeatedNoise), guide, history, x, y);
        let (floor, squares) = bends(bench, guide, history, x, y);
        return (steady.0.max(floor), steady.1.max(squares));
    }
    if n >= 4.0 {
        // Apply Bessel's correction while n is below 8.
        let bessel = if n < 8.0 { n / (n - 1.0) } else { 1.0 };
        return (if of_mean { own * bessel / n } else { own }.sqrt(), 0.0);
    }
    let (mut first, mut second, mut weights) = (0.0, 0.0, 0.0);
    let mut squares = 0.0;
    for (dx, dy) in (-3..=3).flat_map(|dy| (-3..=3).map(move |dx| (dx, dy))) {
        let Some((q, w)) = neighbour(bench, guide, history, [x, y], [dx, dy]) else { continue };
        let mean = luminance(kept(history[q]).color);
        let second_moment = kept(history[q]).variance + mean * mean;
        first += w * mean;
        second += w * second_moment;
        squares = f64::max(squares, second_moment);
        weights += w;
    }
    // The variance is E[m₂] − E[m]² with the neighbours' own second moments, times 4/n.
    let spatial = (second / weights - (first / weights).powi(2)).max(0.0) * (4.0 / n).max(1.0);
    if !of_mean {
        return (spatial.sqrt(), squares);
    }
    let own = own * n / (n - 1.0).max(0.5);
    let trust = ((n - 1.0) / 3.0).clamp(0.0, 1.0);
    (((spatial + trust * (own - spatial)) / n).sqrt(), squares)
}

#[test]
fn the_filter_starts_from_the_history_and_short_ones_take_their_neighbours_variance() {
    use Feature::*;
    let sets: [&[Feature]; 6] = [
        &[],
        &[VarianceOfMean],
        &[Feedback],
        &[VarianceOfMean, Feedback],
        &[VarianceOfMean, MissingSamples, RepeatedNoise],
        &[MissingSamples, RepeatedNoise, Feedback],
    ];
    // One run has fireflies (10⁵): beside a firefly, nothing else counts. The other has none.
    for ((features, size), brightest) in
        sets.into_iter().flat_map(|f| SIZES.map(|s| (f, s))).flat_map(|c| [(c, 1.0), (c, 1e9)])
    {
        let bench = Bench::new(size, Settings::adaptive());
        let step = Step::new(&variance::PASS, Features::of(features));
        let mut random = Random(12);
        let guide = bench.guide(&mut random);
        let texel = |g: &[u32; 2], random: &mut Random| -> Texel {
            if depth(*g) == 0.0 {
                return [0; 4];
            }
            match if step.features.has(MissingSamples) { random.below(10) } else { 10 } {
                0 | 1 => return [0; 4],
                // The radiance is infinite.
                2 => {
                    let [a, b] = pack_history(Kept { color: [65504.0; 3], variance: 0.0, length: 0.0 });
                    return [a, b, 0, 0];
                }
                _ => {}
            }
            let length = [1.0, 1.5, 2.0, 3.0, 3.75, 4.0, 6.0, 20.0][random.below(8)];
            // The radiance is the same in every frame.
            let still = step.features.has(RepeatedNoise) && random.below(2) == 0;
            let color = radiance(random).map(|c| c.min(brightest));
            // If the spatial filter feeds the history, the mean luminance is in the colour's place.
            let color = if step.features.has(Feedback) { [luminance(color); 3] } else { color };
            let variance = if still { 0.0 } else { random.unit() * luminance(color).powi(2) };
            let [a, b] = pack_history(Kept { color, variance, length });
            [a, b, 0, 0]
        };
        let history: Vec<Texel> = guide.iter().map(|g| texel(g, &mut random)).collect();
        let feedback: Vec<Texel> = guide
            .iter()
            .map(|_| {
                let [a, b] = pack_rgb(radiance(&mut random));
                [a, b, 0, 0]
            })
            .collect();
        let mut inputs =
            vec![("guide", guide.iter().map(|g| [g[0], g[1], 0, 0]).collect()), ("history", history.clone())];
        if step.features.has(Feedback) {
            inputs.push(("feedback", feedback.clone()));
        }
        let written = bench.run(&step, &inputs);
        let fed = feedback.iter().map(|f| unpack_rgb([f[0], f[1]]));
        let own = history.iter().map(|h| kept(*h).color);
        let colors: Vec<V> = if step.features.has(Feedback) { fed.collect() } else { own.collect() };
        for (x, y) in bench.pixels() {
            let i = bench.at(x, y).unwrap();
            let (out, what) = (written["color_out"][i], || format!("{size:?} ({x}, {y}), {features:?}"));
            if kept(history[i]).length == 0.0 {
                if depth(guide[i]) == 0.0 {
                    assert_eq!(out, [0; 4], "{}: a miss", what());
                    continue;
                }
                if history[i] != [0; 4] {
                    let (found, deviation) = unpack_tap(out);
                    let mean = luminance(found) / luminance(colors[i]);
                    assert!((mean - 1.0).abs() < 2e-3 && deviation == 0.0, "{}: infinite", what());
                    continue;
                }
                let (mean, expected, squares) = fill(&bench, &guide, &history, &colors, x, y);
                let (found, deviation) = unpack_tap(out);
                for (found, expected) in found.into_iter().zip(mean) {
                    let allowed = 2e-3 * expected + 1e-3 * squares.sqrt() + 1e-9;
                    assert_close(found, expected, allowed, || format!("{}: filled", what()));
                }
                let allowed = 4e-3 * expected.powi(2) + 2e-3 * squares + 1e-18;
                let error = (deviation.powi(2) - expected.powi(2)).abs();
                assert!(error <= allowed, "{}: deviation {deviation} of what fills, not {expected}", what());
                continue;
            }
            let source = colors[i];
            let (color, deviation) = unpack_tap(out);
            for (found, expected) in color.into_iter().zip(source) {
                assert_close(found, expected, expected * 2.0_f64.powi(-11) + 1e-9, || format!("{}: colour", what()));
            }
            let (expected, squares) = twin(&bench, step.features, &guide, &history, x, y);
            // Results are stored to 2⁻¹², and not below 2⁻³⁰. A neighbour of weight e⁻⁸ may be cut or not. A difference of squares
            // is as precise as the squares.
            let error = (deviation.powi(2) - expected.powi(2)).abs();
            let allowed = 2e-3 * expected.powi(2) + 1e-3 * squares + 1e-18;
            assert!(error <= allowed, "{}: deviation {deviation}, not {expected} (squares up to {squares})", what());
        }
    }
}
