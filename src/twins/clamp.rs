//! The clamp of lone spots before the spatial filter: a pixel of luminance l is multiplied by
//!
//!   min(1, b/l)·min(1.5, Σl/Σmin(l, b)),  b = gloss_clamp·(third largest of the 24 around on the surface)

use super::bench::{Bench, SIZES, Texel};
use super::codec::{
    Kept, assert_close, depth, luminance, pack_history, pack_reflection, radiance, unpack_history, unpack_normal,
    unpack_tap,
};
use super::plane::dot;
use super::random::Random;
use super::variance::neighbour;
use crate::Settings;
use crate::passes::{Step, variance};
use crate::plan::{Feature, Features};

fn kept(texel: Texel) -> Kept {
    unpack_history([texel[0], texel[1]])
}

const OFFSETS: std::ops::RangeInclusive<i32> = -2..=2;

fn window() -> impl Iterator<Item = [i32; 2]> {
    OFFSETS.flat_map(|dy| OFFSETS.map(move |dx| [dx, dy]))
}

/// The factor on a pixel that has a history; and true if a threshold was near.
fn factor(bench: &Bench, guide: &[[u32; 2]], history: &[Texel], [x, y]: [i32; 2]) -> (f64, bool) {
    let i = bench.at(x, y).unwrap();
    let own = luminance(kept(history[i]).color);
    let mut unsure = false;
    let mut around = Vec::new();
    for [dx, dy] in window().filter(|o| *o != [0, 0]) {
        let Some(q) = bench.at(x + dx, y + dy).filter(|&q| depth(guide[q]) > 0.0) else { continue };
        let cosine = dot(unpack_normal(guide[i][0]), unpack_normal(guide[q][0]));
        unsure |= (cosine - 0.8).abs() < 1e-5;
        if cosine >= 0.8 && kept(history[q]).length > 0.0 {
            around.push(luminance(kept(history[q]).color));
        }
    }
    if around.len() < 6 {
        return (1.0, unsure);
    }
    around.sort_by(|a, b| b.total_cmp(a));
    let bound = f64::from(bench.settings.filter.gloss_clamp) * around[2];
    around.push(own);
    let [all, bounded] = [f64::INFINITY, bound].map(|most| around.iter().map(|l| l.min(most)).sum::<f64>());
    let given_back = if bounded > 0.0 { (all / bounded).min(1.5) } else { 1.5 };
    let part = if own > 0.0 { (bound / own).min(1.0) } else { 1.0 };
    (part * if all > 0.0 { given_back } else { 1.0 }, unsure)
}

/// The variance before the clamp, and the greatest second moment that went in.
fn variance_before(
    bench: &Bench,
    features: Features,
    guide: &[[u32; 2]],
    history: &[Texel],
    [x, y]: [i32; 2],
) -> (f64, f64) {
    let Kept { variance, length: n, .. } = kept(history[bench.at(x, y).unwrap()]);
    let own = if n < 8.0 { variance * n / (n - 1.0).max(0.5) } else { variance };
    let (mut first, mut second, mut weights, mut squares) = (0.0, 0.0, 0.0, 0.0_f64);
    for (q, w) in window().filter_map(|offset| neighbour(bench, guide, history, [x, y], offset)) {
        let Kept { color, variance, .. } = kept(history[q]);
        let l = luminance(color);
        first += w * l;
        second += w * (variance + l * l);
        squares = squares.max(variance + l * l);
        weights += w;
    }
    // A mirror's own picture varies, so specular light has no factor 4/n.
    let few = if features.has(Feature::SpecularSignal) { 1.0 } else { (4.0 / n).max(1.0) };
    let spatial = (second / weights - (first / weights).powi(2)).max(0.0) * few;
    let trust = ((n - 1.0) / 3.0).clamp(0.0, 1.0);
    ((spatial + trust * (own - spatial)) / n, squares)
}

