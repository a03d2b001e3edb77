//! The range of radiance.

use super::painted::{Painted, Path, adaptive, grey};
use super::{Breaks, Case, Named, Worst, unusable};
use crate::stability::common::statistics::{Rgb, luminance, mean};
use asvgf::View;
use std::ops::Range;

const SIZE: [u32; 2] = [24, 18];

/// 10 mantissa bits of the spatial filter's input, rounded once in each of its iterations and once before.
const ROUNDING: f64 = 5.0 / 2048.0;

pub const CASES: &[Case] = &[
    Case {
        name: "units of radiance",
        varied: "the whole scene × 2ᵏ, k = −20 … 20, with noise, a firefly and a lamp that goes out",
        quantity: "largest relative difference from the unscaled image × 2ᵏ, or difference of λ",
        bound: 0.0,
        origin: "all formulas are homogeneous; powers of two round nothing",
        measure: units,
        breaks: Breaks::Found(units_break),
    },
    Case {
        name: "sixteen decades in one image",
        varied: "radiance 10⁻⁸ … 10⁸ from left to right",
        quantity: "largest relative error",
        bound: ROUNDING,
        origin: "nothing varies in time, so nothing may be mixed; the taps of the filter are rounded",
        measure: decades,
        breaks: Breaks::Found(decades_break),
    },
    Case {
        name: "a sun beside walls",
        varied: "sun 10⁰ … 10⁸ with noise of ±10 %, wall 10⁻³ with noise of ±100 %, on one plane",
        quantity: "largest relative error of the wall's mean over frames 8 … 40",
        bound: 0.03,
        origin: "three standard errors of 13 500 samples of uniform noise are 1.5 %; as much again for bias",
        measure: sun,
        breaks: Breaks::Found(sun_break),
    },
    Case {
        name: "bright and noisy",
        varied: "radiance 1, 300 (its square is above f16's largest number), 10⁴, 10⁵, 10⁶, 10⁸ with noise",
        quantity: "largest relative bias of the mean over 32 frames",
        bound: 0.01,
        origin: "the comparison is with the same samples, so only bias is left",
        measure: bright,
        breaks: Breaks::Known("from 2³³ ≈ 8.6·10⁹ (before the albedo) on the taps of the spatial filter are full"),
    },
    Case {
        name: "black and nearly so",
        varied: "radiance 0, 10⁻⁴⁵ (denormal), 10⁻⁴⁰, 10⁻³⁸, 10⁻³⁰, 10⁻²⁰",
        quantity: "largest output over input, less 1; or λ",
        bound: ROUNDING,
        origin: "radiance that is too dark to be stored becomes 0, and is no change",
        measure: dark,
        breaks: Breaks::Known("below 2⁻³¹ ≈ 5·10⁻¹⁰ (before the albedo) the taps of the spatial filter are 0"),
    },
    Case {
        name: "one lit pixel",
        varied: "one pixel of 1, 10³, 10⁶, steady, in the dark; its place",
        quantity: "largest relative error of the sum over all pixels",
        bound: ROUNDING,
        origin: "the pixel does not vary, so it is signal and must stay",
        measure: one_pixel,
        breaks: Breaks::Never("the stops compare with the noise, and there is none"),
    },
    Case {
        name: "fireflies",
        varied: "10², 10³, 10⁴, 10⁵ at a probability of 10⁻³ on a wall of 1",
        quantity: "energy gained over 64 frames, against the same samples",
        bound: 0.01,
        origin: "a filter may take fireflies for signal or not, but may not add to them",
        measure: fireflies,
        breaks: Breaks::Found(fireflies_lost),
    },
    Case {
        name: "from next to nothing",
        varied: "a light that goes from 10⁻³⁰, 10⁻²⁵, 10⁻²⁰, 10⁻¹² to 1 and 10⁸ in one frame",
        quantity: "largest relative error of a pixel in that frame and the next three",
        bound: ROUNDING,
        origin: "the old history is worth nothing; the ratio's square would be infinite, and its variance ∞ − ∞",
        measure: next_to_nothing,
        breaks: Breaks::Never("beyond 10⁶ no ratio is computed"),
    },
    Case {
        name: "as bright as numbers go",
        varied: "10¹⁰ … 3.4·10³⁸ in one frame of a steady image: in one pixel, in a block, everywhere",
        quantity: "pixels of the image or the history that are not finite, in that frame or in the eight after",
        bound: 0.0,
        origin: "a history that is not finite would be so for ever",
        measure: huge,
        breaks: Breaks::Never(
            "10¹⁵ is the largest radiance that enters the filter; all squares and sums of it are finite",
        ),
    },
];

/// Returns a lamp with noise on a darker ground with noise and fireflies; the lamp is out from frame 8 on.
fn lively(path: &Path) -> f64 {
    let lamp = if path.pixel[0] < 12 && path.frame < 8 { 4.0 } else { 0.0 };
    let firefly = if path.uniform(1) < 0.01 { 50.0 } else { 0.0 };
    (0.25 + lamp + firefly) * path.noise()
}

