//! The history's format: right on average in spite of rounding.

use super::codec::{hash, history_exponent};
use super::compute::compute;
use super::random::Random;
use crate::passes::resolve;
use crate::plan::Features;

struct Case {
    color: [f32; 3],
    variance: f32,
    length: f32,
    /// α; 0 stands for 1/n.
    alpha: f32,
    frames: u32,
    /// Spread of the samples, as a fraction of the colour.
    spread: f32,
}

impl Case {
    fn once(color: [f32; 3], variance: f32, length: f32) -> Self {
        Self { color, variance, length, alpha: 0.0, frames: 0, spread: 0.0 }
    }
}

/// The last stored colour, variance and length of each case.
fn run(cases: &[Case]) -> Vec<([f64; 3], f64, f64)> {
    let numbers: Vec<[f32; 4]> = cases
        .iter()
        .flat_map(|c| {
            let [r, g, b] = c.color;
            [[r, g, b, c.variance], [c.length, c.alpha, c.frames as f32, c.spread]]
        })
        .collect();
    let found = compute(include_str!("history.wgsl"), &resolve::PASS, Features::default(), &numbers, 2 * cases.len());
    found.chunks_exact(2).map(|t| ([0, 1, 2].map(|i| t[0][i].into()), t[0][3].into(), t[1][0].into())).collect()
}

/// Asserts that a mean of these numbers is 0 within five standard errors, given their root mean square.
fn assert_centred(errors: &[f64], what: &str) {
    let n = errors.len() as f64;
    let (mean, square) = (errors.iter().sum::<f64>() / n, errors.iter().map(|e| e * e).sum::<f64>() / n);
    assert!(mean.abs() <= 5.0 * (square / n).sqrt(), "{what}: {mean} steps too high, of {}", square.sqrt());
}

#[test]
fn what_is_rounded_is_right_on_average_and_never_a_step_off() {
    let mut random = Random(71);
    let cases: Vec<Case> = (0..40_000)
        .map(|_| {
            let scale = 10.0_f64.powf(random.between(-30.0, 30.0));
            let color = [0; 3].map(|_| (scale * random.unit()) as f32);
            let variance = (scale * random.between(-6.0, 13.0).exp2()).powi(2);
            // A variance that f32 cannot hold counts as 0.
            let variance = if (1e-37..1e37).contains(&variance) { variance as f32 } else { 0.0 };
            Case::once(color, variance, random.between(0.0, 15.0).exp2() as f32)
        })
        .collect();
    let mut errors = [const { Vec::new() }; 3];
    for (case, (color, variance, length)) in cases.iter().zip(run(&cases)) {
        let step = f64::from(history_exponent(case.color.map(f64::from), case.variance.into()) - 13).exp2();
        for (found, exact) in color.into_iter().zip(case.color) {
            errors[0].push((found - f64::from(exact)) / step);
        }
        let relative = |found: f64, exact: f32, bits: i32| {
            let exact = f64::from(exact);
            (found - exact) / (exact.log2().floor() - f64::from(bits)).exp2()
        };
        if case.variance > 0.0 {
            errors[1].push(relative(variance, case.variance, 4));
        } else {
            assert_eq!(variance, 0.0);
        }
        errors[2].push(relative(length, case.length, 4));
    }
    for (errors, what) in errors.iter().zip(["colour", "variance", "length"]) {
        assert!(errors.iter().all(|e| e.abs() <= 1.001), "{what}: more than a step off");
        assert_centred(errors, what);
    }
}

#[test]
fn a_part_of_a_step_is_rounded_up_as_often_as_it_is_large() {
    const CASES: usize = 1 << 18;
    // With a largest channel of 4096 … 8191, a step is 1 and an ulp of f32 is its 2048th. The last two cases have finer steps.
    for [red, green, blue] in [[1.0, 9.0, 3.0], [3.0, 2.0, 0.25], [7.0, 1024.0, 0.5], [1531.0, 2047.0, 4.75]] {
        let parts = [red, green, blue].map(|p: f64| p / 2048.0);
        let color = [5000.0 + parts[0] as f32, 4097.0 + parts[1] as f32, 900.0 + parts[2] as f32];
        let cases: Vec<Case> = (0..CASES).map(|_| Case::once(color, 0.0, 1.0)).collect();
        let found = run(&cases);
        for (channel, part) in parts.into_iter().enumerate() {
            let up = found.iter().filter(|(c, ..)| c[channel] > f64::from(color[channel])).count() as f64;
            let (n, expected) = (CASES as f64, CASES as f64 * part);
            let standard_error = (n * part * (1.0 - part)).sqrt();
            assert!((up - expected).abs() <= 5.0 * standard_error, "{up} of {n} are rounded up, not {expected}");
        }
    }
}

