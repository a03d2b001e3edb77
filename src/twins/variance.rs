//! What the spatial filter starts from: colour, and the deviation of a mean; in short histories from 7×7 neighbours on the same
//! surface.

use super::bench::{Bench, SIZES, Texel};
use super::codec::{
    Kept, assert_close, depth, luminance, pack_history, pack_rgb, radiance, unpack_history, unpack_normal, unpack_rgb,
    unpack_tap,
};
use super::plane::{dot, sub};
use super::random::Random;
use super::strata::falloff;
use crate::Settings;
use crate::passes::variance;
use crate::plan::{Feature, Features};

fn kept(texel: Texel) -> Kept {
    unpack_history([texel[0], texel[1]])
}

/// The standard deviation that steers the luminance stop, and the scale of the numbers that it is a difference of.
fn twin(bench: &Bench, features: Features, guide: &[[u32; 2]], history: &[Texel], x: i32, y: i32) -> (f64, f64) {
    let i = bench.at(x, y).unwrap();
    let (normal, z, n) = (unpack_normal(guide[i][0]), depth(guide[i]), kept(history[i]).length);
    let of_mean = features.has(Feature::VarianceOfMean);
    let own = kept(history[i]).variance;
    if n >= 4.0 {
        // With Bessel's correction while n is below 8.
        let bessel = if n < 8.0 { n / (n - 1.0) } else { 1.0 };
        return (if of_mean { own * bessel / n } else { own }.sqrt(), 0.0);
    }
    let position = bench.position(x, y, z);
    let (mut first, mut second, mut weights) = (0.0, 0.0, 0.0);
    let mut squares = 0.0;
    for (dx, dy) in (-3..=3).flat_map(|dy| (-3..=3).map(move |dx| (dx, dy))) {
        let Some(q) = bench.at(x + dx, y + dy).filter(|&q| depth(guide[q]) > 0.0) else { continue };
        let distance = dot(normal, sub(bench.position(x + dx, y + dy, depth(guide[q])), position)).abs();
        let exponent = distance / (0.02 * z) + 64.0 * (1.0 - dot(normal, unpack_normal(guide[q][0])));
        let (w, mean) = (falloff(exponent), luminance(kept(history[q]).color));
        let second_moment = kept(history[q]).variance + mean * mean;
        first += w * mean;
        second += w * second_moment;
        squares = f64::max(squares, second_moment);
        weights += w;
    }
    // E[m₂] − E[m]², where the second moments are the neighbours' own; four frames' worth of trust.
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
    let sets: [&[Feature]; 4] = [&[], &[VarianceOfMean], &[Feedback], &[VarianceOfMean, Feedback]];
    // With fireflies (10⁵) and without: beside one, nothing else counts.
    for ((features, size), brightest) in
        sets.into_iter().flat_map(|f| SIZES.map(|s| (f, s))).flat_map(|c| [(c, 1.0), (c, 1e9)])
    {
        let bench = Bench::new(size, Settings::adaptive());
        let step = variance::step(Features::of(features));
        let mut random = Random(12);
        let guide = bench.guide(&mut random);
        let texel = |g: &[u32; 2], random: &mut Random| -> Texel {
            if depth(*g) == 0.0 {
                return [0; 4];
            }
            let length = [1.0, 1.5, 2.0, 3.0, 3.75, 4.0, 6.0, 20.0][random.below(8)];
            let color = radiance(random).map(|c| c.min(brightest));
            // Fed by the spatial filter, the history has the mean luminance in the colour's place.
            let color = if step.features.has(Feedback) { [luminance(color); 3] } else { color };
            let [a, b] = pack_history(Kept { color, variance: random.unit() * luminance(color).powi(2), length });
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
        for (x, y) in bench.pixels() {
            let i = bench.at(x, y).unwrap();
            let (out, what) = (written["color_out"][i], || format!("{size:?} ({x}, {y}), {features:?}"));
            if kept(history[i]).length == 0.0 {
                assert_eq!(out, [0; 4], "{}: a miss", what());
                continue;
            }
            let fed = unpack_rgb([feedback[i][0], feedback[i][1]]);
            let source = if step.features.has(Feedback) { fed } else { kept(history[i]).color };
            let (color, deviation) = unpack_tap(out);
            for (found, expected) in color.into_iter().zip(source) {
                assert_close(found, expected, expected * 2.0_f64.powi(-11) + 1e-9, || format!("{}: colour", what()));
            }
            let (expected, squares) = twin(&bench, step.features, &guide, &history, x, y);
            // Stored to 2⁻¹², and not below 2⁻³⁰; a neighbour of weight e⁻⁸ may be cut or not, and what is left of squares is as exact
            // as they are.
            let error = (deviation.powi(2) - expected.powi(2)).abs();
            let allowed = 2e-3 * expected.powi(2) + 1e-3 * squares + 1e-18;
            assert!(error <= allowed, "{}: deviation {deviation}, not {expected} (squares up to {squares})", what());
        }
    }
}
