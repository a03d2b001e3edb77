//! Light that changes fast, slowly, and both at once. tests/gpu/behaviour/change.rs tests the response to a blinking
//! lamp in traced scenes.

use super::painted::{Painted, Path, adaptive, grey};
use super::{Breaks, Case, Worst};
use crate::stability::common::statistics::mean;
use asvgf::{FilterSettings, Settings};

const SIZE: [u32; 2] = [24, 18];

/// Three standard errors of the mean of one frame's 432 samples, each with a deviation of 1/√3, halved by the least
/// smoothing.
const NOISE: f64 = 3.0 * 0.577 / 20.8;

pub const CASES: &[Case] = &[
    Case {
        name: "strobing within the ratio's range",
        varied: "a light that alternates between 1 and ⅓ every 1, 2, 3, 7 frames; noise",
        quantity: "largest relative error of the image's mean in frames 32 … 60",
        bound: NOISE + 0.13,
        origin: "three standard errors of one frame's samples, and a prior of 5 % that turns a ratio of ⅓ into 0.365: 9.5 % a step, of which five frames' samples leave 13 % in all",
        measure: strobing_dim,
        breaks: Breaks::Known("beyond ¼ … 4 the history is dropped instead of rescaled: the row below"),
    },
    Case {
        name: "strobing on and off",
        varied: "a light that alternates between 1 and 0 or 10⁻³ every 1, 2, 3, 7 frames; noise",
        quantity: "largest error of the image's mean in frames 32 … 60, over the light",
        bound: NOISE,
        origin: "three standard errors of one frame's samples: no ghost",
        measure: strobing_off,
        breaks: Breaks::Never("λ is a ratio, so the levels do not matter"),
    },
    Case {
        name: "a step under a drift",
        varied: "+0.1 % and −0.1 % a frame, and in frame 40 × ½, × 2, × ¹⁄₂₀, × 20; noise",
        quantity: "largest relative error of the image's mean in frames 32 … 80",
        bound: NOISE + 0.064,
        origin: "three standard errors of one frame's samples, and a drift that stays unnoticed for 64 frames",
        measure: drift,
        breaks: Breaks::Known("a drift of more than 1/64 a frame needs the gradient to see it"),
    },
    Case {
        name: "lag of a constant α",
        varied: "α 0.5, 0.2, 0.1, 0.05; a light that grows by 0.01 a frame, no noise",
        quantity: "largest relative difference of the lag from (1/α − 1) · 0.01",
        bound: 0.02,
        origin: "the lag of an exponential average behind a ramp; rounding of the taps, 2⁻¹² of the level",
        measure: ramp_constant,
        breaks: Breaks::Never("linear in the slope"),
    },
    Case {
        name: "lag of the adaptive α",
        varied: "a light that goes from 1 to 5 in 1000, 100, 10 frames, no noise",
        quantity: "largest relative lag behind it",
        bound: 0.077,
        origin: "a prior of 5 % leaves 0.05/1.05 of each step: 0.048 · ln 5 if no sample ever corrects it",
        measure: ramp_adaptive,
        breaks: Breaks::Known("a frame that multiplies by more than 4 drops the history"),
    },
    Case {
        name: "a dim light goes out beside a steady one, 20 × as bright",
        varied: "half of the paths see either; the dim one goes out in frame 20",
        quantity: "remaining part of the dim light in frames 24 … 40, against the same run without it",
        bound: 0.6,
        origin: "a plain average would still hold 20/28 on average",
        measure: beside_a_bright_one,
        breaks: Breaks::Known("in frame 20 itself the change is within the noise of its pairs"),
    },
    Case {
        name: "a light that few samples see goes out",
        varied: "seen by 50 %, 10 %, 2 % of the paths, its mean the same; it goes out in frame 20",
        quantity: "remaining part of the light in frames 24 … 40",
        bound: 0.1,
        origin: "a plain average would still hold 20/28 on average, and the history length is multiplied by (1 − λ)^3.5",
        measure: few_samples,
        breaks: Breaks::Found(few_samples_break),
    },
    Case {
        name: "jumps of exposure",
        varied: "× 2⁻¹⁰ … 2¹⁰ in one frame, all of the image; noise",
        quantity: "largest relative error of the image's mean in the four frames from then on",
        bound: NOISE + 0.143,
        origin: "three standard errors of one frame's samples, and a prior of 5 % that turns a ratio of ¼ into 0.286",
        measure: exposure,
        breaks: Breaks::Never("λ is a ratio, so the levels do not matter"),
    },
    Case {
        name: "frame rates",
        varied: "a light that moves over the wall in 240, 60, 15, 4 frames; noise",
        quantity: "largest relative error of the image's mean from frame 16 on",
        bound: NOISE + 0.04,
        origin: "the filter depends on changes since the last frame, not on time; three standard errors of one frame's samples, and bias",
        measure: frame_rates,
        breaks: Breaks::Never("there is no time in the filter"),
    },
];

