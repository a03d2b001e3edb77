//! A host's radiance: demodulated and cleaned.

use super::bench::{Bench, SIZES, Texel};
use super::codec::{assert_close, unpack_rgb};
use super::plane::V;
use super::random::Random;
use crate::Settings;
use crate::passes::{Step, ingest_radiance};
use crate::plan::{Feature, Features};

fn half(bits: u32) -> f64 {
    let (exponent, mantissa) = ((bits >> 10 & 31) as i32, f64::from(bits & 1023));
    if exponent == 0 { mantissa * 2.0_f64.powi(-24) } else { (1.0 + mantissa / 1024.0) * 2.0_f64.powi(exponent - 15) }
}

/// Colours, now and then with a channel that is not a number.
fn colors(count: usize, random: &mut Random) -> Vec<[f32; 3]> {
    let broken = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.25];
    let channel = |random: &mut Random| match random.below(12) {
        0 => broken[random.below(4)],
        1 => 0.0,
        _ => random.unit() as f32,
    };
    (0..count).map(|_| [0; 3].map(|_| channel(random))).collect()
}

/// The value of a channel that may enter the history.
fn clean(x: f32) -> f64 {
    match x {
        f32::INFINITY => 65504.0,
        _ if x.is_finite() && x > 0.0 => x.into(),
        _ => 0.0,
    }
}

/// The albedo that divides radiance. An albedo that is not a number is unknown, and divides nothing.
fn known(x: f32) -> f64 {
    if x.is_finite() { clean(x) } else { 1.0 }
}

