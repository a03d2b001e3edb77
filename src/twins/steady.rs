//! Blending with the last output: O = C + b·(clamp(O', lo, hi) − C).

use super::bench::{Bench, SIZES, Texel};
use super::codec::{assert_close, depth, luminance, pack_tap, radiance, unpack_normal, unpack_rgb, unpack_tap};
use super::plane::{V, dot};
use super::random::Random;
use crate::Settings;
use crate::passes::{Nth, Step, steady};
use crate::plan::{Features, Image};

/// Mean and deviation of a channel over the 3×3 pixels of the same surface; and true if a normal was at the threshold.
fn around(bench: &Bench, guide: &[[u32; 2]], colors: &[V], [x, y]: [i32; 2], channel: usize) -> (f64, f64, bool) {
    let normal = unpack_normal(guide[bench.at(x, y).unwrap()][0]);
    let mut unsure = false;
    let neighbours = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
    let values: Vec<f64> = neighbours
        .filter_map(|(u, v)| {
            let i = bench.at(u, v).filter(|&i| depth(guide[i]) > 0.0)?;
            let cosine = dot(normal, unpack_normal(guide[i][0]));
            let [own, other] = [bench.at(x, y).unwrap(), i].map(|i| luminance(colors[i]));
            let apart = own.max(other) - 2.0 * own.min(other);
            unsure |= (cosine - 0.9).abs() < 1e-5 || (u, v) != (x, y) && apart.abs() < 1e-5 * own;
            ((u, v) == (x, y) || cosine >= 0.9 && apart <= 0.0).then(|| colors[i][channel])
        })
        .collect();
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count;
    (mean, variance.sqrt(), unsure)
}

#[test]
fn the_last_output_is_blended_in_within_its_neighbourhood() {
    let (mut moved, mut bounded) = (0, 0);
    for size in SIZES {
        let bench = Bench::new(size, Settings::adaptive());
        let mut random = Random(31);
        let guide = bench.guide(&mut random);
        let texel = |seen: bool, color: V, fourth: f64| -> Texel {
            let [a, b] = if seen { pack_tap(color, fourth) } else { [0; 2] };
            [a, b, 0, 0]
        };
        let seen: Vec<bool> = guide.iter().map(|&g| depth(g) > 0.0).collect();
        let mut image = |fourth: f64| -> Vec<Texel> {
            seen.iter().map(|&s| texel(s, radiance(&mut random), fourth * random.unit())).collect()
        };
        let (color, last) = (image(0.3), image(0.9));
        let inputs = [
            ("guide", guide.iter().map(|g| [g[0], g[1], 0, 0]).collect()),
            ("color", color.clone()),
            ("reprojected", last.clone()),
        ];
        let written =
            bench.run(&Step::nth(&steady::PASS, Features::default(), Nth::of(Some(Image::Color(0)))), &inputs);
        let colors: Vec<V> = color.iter().map(|&t| unpack_tap(t).0).collect();
        for (x, y) in bench.pixels() {
            let i = bench.at(x, y).unwrap();
            let out = written["output_out"][i];
            let what = || format!("{size:?} ({x}, {y})");
            if !seen[i] {
                assert_eq!(out, [0; 4], "{}: a miss", what());
                continue;
            }
            let (before, weight) = unpack_tap(last[i]);
            let found = unpack_rgb([out[0], out[1]]);
            let largest = found.into_iter().chain(colors[i]).fold(0.0, f64::max);
            for channel in 0..3 {
                let own = colors[i][channel];
                let (mean, deviation, unsure) = around(&bench, &guide, &colors, [x, y], channel);
                if unsure {
                    continue;
                }
                let noise = 2.0 * unpack_tap(color[i]).1;
                let low = (mean - 1.5 * deviation).min(own).max(own - noise);
                let high = (mean + 1.5 * deviation).max(own).min(own + noise);
                let expected = own + weight * (before[channel].clamp(low, high) - own);
                bounded += usize::from(before[channel] < low || before[channel] > high);
                moved += usize::from((expected - own).abs() > 0.01 * own);
                // The deviation is a difference of squares in f32.
                let tolerance = 1e-5 * largest + 1e-3 * (deviation + mean) + 1e-9;
                assert_close(found[channel], expected, tolerance, || format!("{}: channel {channel}", what()));
            }
        }
    }
    assert!(moved > 100 && bounded > 100, "the test has lost its grip: {moved} moved, {bounded} bounded");
}