/// Returns the largest of |mean of the image − level| / scale over frames.
fn largest_error(frames: std::ops::Range<u32>, level: &dyn Fn(u32) -> f64, scale: &dyn Fn(u32) -> f64) -> f64 {
    let mut host = Painted::new(SIZE, adaptive());
    let mut worst = 0.0_f64;
    for frame in 0..frames.end {
        let image = host.frame(&|path| grey(level(path.frame) * path.noise()));
        if frames.contains(&frame) {
            worst = worst.max((mean(&image) - level(frame)).abs() / scale(frame));
        }
    }
    worst
}

/// Returns the level, of two, of a light that changes every `period` frames.
fn strobe(frame: u32, period: u32, levels: [f64; 2]) -> f64 {
    levels[(frame / period % 2) as usize]
}

fn strobing_dim() -> Worst {
    let mut worst = Worst::default();
    for period in [1, 2, 3, 7] {
        let level = |frame| strobe(frame, period, [1.0, 1.0 / 3.0]);
        worst.add(largest_error(32..60, &level, &level), || format!("every {period}"));
    }
    worst
}

fn strobing_off() -> Worst {
    let mut worst = Worst::default();
    for off in [0.0, 1e-3] {
        for period in [1, 2, 3, 7] {
            let level = |frame| strobe(frame, period, [1.0, off]);
            worst.add(largest_error(32..60, &level, &|_| 1.0), || format!("{off} every {period}"));
        }
    }
    worst
}

fn drift() -> Worst {
    let mut worst = Worst::default();
    for slope in [1.001_f64, 0.999] {
        for step in [0.5, 2.0, 0.05, 20.0] {
            let level = |frame: u32| slope.powi(frame as i32) * if frame >= 40 { step } else { 1.0 };
            worst.add(largest_error(32..80, &level, &level), || format!("× {slope} a frame, × {step}"));
        }
    }
    worst
}

fn ramp_constant() -> Worst {
    let mut worst = Worst::default();
    for alpha in [0.5, 0.2, 0.1, 0.05_f32] {
        let mut host = Painted::new([6, 6], Settings::adaptive().constant(alpha));
        let level = |frame: u32| 1.0 + 0.01 * f64::from(frame);
        let frames = (12.0 / alpha) as u32;
        let image = host.frames(frames, &|path| grey(level(path.frame)));
        let lag = level(frames - 1) - mean(&image);
        let expected = (1.0 / f64::from(alpha) - 1.0) * 0.01;
        // The rounding of the taps is no lag.
        let rounding = level(frames) / 4096.0;
        worst.add(((lag - expected).abs() - rounding).max(0.0) / expected, || format!("α = {alpha}: {lag:.5}"));
    }
    worst
}

