//! The picture: colour · albedo + emission, and its mean over frames.

use super::bench::{Bench, SIZES, Texel};
use super::codec::{
    Kept, assert_close, float, pack_history, pack_rgb, pack_tap, radiance, unpack_history, unpack_rgb, unpack_tap, word,
};
use super::random::Random;
use crate::Settings;
use crate::passes::{Nth, Step, resolve};
use crate::plan::{Feature, Features, Image};

/// Numbers that f16 holds in its 10 bits, like the albedo of the tracer.
const ALBEDOS: [(u32, f64); 4] = [(0x0000, 0.0), (0x3c00, 1.0), (0x3800, 0.5), (0x3555, 0.333_251_953_125)];

fn half(bits: u32) -> f64 {
    let (exponent, mantissa) = ((bits >> 10 & 31) as i32, f64::from(bits & 1023));
    match exponent {
        0 => mantissa * 2.0_f64.powi(-24),
        31 => f64::INFINITY,
        e => (1.0 + mantissa / 1024.0) * 2.0_f64.powi(e - 15),
    }
}

fn check(features: &[Feature], bright: f64) {
    for size in SIZES {
        for continued in [false, true] {
            let bench = Bench { continued, ..Bench::new(size, Settings::adaptive()) };
            let features = Features::of(features);
            let unfiltered = features.has(Feature::Unfiltered);
            let temporal_only = features.has(Feature::TemporalOnly);
            let mut random = Random(9);
            let count = (size[0] * size[1]) as usize;
            let mut texels = |f: &mut dyn FnMut(&mut Random) -> Texel| -> Vec<Texel> {
                (0..count).map(|_| f(&mut random)).collect()
            };
            let packed = |r: &mut Random| {
                let [a, b] = pack_rgb(radiance(r).map(|c| c * bright));
                [a, b, 0, 0]
            };
            // Every fifth pixel sees nothing.
            let guide = texels(&mut |r| [1, u32::from(r.below(5) > 0), 0, 0]);
            let color = texels(&mut |r| {
                let color = radiance(r);
                let [a, b] = match () {
                    () if unfiltered => pack_rgb(color.map(|c| c * bright)),
                    () if temporal_only => pack_history(Kept { color, variance: r.unit(), length: 3.0 }),
                    () => pack_tap(color, 1.0),
                };
                [a, b, 0, 0]
            });
            let sky = texels(&mut |r| packed(r));
            let albedo = texels(&mut |r| {
                let [a, b, c] = [0; 3].map(|_| ALBEDOS[r.below(4)].0);
                [a | b << 16, c, 0, 0]
            });
            let emission = texels(&mut |r| packed(r));
            let before = texels(&mut |r| [0; 4].map(|_| word(10.0 * r.unit())));
            let step = Step::nth(
                &resolve::PASS,
                features,
                Nth::of(Some(if temporal_only { Image::History } else { Image::Color(0) })),
            );
            let mut inputs = vec![(if unfiltered { "radiance" } else { "color" }, color.clone())];
            if features.has(Feature::Background) {
                inputs.push(("radiance", sky.clone()));
                inputs.push(("guide", guide.clone()));
            }
            if features.has(Feature::Albedo) {
                inputs.push(("albedo", albedo.clone()));
            }
            if features.has(Feature::DirectEmission) {
                inputs.push(("emission", emission.clone()));
            }
            if features.has(Feature::Accumulate) {
                inputs.push(("sum_previous", before.clone()));
            }
            let written = bench.run(&step, &inputs);
            for i in 0..count {
                let reflected = if features.has(Feature::Background) && guide[i][1] == 0 {
                    unpack_rgb([sky[i][0], sky[i][1]])
                } else if unfiltered {
                    unpack_rgb([color[i][0], color[i][1]])
                } else if temporal_only {
                    unpack_history([color[i][0], color[i][1]]).color
                } else {
                    unpack_tap(color[i]).0
                };
                let a = if features.has(Feature::Albedo) {
                    [albedo[i][0] & 0xffff, albedo[i][0] >> 16, albedo[i][1] & 0xffff].map(half)
                } else {
                    [1.0; 3]
                };
                let e = unpack_rgb([emission[i][0], emission[i][1]]);
                for c in 0..3 {
                    let mut expected = reflected[c] * a[c];
                    if features.has(Feature::DirectEmission) {
                        expected += e[c];
                    }
                    if features.has(Feature::Accumulate) && continued {
                        expected = (expected + float(before[i][c])) / (1.0 + float(before[i][3]));
                    }
                    let target = written["target_out"][i];
                    let (found, rounding, limit) = if features.has(Feature::TargetF16) {
                        (half(target[c / 2] >> (16 * (c % 2)) & 0xffff), 2.0_f64.powi(-10), 65504.0)
                    } else {
                        (float(target[c]), 1e-6, 3.4e38)
                    };
                    // Drivers may truncate instead of rounding to f16, which has steps of 2⁻²⁴ near 0.
                    let (expected, tolerance) = (expected.min(limit), rounding * expected.abs() + 6e-8);
                    assert_close(found, expected, tolerance, || format!("{size:?} {i}, {features:?}, {continued}"));
                }
            }
        }
    }
}

#[test]
fn every_way_of_putting_it_together() {
    use Feature::*;
    let sets: [&[Feature]; 11] = [
        &[Albedo],
        &[Albedo, DirectEmission],
        &[Albedo, Unfiltered],
        &[Albedo, Unfiltered, DirectEmission],
        &[Albedo, DirectEmission, TargetF16],
        &[Albedo, Unfiltered, Accumulate, DirectEmission],
        &[TemporalOnly, Albedo],
        &[TemporalOnly, Background, Albedo, DirectEmission],
        &[Background],
        &[Background, Albedo, DirectEmission],
        &[Unfiltered],
    ];
    for features in sets {
        check(features, 1.0);
    }
    // A radiance above the range of f16 becomes its largest number, not infinity.
    check(&[Albedo, Unfiltered, DirectEmission, TargetF16], 1e20);
}
