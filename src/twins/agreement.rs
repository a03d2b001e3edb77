//! The evidence of each stratum for the former place of its reflections, V, against that of their surface, S.

use super::bench::{Bench, SIZES, Texel};
use super::codec::{
    assert_close, depth, luminance, pack_reflection, unpack_normal, unpack_reflection, unpack_unsigned,
};
use super::last_frame::Given;
use super::plane::{V, dot, sub};
use super::random::Random;
use crate::Settings;
use crate::passes::{Step, agreement};
use crate::plan::Feature;

/// Mean luminance and variance of the history at a pixel, if it shows the same mirror, and the same place of it if one is given.
fn history_at(given: &Given, here: usize, [x, y]: [i32; 2], place: Option<V>, unsure: &mut bool) -> Option<(f64, f64)> {
    let bench = &given.bench;
    let q = bench.at(x, y)?;
    let z = depth(given.guide_before[q]);
    if z == 0.0 || given.object_at(&given.object_before, q) != given.object_at(&given.object, here) {
        return None;
    }
    let normal = unpack_normal(given.guide_before[q][0]);
    let mut tests = vec![dot(normal, unpack_normal(given.guide[here][0])) - 0.9];
    if let Some(place) = place {
        let previous = Bench { camera: bench.previous, ..bench.clone() };
        let offset = sub(place, previous.position(x, y, z));
        tests.extend([0.01 - dot(normal, offset).abs() / z, 0.05 - dot(offset, offset).sqrt() / z]);
    }
    *unsure |= tests.iter().any(|t| t.abs() < 1e-5);
    let length = given.history[q].length;
    (tests.iter().all(|&t| t >= 0.0) && length > 0.0).then(|| (given.stored(q).1, given.history[q].variance))
}

/// A stratum's evidence.
#[derive(Debug, Default)]
struct Evidence {
    t: f64,
    s: f64,
    normal: Option<u32>,
    /// Sum of the absolute terms of t.
    absolute: f64,
    /// True if a threshold was near.
    unsure: bool,
}

/// t = Σ (V − S)·(E − (V + S)/2)/σ² and s = Σ (V − S)²/σ² over the pixels of a stratum that see the surface of the first one,
/// σ² = (Var V + Var S)/2 + 0.01·(V² + S²) + 10⁻⁵.
fn twin(given: &Given, reflections: &[[u32; 2]], [sx, sy]: [i32; 2]) -> Evidence {
    let mut found = Evidence::default();
    for place in (4..9).chain(0..4) {
        let [x, y] = [3 * sx + place % 3, 3 * sy + place / 3];
        let Some(i) = given.bench.at(x, y).filter(|&i| depth(given.guide[i]) > 0.0) else { continue };
        if let Some(normal) = found.normal {
            let cosine = dot(unpack_normal(normal), unpack_normal(given.guide[i][0]));
            found.unsure |= (cosine - 0.9).abs() < 1e-5;
            if cosine < 0.9 {
                continue;
            }
        }
        let (moved, shift) = (given.motion[i], unpack_reflection(reflections[i]));
        let apart = (moved[0] - shift[0]).hypot(moved[1] - shift[1]);
        found.unsure |= (apart - 0.1).abs() < 1e-4;
        let Some(sample) = given.sample(i).filter(|_| reflections[i] != [0; 2] && apart >= 0.1) else { continue };
        let mut nearest = |by: V| {
            let at = [f64::from(x) + by[0] + 0.5, f64::from(y) + by[1] + 0.5];
            found.unsure |= at.iter().any(|p| (p - p.round()).abs() < 1e-4);
            at.map(|p| p.floor() as i32)
        };
        let places = [nearest(moved), nearest(shift)];
        let was = given.former_place(i, x, y);
        let surface = history_at(given, i, places[0], Some(was), &mut found.unsure);
        let reflected = history_at(given, i, places[1], None, &mut found.unsure);
        let (Some((s, var_s)), Some((v, var_v))) = (surface, reflected) else { continue };
        found.normal.get_or_insert(given.guide[i][0]);
        let variance = 0.5 * (var_v + var_s) + 0.01 * (v * v + s * s) + 1e-5;
        let term = (v - s) * (luminance(sample) - 0.5 * (v + s)) / variance;
        found.t += term;
        found.absolute += term.abs();
        found.s += (v - s) * (v - s) / variance;
    }
    found
}

#[test]
fn evidence_is_the_likelihood_ratio_of_two_histories() {
    use Feature::*;
    let sets: [&[Feature]; 3] =
        [&[SpecularSignal], &[SpecularSignal, Objects, MissingSamples], &[SpecularSignal, Feedback]];
    let (mut compared, mut told, mut unsure) = (0, 0, 0);
    for (size, features) in SIZES.into_iter().flat_map(|s| sets.map(|f| (s, f))) {
        for (moving, continued) in [(false, true), (true, true), (true, false)] {
            let mut given = Given::new(size, features, Settings::adaptive(), moving);
            given.bench.continued = continued;
            let mut random = Random(31);
            let reflections: Vec<[u32; 2]> = given
                .motion
                .iter()
                .map(|&[x, y, _]| match random.below(6) {
                    // Nothing shines, both places are one, or both are apart.
                    0 => [0; 2],
                    1 => pack_reflection([x, y, 1.0], 80),
                    _ => pack_reflection([x + random.between(-3.0, 3.0), y + random.between(-3.0, 3.0), 2.0], 1),
                })
                .collect();
            let step = Step::new(&agreement::PASS, given.features);
            let mut inputs = given.inputs(&step);
            let texels = reflections.iter().map(|r| [r[0], r[1], 0, 0]).collect::<Vec<Texel>>();
            inputs.push(("reflection", texels));
            let written = &given.bench.run(&step, &inputs)["agreement_out"];
            for (sx, sy) in given.bench.strata() {
                let texel = written[given.bench.stratum(sx, sy).unwrap()];
                let what = || format!("{size:?} ({sx}, {sy}) {features:?}, moving {moving}, continued {continued}");
                if !continued {
                    assert_eq!(texel, [0; 4], "{}: nothing to compare with", what());
                    continue;
                }
                let expected = twin(&given, &reflections, [sx, sy]);
                compared += 1;
                if expected.unsure {
                    unsure += 1;
                    continue;
                }
                let exists = expected.normal.map_or(0, |normal| normal | 1 << 31);
                assert_eq!(texel[1], exists, "{}: the normal that it is for", what());
                told += usize::from(expected.normal.is_some());
                let t = unpack_unsigned((texel[0] & 0x7fff) << 1) * if texel[0] >> 15 & 1 == 1 { -1.0 } else { 1.0 };
                // t has 9 bits, s 10.
                assert_close(t, expected.t, 2e-3 * expected.t.abs() + 1e-3 * expected.absolute + 1e-8, || {
                    format!("{}: t of {expected:?}", what())
                });
                assert_close(unpack_unsigned(texel[0] >> 16), expected.s, 2e-3 * expected.s + 1e-8, || {
                    format!("{}: s of {expected:?}", what())
                });
            }
        }
    }
    println!("{compared} strata, {told} with evidence, {unsure} at a threshold");
    assert!(told * 4 > compared && unsure * 5 < compared, "{told} of {compared}, {unsure} unsure: no grip");
}