#[test]
fn what_needs_no_rounding_stays_what_it_is() {
    let frames = |case: Case| Case { frames: 1000, alpha: 1.0 / 64.0, ..case };
    let lengths = (1..=32).chain([48, 64, 100, 128, 1024, 32768]).map(|n| n as f32);
    let mut cases: Vec<Case> = lengths.map(|n| frames(Case::once([0.5, 0.25, 8191.0 / 8192.0], 0.75, n))).collect();
    // The cases are black, one channel, the largest number of a step, black that flickers, and light that flickers far more.
    for (color, variance) in [
        ([0.0; 3], 0.0),
        ([0.0, 3e9_f32.round(), 0.0].map(|c| (c / 1e6).floor() * 1048576.0), 0.0),
        ([8191.0; 3], 0.0),
        ([0.0; 3], 0.875),
        ([1.0, 2.0, 3.0], 1048576.0),
    ] {
        cases.push(frames(Case::once(color, variance, 1.0)));
    }
    for (case, (color, variance, length)) in cases.iter().zip(run(&cases)) {
        let expected = (case.color.map(f64::from), f64::from(case.variance), f64::from(case.length));
        assert_eq!((color, variance, length), expected);
    }
}

#[test]
fn what_is_twice_as_bright_is_stored_as_twice_of_it() {
    let mut random = Random(72);
    let colors: Vec<([f32; 3], f32)> =
        (0..5000).map(|_| ([0; 3].map(|_| random.unit() as f32), random.between(-20.0, 20.0).exp2() as f32)).collect();
    let run_scaled = |power: i32| {
        let scale = (power as f32).exp2();
        let case = |&(color, variance): &([f32; 3], f32)| Case {
            frames: 20,
            spread: 0.5,
            ..Case::once(color.map(|c| c * scale), variance * scale * scale, 1.0)
        };
        run(&colors.iter().map(case).collect::<Vec<_>>())
    };
    let plain = run_scaled(0);
    for power in [-40, -1, 1, 40] {
        let scale = f64::from(power).exp2();
        for ((color, ..), (found, ..)) in plain.iter().zip(run_scaled(power)) {
            assert_eq!(found, color.map(|c| c * scale), "2^{power}");
        }
    }
}

#[test]
fn running_averages_neither_drift_nor_stall() {
    const FRAMES: u32 = 1000;
    const CASES: usize = 2000;
    for (alpha, spread) in [(1.0 / 64.0, 1.0), (1.0 / 64.0, 0.01), (0.0, 1.0), (0.0, 0.1)] {
        let color = [0.7_f32, 0.31, 0.02];
        // Take the random numbers of red, which are spread evenly.
        let variance = (color[0] * spread).powi(2) / 3.0;
        let case = || Case { alpha, frames: FRAMES, spread, ..Case::once(color, variance, 1.0) };
        let cases: Vec<Case> = (0..CASES).map(|_| case()).collect();
        let step = f64::from(history_exponent(color.map(f64::from), variance.into()) - 13).exp2();
        let mut errors = [const { Vec::new() }; 3];
        for (i, (found, found_variance, length)) in run(&cases).into_iter().enumerate() {
            // Average the same in f64, with the colour as a fraction of itself.
            let (mut mean, mut square) = (1.0, f64::from(variance));
            for k in 1..=FRAMES {
                let u = f64::from(hash(i as u32 ^ hash(k)) >> 8) / 16_777_216.0;
                let weight = if alpha == 0.0 { 1.0 / f64::from(k + 1) } else { alpha.into() };
                let deviation = f64::from(spread) * (2.0 * u - 1.0);
                mean += weight * (1.0 + deviation - mean);
                square += weight * ((f64::from(color[0]) * deviation).powi(2) - square);
            }
            errors[0].extend(found.into_iter().zip(color).map(|(f, c)| (f - f64::from(c) * mean) / step));
            errors[1].push((found_variance / square - 1.0) * 16.0);
            let counted = if alpha == 0.0 { f64::from(FRAMES + 1) } else { 1.0 };
            errors[2].push((length / counted - 1.0) * 16.0);
        }
        // At worst, each frame adds ¼ step², which later frames shrink: Σ (1 − α)^2k = 1/(2α), or Σ (k/n)² = n/3. A length is
        // counted up by s in one case of s, with s ≤ k/16 in frame k: that adds s − 1, and n²/32 in all, which is 8 of (n/16)².
        let averaged = if alpha == 0.0 { f64::from(FRAMES) / 3.0 } else { 0.5 / f64::from(alpha) };
        let counted = 8.0 / 0.25;
        for ((errors, most), what) in
            errors.iter().zip([averaged, averaged, counted]).zip(["colour", "variance", "length"])
        {
            let n = errors.len() as f64;
            let rms = (errors.iter().map(|e| e * e).sum::<f64>() / n).sqrt();
            let mean = errors.iter().sum::<f64>() / n;
            println!("α {alpha}, spread {spread}, {what}: rms {rms:.2} steps, mean {mean:.3}");
            let bound = (0.25 * most).sqrt();
            assert!(rms <= bound, "α {alpha}, spread {spread}, {what}: {rms} steps");
            // Five standard errors of independent cases; the channels of a case share its random numbers.
            let drift = 5.0 * bound / (CASES as f64).sqrt();
            assert!(mean.abs() <= drift, "α {alpha}, spread {spread}, {what}: {mean} steps too high");
        }
    }
}