/// Returns the images of ten frames, and λ of each.
fn lively_frames(scale: f64) -> Vec<[Vec<Rgb>; 2]> {
    let mut host = Painted::new(SIZE, adaptive());
    let light = move |path: &Path| [1.0, 0.7, 0.4].map(|c| (scale * c * lively(path)) as f32);
    (0..10).map(|_| [host.frame(&light), host.view(View::Lambda)]).collect()
}

/// Returns the largest relative difference from the scaled image, or the largest difference of λ.
fn unit_difference(reference: &[[Vec<Rgb>; 2]], k: i32) -> f64 {
    let scale = f64::from(k).exp2();
    let mut worst = 0.0_f64;
    for ([image, lambda], [expected, expected_lambda]) in lively_frames(scale).iter().zip(reference) {
        for (x, e) in image.iter().flatten().zip(expected.iter().flatten()) {
            worst = worst.max((f64::from(*x) / scale - f64::from(*e)).abs() / f64::from(*e));
        }
        for (x, e) in lambda.iter().flatten().zip(expected_lambda.iter().flatten()) {
            worst = worst.max(f64::from((x - e).abs()));
        }
    }
    worst
}

fn units() -> Worst {
    let reference = lively_frames(1.0);
    let mut worst = Worst::default();
    for k in [-20, -16, -10, -3, -1, 1, 4, 7, 12, 20] {
        worst.add(unit_difference(&reference, k), || format!("k = {k}"));
    }
    worst
}

fn units_break() -> String {
    let reference = lively_frames(1.0);
    let breaks = |step: i32| (1..).map(|n| n * step).find(|&k| k.abs() > 120 || unit_difference(&reference, k) > 0.0);
    let [down, up] = [-1, 1].map(|step| breaks(step).unwrap_or_default());
    format!("k = {down} and {up}, for radiances from 0.02 to 100")
}

/// Returns the largest relative error of steady columns of radiances from 10^-range to 10^range.
fn columns(range: f64) -> f64 {
    let light = |path: &Path| {
        let t = f64::from(path.pixel[0]) / f64::from(SIZE[0] - 1);
        10.0_f64.powf(range * (2.0 * t - 1.0))
    };
    let image = Painted::new(SIZE, adaptive()).frames(6, &|path| grey(light(path)));
    let mut worst = 0.0_f64;
    for (i, c) in image.iter().enumerate() {
        let expected = light(&Path { pixel: [i as u32 % SIZE[0], 0], seed: 0, frame: 0 });
        worst = c.iter().fold(worst, |w, x| w.max((f64::from(*x) / expected - 1.0).abs()));
    }
    worst
}

fn decades() -> Worst {
    let mut worst = Worst::default();
    for range in [1.0, 2.0, 4.0, 6.0, 8.0] {
        worst.add(columns(range), || format!("10^±{range}"));
    }
    worst
}

fn decades_break() -> String {
    let first = (16..60).map(|n| 0.5 * f64::from(n)).find(|&range| columns(range) > ROUNDING);
    first.map_or("none up to 10^±30".into(), |range| format!("10^±{range}"))
}

/// Returns the mean luminance of chosen pixels over frames: of the filtered image, and of its input samples.
fn means(frames: Range<u32>, light: &dyn Fn(&Path) -> f64, among: impl Fn(usize) -> bool) -> [f64; 2] {
    let mut host = Painted::new(SIZE, adaptive());
    let mut sums = [0.0; 2];
    let chosen = |image: &[Rgb]| {
        let some: Vec<Rgb> = image.iter().enumerate().filter(|(i, _)| among(*i)).map(|(_, c)| *c).collect();
        mean(&some)
    };
    for frame in 0..frames.end {
        let views = host.views(&|path| grey(light(path)));
        let image = host.denoise(&views);
        if frames.contains(&frame) {
            sums[0] += chosen(&image);
            sums[1] += chosen(&views.radiance);
        }
    }
    sums.map(|s| s / frames.len() as f64)
}

/// Returns the relative error of the mean, from a frame on, of a wall of 10⁻³ beside a sun with this noise.
fn beside_the_sun(sun: f64, noise: f64, from: u32) -> f64 {
    let light = move |path: &Path| {
        if path.pixel[0] < 8 { sun * (1.0 + noise * (path.noise() - 1.0)) } else { 1e-3 * path.noise() }
    };
    let [found, _] = means(from..40, &light, |i| i as u32 % SIZE[0] >= 8);
    (found / 1e-3 - 1.0).abs()
}

fn sun() -> Worst {
    let mut worst = Worst::default();
    for power in [0, 2, 4, 6, 8] {
        worst.add(beside_the_sun(10.0_f64.powi(power), 0.1, 8), || format!("sun 10^{power}"));
    }
    worst
}