fn ramp_adaptive() -> Worst {
    let mut worst = Worst::default();
    for frames in [1000, 100, 10_u32] {
        let mut host = Painted::new([9, 9], adaptive());
        let level = |frame: u32| 1.0 + 4.0 * (f64::from(frame) / f64::from(frames)).min(1.0);
        for frame in 0..(frames + 10).min(300) {
            let image = host.frame(&|path| grey(level(path.frame)));
            worst.add((mean(&image) / level(frame) - 1.0).abs(), || format!("{frames} frames, frame {frame}"));
        }
    }
    worst
}

/// Returns the mean of the image over frames 24 … 40 of a light.
fn later(light: &dyn Fn(&Path) -> f64) -> f64 {
    let mut host = Painted::new([36, 27], adaptive());
    (0..40)
        .map(|frame| (frame, mean(&host.frame(&|path| grey(light(path))))))
        .filter(|(f, _)| *f >= 24)
        .map(|(_, m)| m)
        .sum::<f64>()
        / 16.0
}

fn beside_a_bright_one() -> Worst {
    let mut worst = Worst::default();
    for until in [20, 0] {
        // Half of the paths see each light, with twice its radiance.
        let light = |path: &Path| match path.uniform(1) < 0.5 {
            true => 40.0 * path.noise(),
            false if path.frame < until => 2.0 * path.noise(),
            false => 0.0,
        };
        let without = |path: &Path| if path.uniform(1) < 0.5 { 40.0 * path.noise() } else { 0.0 };
        worst.add((later(&light) - later(&without)).abs(), || format!("until frame {until}"));
    }
    worst
}

/// Returns the remaining part of a light that this part of the paths sees.
fn left_of(part: f64) -> f64 {
    let light = |path: &Path| {
        let seen = path.frame < 20 && path.uniform(1) < part;
        0.01 * path.noise() + if seen { path.noise() / part } else { 0.0 }
    };
    (later(&light) - 0.01).abs()
}

fn few_samples() -> Worst {
    let mut worst = Worst::default();
    for part in [0.5, 0.1, 0.02] {
        worst.add(left_of(part), || format!("{} % of the paths", 100.0 * part));
    }
    worst
}

fn few_samples_break() -> String {
    let parts = [0.01, 0.005, 0.002, 0.001, 0.0005];
    let first = parts.into_iter().find(|&part| left_of(part) > 0.1);
    first.map_or("none down to 0.05 % of the paths".into(), |part| format!("{} % of the paths", 100.0 * part))
}

fn exposure() -> Worst {
    let mut worst = Worst::default();
    for k in [-10, -4, -2, -1, 1, 2, 4, 10] {
        let level = |frame: u32| if frame >= 24 { f64::from(k).exp2() } else { 1.0 };
        worst.add(largest_error(24..28, &level, &level), || format!("2^{k}"));
    }
    worst
}

fn frame_rates() -> Worst {
    let mut worst = Worst::default();
    for frames in [240, 60, 15, 4] {
        let mut host = Painted::new(SIZE, adaptive());
        // A soft spot moves back and forth.
        let spot = |pixel: [u32; 2], frame: u32| {
            let t = (f64::from(frame) / f64::from(frames)).fract();
            let x = 24.0 * (2.0 * t - 1.0).abs();
            0.2 + (-((f64::from(pixel[0]) + 0.5 - x) / 5.0).powi(2)).exp()
        };
        for frame in 0..80_u32 {
            let image = host.frame(&|path| grey(spot(path.pixel, path.frame) * path.noise()));
            if frame >= 16 {
                let truth = (0..24).map(|x| spot([x, 0], frame)).sum::<f64>() / 24.0;
                worst.add((mean(&image) / truth - 1.0).abs(), || format!("{frames} frames, frame {frame}"));
            }
        }
    }
    worst
}

/// Returns settings with another longest history, for the long runs.
pub fn plain(max_history: f32) -> Settings {
    let filter = FilterSettings { max_history, ..Settings::adaptive().constant(0.0).filter };
    Settings { filter, ..Settings::adaptive() }
}