fn check(features: &[Feature], continued: bool) {
    let step = Step::new(&ingest_radiance::PASS, Features::of(features));
    let has = |feature| step.features.has(feature);
    let mut holes = 0;
    for size in SIZES {
        let bench = Bench { continued, ..Bench::new(size, Settings::adaptive()) };
        let mut random = Random(41);
        let count = (size[0] * size[1]) as usize;
        let guide = bench.guide(&mut random);
        let records = bench.records(&guide, &mut random);
        let [mut radiance, mut albedo, emission] = [0; 3].map(|_| colors(count, &mut random));
        // Some pixels are ink, or are bright although their albedo is 0.
        for i in (0..count).filter(|i| i % 7 == 3) {
            albedo[i] = [0.0; 3];
            radiance[i] = if i % 2 == 0 { [0.0; 3] } else { radiance[i] };
        }
        // The albedos are powers of ½: ¼, ½, 1.
        let before: Vec<u32> = (0..count).map(|_| [0x3400, 0x3800, 0x3c00][random.below(3)]).collect();
        let texels = |image: &[[f32; 3]]| -> Vec<Texel> {
            image.iter().map(|c| [c[0].to_bits(), c[1].to_bits(), c[2].to_bits(), 0]).collect()
        };
        let all = [
            ("radiance", texels(&radiance)),
            ("albedo", texels(&albedo)),
            ("emission", texels(&emission)),
            ("guide", guide.iter().map(|g| [g[0], g[1], 0, 0]).collect()),
            ("samples", records.clone()),
            ("albedo_previous", before.iter().map(|&h| [h | h << 16, h, 0, 0]).collect()),
        ];
        let used: Vec<_> = all
            .into_iter()
            .filter(|(n, _): &(&str, Vec<Texel>)| step.bindings.iter().any(|bound| bound.name == *n))
            .collect();
        let written = bench.run(&step, &used);
        for (x, y) in bench.pixels() {
            let i = bench.at(x, y).unwrap();
            let what = || format!("{size:?} ({x}, {y}), {:?}", step.features);
            let modulated = has(Feature::Modulated);
            let record = records[bench.stratum(x / 3, y / 3).unwrap()];
            let repeats = record[0] != 0 && Bench::sample_pixel(record, x / 3, y / 3) == (x, y);
            let mut expected: V = radiance[i].map(clean);
            if has(Feature::DirectEmission) {
                let found = unpack_rgb([written["emission_out"][i][0], written["emission_out"][i][1]]);
                let brightest = emission[i].map(clean).into_iter().fold(1.0, f64::max);
                for c in 0..3 {
                    let e = clean(emission[i][c]);
                    assert_close(found[c], e, 4e-6 * brightest, || format!("{}: emission", what()));
                    if modulated {
                        expected[c] = (expected[c] - e).max(0.0);
                    }
                }
            }
            // Some pixels have neither light nor albedo, beside four pixels that have one.
            let reflects = |&(x, y): &(i32, i32)| bench.at(x, y).is_some_and(|q| albedo[q].iter().any(|&a| a > 0.0));
            let around = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (x, y)));
            let black = expected == [0.0; 3] && albedo[i] == [0.0; 3];
            let filtered = modulated && has(Feature::MissingSamples);
            let hole = filtered && has(Feature::Albedo) && black && around.filter(reflects).count() >= 4;
            holes += usize::from(hole);
            if has(Feature::Albedo) {
                let texel = written["albedo_out"][i];
                let found = [texel[0] & 0xffff, texel[0] >> 16, texel[1] & 0xffff].map(half);
                for c in 0..3 {
                    let a = match (modulated, guide[i][1] != 0) {
                        (false, _) => known(albedo[i][c]),
                        (true, true) if hole => 0.0,
                        (true, true) => known(albedo[i][c]).clamp(0.02, 1.0),
                        (true, false) => 1.0,
                    };
                    assert_close(found[c], a, 1e-3 * a, || format!("{}: albedo", what()));
                    if modulated && has(Feature::Reshade) && repeats {
                        // The surface is that of the pixel whose path is repeated.
                        let q = bench.at((record[1] & 0xffff) as i32, (record[1] >> 16) as i32).unwrap();
                        expected[c] /= half(before[q]);
                    } else if modulated {
                        // Radiance is divided by the stored albedo.
                        expected[c] /= found[c].max(0.02);
                    }
                }
            }
            let words = written["radiance_out"][i];
            let alone = has(Feature::Reshade) && repeats && !continued;
            if radiance[i].iter().any(|c| c.is_nan()) || alone || hole {
                assert_eq!(words, [0, 1 << 22, 0, 0], "{}: no sample", what());
                continue;
            }
            let emitted = has(Feature::DirectEmission) && modulated;
            let explained = |c: usize| emitted && emission[i][c] == f32::INFINITY;
            let infinite = (0..3).any(|c| radiance[i][c] == f32::INFINITY && !explained(c));
            assert_eq!(words[1] >> 31 == 1, infinite, "{}: marked", what());
            let found = unpack_rgb([words[0], words[1] & !(1 << 31)]);
            let largest = expected.into_iter().fold(0.0, f64::max);
            for c in 0..3 {
                assert_close(found[c], expected[c], 5e-6 * largest, || format!("{}: radiance", what()));
            }
        }
    }
    let possible = [Feature::Modulated, Feature::Albedo, Feature::MissingSamples].into_iter().all(has);
    assert_eq!(holes > 5, possible, "{features:?}: {holes} holes");
}

#[test]
fn every_kind_of_radiance() {
    use Feature::*;
    check(&[], true);
    check(&[Albedo], true);
    check(&[DirectEmission], true);
    check(&[Albedo, DirectEmission], true);
    check(&[Modulated, DirectEmission], true);
    check(&[Modulated, Albedo], true);
    check(&[Modulated, Albedo, DirectEmission], true);
    check(&[Modulated, Albedo, MissingSamples], true);
    check(&[Modulated, Albedo, DirectEmission, Reshade, MissingSamples], true);
    check(&[Modulated, Albedo, DirectEmission, Reshade], true);
    check(&[Modulated, Albedo, DirectEmission, Reshade], false);
    check(&[Modulated, DirectEmission, Reshade], true);
    check(&[Reshade], false);
}