fn sun_break() -> String {
    let cold = beside_the_sun(1e6, 0.1, 0);
    let first = (2..=10).map(|n| 0.1 * f64::from(n)).find(|&noise| beside_the_sun(1e6, noise, 8) > 0.03);
    let noise = first.map_or("none up to ±100 %".into(), |noise| format!("±{:.0} %", 100.0 * noise));
    format!(
        "noise of a sun of 10⁶: {noise}, because a noisy tap may be mixed in for some ten frames. From the first frame on, the error is \
         {cold:.1e}, because the variances of the first three frames are those of 7×7 neighbours, among them the sun"
    )
}

fn bright() -> Worst {
    let mut worst = Worst::default();
    for level in [1.0, 300.0, 1e4, 1e5, 1e6, 1e8] {
        let [found, given] = means(0..32, &|path| level * path.noise(), |_| true);
        worst.add((found / given - 1.0).abs(), || format!("radiance {level}"));
    }
    worst
}

fn dark() -> Worst {
    let mut worst = Worst::default();
    for level in [0.0, 1e-45, 1e-40, 1e-38, 1e-30, 1e-20] {
        let mut host = Painted::new(SIZE, adaptive());
        let image = host.frames(8, &|path| grey(if path.uniform(0) < 0.5 { level } else { 0.0 }));
        let largest = image.iter().flatten().fold(0.0, |m, x| f64::max(m, f64::from(*x)));
        let above = if level > 0.0 { (largest / level - 1.0).max(0.0) } else { largest };
        worst.add(above.max(host.largest(View::Lambda)), || format!("radiance {level:e}"));
    }
    worst
}

fn one_pixel() -> Worst {
    let mut worst = Worst::default();
    for level in [1.0, 1e3, 1e6] {
        for place in [[0, 0], [11, 7], [23, 17]] {
            let light = |path: &Path| grey(if path.pixel == place { level } else { 0.0 });
            let image = Painted::new(SIZE, adaptive()).frames(12, &light);
            let sum: f64 = image.iter().map(|&c| luminance(c)).sum();
            worst.add((sum / level - 1.0).abs(), || format!("{level} at {place:?}"));
        }
    }
    worst
}

/// Returns the mean of a wall of 1 with fireflies, and of its input samples.
fn with_fireflies(power: i32) -> [f64; 2] {
    let firefly = 10.0_f64.powi(power);
    let light = move |path: &Path| path.noise() + if path.uniform(1) < 1e-3 { firefly } else { 0.0 };
    means(0..64, &light, |_| true)
}

fn fireflies() -> Worst {
    let mut worst = Worst::default();
    for power in 2..=5 {
        let [found, given] = with_fireflies(power);
        worst.add((found / given - 1.0).max(0.0), || format!("10^{power}"));
    }
    worst
}

fn fireflies_lost() -> String {
    let lost = |power: i32| {
        let [found, given] = with_fireflies(power);
        format!("{:.0} % at 10^{power}", 100.0 * (1.0 - found / given))
    };
    format!("lost energy: {}", (2..=5).map(lost).collect::<Vec<_>>().join(", "))
}

fn next_to_nothing() -> Worst {
    let mut worst = Worst::default();
    for before in [1e-30, 1e-25, 1e-20, 1e-12] {
        for after in [1.0, 1e8] {
            let mut host = Painted::new(SIZE, adaptive());
            let light = |path: &Path| grey(if path.frame < 6 { before } else { after });
            host.frames(6, &light);
            for _ in 0..4 {
                let image = host.frame(&light);
                let away = image.iter().flatten().map(|x| (f64::from(*x) / after - 1.0).abs());
                let value = away.fold(0.0, |w, d| if d.is_nan() { f64::INFINITY } else { f64::max(w, d) });
                worst.add(value, || format!("from {before:e} to {after:e}"));
            }
        }
    }
    worst
}

fn huge() -> Worst {
    let mut worst = Worst::default();
    type Hit = fn([u32; 2]) -> bool;
    let places: [Named<Hit>; 3] =
        [("a pixel", |p| p == [5, 5]), ("a block", |p| p[0] < 9 && p[1] < 9), ("everywhere", |_| true)];
    for level in [1e10, 1e15, 1e19, 1e30, 3.4e38] {
        for (name, hit) in places {
            let mut host = Painted::new(SIZE, adaptive());
            let light = |path: &Path| grey(if path.frame == 4 && hit(path.pixel) { level } else { 1.0 });
            let broken: usize = (0..12).map(|_| unusable(&host.frame(&light))).sum();
            let kept = host.largest(View::Variance).max(host.largest(View::HistoryLength));
            worst.add(if kept.is_finite() { broken as f64 } else { kept }, || format!("{level:e} in {name}"));
        }
    }
    worst
}
