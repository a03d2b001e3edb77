//! A host's pairs: the pixel of the stratum that they stand for, and the albedo that they are divided by.

use super::bench::{Bench, SIZES, Texel};
use super::codec::{assert_close, luminance, unpack_rgb, word};
use super::plane::V;
use super::random::Random;
use crate::Settings;
use crate::passes::{Step, ingest_pairs};
use crate::plan::{Feature, Features};

/// Albedos that f16 holds exactly.
const HALVES: [(u32, f64); 3] = [(0x3400, 0.25), (0x3800, 0.5), (0x3c00, 1.0)];

/// An image of a host: no value in `nothing` of twelve pixels, and now and then an invalid one.
fn values(count: usize, nothing: usize, random: &mut Random) -> Vec<V> {
    (0..count)
        .map(|_| match random.below(12) {
            k if k < nothing => [-1.0; 3],
            10 => [0.5, f64::NAN, 0.5],
            11 => [0.3, 0.3, -1.0],
            _ => [0; 3].map(|_| f64::from(random.unit() as f32)),
        })
        .collect()
}

fn check(features: &[Feature]) {
    let step = Step::new(&ingest_pairs::PASS, Features::of(features));
    let has = |feature| step.features.has(feature);
    let mut pairs = 0;
    for size in SIZES {
        let bench = Bench::new(size, Settings::adaptive());
        let mut random = Random(51);
        let guide = bench.guide(&mut random);
        let per_stratum = has(Feature::StratumPairs);
        let count = if per_stratum { bench.strata().len() } else { guide.len() };
        let [current, previous] =
            [if per_stratum { 4 } else { 7 }, 1].map(|nothing| values(count, nothing, &mut random));
        let albedo: Vec<[usize; 3]> = guide.iter().map(|_| [0; 3].map(|_| random.below(3))).collect();
        let texels =
            |image: &[V]| -> Vec<Texel> { image.iter().map(|c| [word(c[0]), word(c[1]), word(c[2]), 0]).collect() };
        let mut inputs = vec![
            ("guide", guide.iter().map(|g| [g[0], g[1], 0, 0]).collect::<Vec<Texel>>()),
            ("current", texels(&current)),
            ("previous", texels(&previous)),
        ];
        let divided = has(Feature::Albedo) && has(Feature::Modulated);
        if divided {
            let bits = |a: &[usize; 3]| a.map(|k| HALVES[k].0);
            inputs.push(("albedo", albedo.iter().map(bits).map(|[r, g, b]| [r | g << 16, b, 0, 0]).collect()));
        }
        let written = bench.run(&step, &inputs);
        for (sx, sy) in bench.strata() {
            let s = bench.stratum(sx, sy).unwrap();
            // Take the centre or the pixel nearest to it; else the first of nine.
            let [w, h] = size.map(|s| s as i32);
            let places: Vec<(i32, i32)> = if per_stratum {
                vec![((3 * sx + 1).min(w - 1), (3 * sy + 1).min(h - 1))]
            } else {
                (0..9).map(|k| (3 * sx + k % 3, 3 * sy + k / 3)).collect()
            };
            let chosen = places.iter().find_map(|&(x, y)| {
                let i = bench.at(x, y)?;
                let at = if per_stratum { s } else { i };
                let channels = if has(Feature::LuminancePairs) { 1 } else { 3 };
                let usable = |v: &V| v[..channels].iter().all(|c| c.is_finite() && *c >= 0.0);
                (guide[i][1] != 0 && usable(&current[at]) && usable(&previous[at])).then_some((x, y, i, at))
            });
            let what = || format!("{size:?} ({sx}, {sy}), {:?}", step.features);
            let record = written["samples_out"][s];
            let found = ["pair_now_out", "pair_before_out"].map(|n| unpack_rgb([written[n][s][0], written[n][s][1]]));
            let Some((x, y, i, at)) = chosen else {
                assert_eq!((record, found), ([0; 4], [[0.0; 3]; 2]), "{}: there is no pair", what());
                continue;
            };
            pairs += 1;
            assert_eq!(Bench::sample_pixel(record, sx, sy), (x, y), "{}", what());
            assert_eq!(record[2..], guide[i], "{}", what());
            let mut divisor = if divided { albedo[i].map(|k| HALVES[k].1) } else { [1.0; 3] };
            if has(Feature::LuminancePairs) {
                divisor = [luminance(divisor); 3];
            }
            for (found, given) in found.into_iter().zip([current[at], previous[at]]) {
                let value = |c: usize| if has(Feature::LuminancePairs) { given[0] } else { given[c] } / divisor[c];
                for (c, found) in found.into_iter().enumerate() {
                    assert_close(found, value(c), 2e-5, what);
                }
            }
        }
    }
    assert!(pairs > 10, "only {pairs} pairs");
}

#[test]
fn every_kind_of_pairs() {
    use Feature::*;
    check(&[]);
    check(&[LuminancePairs]);
    check(&[StratumPairs, Albedo]);
    check(&[Albedo, Modulated]);
    check(&[LuminancePairs, StratumPairs, Albedo, Modulated]);
}