#[test]
fn lone_spots_give_their_light_to_the_window() {
    use Feature::*;
    let sets: [&[Feature]; 3] = [
        &[SpecularSignal, Clamp, VarianceOfMean],
        &[SpecularSignal, Clamp, VarianceOfMean, MissingSamples],
        &[MixedGloss, Clamp, VarianceOfMean],
    ];
    let (mut clamped, mut lifted, mut alone) = (0, 0, 0);
    for (size, features) in SIZES.into_iter().flat_map(|s| sets.map(|f| (s, Features::of(f)))) {
        let bench = Bench::new(size, Settings::adaptive());
        let step = Step::new(&variance::PASS, features);
        let mut random = Random(17);
        let guide = bench.guide(&mut random);
        let specular = features.has(SpecularSignal);
        // Codes of roughness; a part of the surfaces does not shine.
        let mut code = |_| if random.below(8) == 0 { 0 } else { 1 + random.below(255) as u32 };
        let codes: Vec<u32> = guide.iter().map(&mut code).collect();
        let mut texel = |(g, code): (&[u32; 2], &u32)| -> Texel {
            if depth(*g) == 0.0 || specular && *code == 0 {
                return [0; 4];
            }
            let spot = [1.0, 1.0, 1.0, 1.0, 1e-3, 30.0, 1000.0][random.below(7)];
            let color = radiance(&mut random).map(|c| spot * c.min(1.0));
            let length = [1.0, 2.0, 3.75, 4.0, 6.0, 20.0][random.below(6)];
            let [a, b] = pack_history(Kept { color, variance: random.unit() * luminance(color).powi(2), length });
            [a, b, 0, 0]
        };
        let history: Vec<Texel> = guide.iter().zip(&codes).map(&mut texel).collect();
        let mut inputs =
            vec![("guide", guide.iter().map(|g| [g[0], g[1], 0, 0]).collect()), ("history", history.clone())];
        if specular {
            let texel = |(code, g): (&u32, &[u32; 2])| match depth(*g) > 0.0 && *code > 0 {
                true => pack_reflection([0.5, -1.0, 2.0], *code),
                false => [0; 2],
            };
            let reflections = codes.iter().zip(&guide).map(texel).map(|r| [r[0], r[1], 0, 0]).collect();
            inputs.push(("reflection", reflections));
        }
        let written = bench.run(&step, &inputs);
        for (x, y) in bench.pixels() {
            let i = bench.at(x, y).unwrap();
            let what = || format!("{size:?} ({x}, {y}), {features:?}");
            if specular {
                let own = written["guide_out"][i];
                let shines = depth(guide[i]) > 0.0 && codes[i] > 0;
                let expected = if shines { [guide[i][0], guide[i][1] & !255 | codes[i]] } else { [0; 2] };
                assert_eq!([own[0], own[1]], expected, "{}: the guide of the spatial filter", what());
            }
            let Kept { color, length, .. } = kept(history[i]);
            if length == 0.0 {
                continue;
            }
            let (factor, unsure) = factor(&bench, &guide, &history, [x, y]);
            if unsure {
                continue;
            }
            clamped += usize::from(factor < 0.9);
            lifted += usize::from(factor > 1.1);
            alone += usize::from(factor == 1.0);
            let (found, deviation) = unpack_tap(written["color_out"][i]);
            for (found, given) in found.into_iter().zip(color) {
                assert_close(found, factor * given, 1e-3 * factor * given + 1e-9, || format!("{}: colour", what()));
            }
            let (variance, squares) = variance_before(&bench, features, &guide, &history, [x, y]);
            let expected = factor * factor * variance;
            let allowed = 3e-3 * expected + 1e-3 * factor * factor * squares + 1e-18;
            assert_close(deviation.powi(2), expected, allowed, || format!("{}: variance", what()));
        }
    }
    assert!(clamped > 50 && lifted > 50 && alone > 50, "{clamped} clamped, {lifted} lifted, {alone} alone: no grip");
}
