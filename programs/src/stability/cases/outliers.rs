//! Samples far brighter than any light can be, and light far brighter than its surroundings.

use super::painted::{Painted, Path, Views, adaptive, grey};
use super::{Breaks, Case, Named, Worst};
use crate::stability::common::statistics::{Rgb, mean};
use asvgf::{FilterSettings, Gradient, Settings};

pub(super) const SIZE: [u32; 2] = [96, 72];

pub const CASES: &[Case] = &[
    Case {
        name: "outliers of every rate",
        varied: "one sample in 10⁵, 10⁴, 10³, 300; 100, 10⁴, 10⁶, 10¹⁰, 10¹⁵ times the light; with and without pairs; frames 0 to 15",
        quantity: "largest relative difference of a frame's mean from that of a clean run",
        bound: 0.02,
        origin: "a sample that is not believed only makes one sample fewer",
        measure: rates,
        breaks: Breaks::Known("one outlier in 100 samples adds 10 %; with one in 10, nothing tells what the light is"),
    },
    Case {
        name: "a burst of outliers",
        varied: "12 pixels of 6·10⁴, 10⁹, 3.4·10³⁸, −5, NaN, ∞ in each of eight frames, in radiance, or in all views of light",
        quantity: "largest relative difference of a tile of 12×12 pixels from a clean run, three frames later",
        bound: 0.02,
        origin: "a pixel whose sample is not believed has one sample fewer than in the clean run, and noise of its own",
        measure: bursts,
        breaks: Breaks::Never("no sample adds more than 40 times its level to a mean"),
    },
    Case {
        name: "a steady highlight of one pixel",
        varied: "30, 100, 1000, 10⁶ times the light around, from the first frame on and from frame 12 on; pairs",
        quantity: "missing or excess part of its light, eight frames after it appeared",
        bound: 0.02,
        origin: "a sample that is seen three times running is light",
        measure: highlights,
        breaks: Breaks::Known(
            "a highlight of 10 times the light is within its noise, and filtered with it; a highlight that blinks from frame to frame is never seen three times running",
        ),
    },
    Case {
        name: "a spot that lights up",
        varied: "2×2, 3×3, 5×5 pixels; 100, 1000, 10⁵ times the light around, with its noise; with and without pairs",
        quantity: "missing or excess part of the image's light, against a run that believes every sample, 10 to 17 frames later",
        bound: 0.2,
        origin: "the spot is believed after three frames, or after six if it could be a burst; 2×2 pixels have noise of 10 % by then, and each run has its own",
        measure: spots,
        breaks: Breaks::Known("a spot that stays for less than six frames may not be shown"),
    },
    Case {
        name: "an albedo that is noise, and the light with it",
        varied: "albedo 0 … 1, 0 … 10, and 0 … 10 with a fifth of zeros, like that of a metal that follows reflections; with and without pairs; frames 8 to 23",
        quantity: "largest relative difference of the mean from that of the samples",
        bound: 0.05,
        origin: "the albedo is kept within 0.02 … 1; a pixel whose albedo is 0 by chance has no sample",
        measure: albedos,
        breaks: Breaks::Known(
            "the picture is as noisy as its albedo; an albedo with noise of its own makes it up to 2.5 times too bright",
        ),
    },
];

fn settings() -> [Named<Settings>; 2] {
    let statistics = FilterSettings { gradient: Gradient::Statistics, ..Default::default() };
    [("pairs", adaptive()), ("no pairs", Settings { filter: statistics, ..Settings::adaptive() })]
}

pub(super) fn noisy(path: &Path) -> Rgb {
    grey(path.noise())
}

/// Returns rates and brightnesses, except for products that could be a plausible part of the light.
fn product() -> impl Iterator<Item = (f64, f64)> {
    let all = [1e-5, 1e-4, 1e-3, 1.0 / 300.0]
        .into_iter()
        .flat_map(|rate| [1e2, 1e4, 1e6, 1e10, 1e15].map(|times| (rate, times)));
    all.filter(|(rate, times)| !(0.05..1.2).contains(&(rate * times)))
}

fn rates() -> Worst {
    let mut worst = Worst::default();
    for (name, settings) in settings() {
        let mut clean = Painted::new(SIZE, settings.clone());
        let truth: Vec<f64> = (0..16).map(|_| mean(&clean.frame(&noisy))).collect();
        for (rate, times) in product() {
            let mut host = Painted::new(SIZE, settings.clone());
            let light = |path: &Path| if path.uniform(5) < rate { grey(times) } else { noisy(path) };
            for (frame, truth) in truth.iter().enumerate() {
                let found = mean(&host.frame(&light)) / truth - 1.0;
                worst.add(found.abs(), || format!("{rate:.0e} of {times:e}, frame {frame}, {name}"));
            }
        }
    }
    worst
}

/// Returns means over tiles of 12×12 pixels.
pub(super) fn tiles(image: &[Rgb]) -> Vec<f64> {
    let [width, height] = SIZE.map(|s| s as usize);
    let tile = |x: usize, y: usize| {
        let of: Vec<Rgb> = (0..144).map(|i| image[(y + i / 12) * width + x + i % 12]).collect();
        mean(&of)
    };
    (0..height).step_by(12).flat_map(|y| (0..width).step_by(12).map(move |x| (x, y))).map(|(x, y)| tile(x, y)).collect()
}

fn bursts() -> Worst {
    let mut worst = Worst::default();
    for (name, settings) in settings() {
        let run = |spoil: &dyn Fn(&mut Views, u32)| {
            let mut host = Painted::new(SIZE, settings.clone());
            let mut image = Vec::new();
            for frame in 0..15 {
                let mut views = host.views(&noisy);
                spoil(&mut views, frame);
                image = host.denoise(&views);
            }
            tiles(&image)
        };
        let truth = run(&|_, _| {});
        for value in [6e4, 1e9, f32::MAX, -5.0, f32::NAN, f32::INFINITY] {
            for everywhere in [false, true] {
                let found = run(&|views, frame| {
                    if !(4..12).contains(&frame) {
                        return;
                    }
                    for k in 0..12 {
                        let path = Path { pixel: [k, 0], seed: frame, frame };
                        let i = (path.uniform(3) * views.radiance.len() as f64) as usize;
                        views.radiance[i] = [value; 3];
                        if everywhere {
                            views.albedo[i] = [value; 3];
                            views.emission[i] = [value; 3];
                            views.pairs.iter_mut().for_each(|pair| pair[i] = [value; 3]);
                        }
                    }
                });
                for (found, truth) in found.iter().zip(&truth) {
                    worst.add((found / truth - 1.0).abs(), || format!("{value:e}, all views: {everywhere}, {name}"));
                }
            }
        }
    }
    worst
}

fn highlights() -> Worst {
    let mut worst = Worst::default();
    let place = [40, 31];
    for (times, from) in [30.0, 100.0, 1e3, 1e6].into_iter().flat_map(|t| [(t, 0), (t, 12)]) {
        let mut host = Painted::new(SIZE, adaptive());
        let lit = move |path: &Path| path.pixel == place && path.frame >= from;
        let light = |path: &Path| if lit(path) { grey(times) } else { noisy(path) };
        let image = host.frames(from + 9, &light);
        let shown = f64::from(image[(place[1] * SIZE[0] + place[0]) as usize][0]);
        worst.add((shown / times - 1.0).abs(), || format!("× {times:e}, from frame {from} on: {shown}"));
    }
    worst
}

fn spots() -> Worst {
    let mut worst = Worst::default();
    for (name, settings) in settings() {
        for (side, times) in [2, 3, 5].into_iter().flat_map(|side| [1e2, 1e3, 1e5].map(|times| (side, times))) {
            let [limited, believed] = [settings.filter.outlier_limit, 0.0].map(|outlier_limit| {
                let filter = FilterSettings { outlier_limit, ..settings.filter.clone() };
                let mut host = Painted::new(SIZE, Settings { filter, ..settings.clone() });
                let within = |[x, y]: [u32; 2]| (40..40 + side).contains(&x) && (31..31 + side).contains(&y);
                let light = |path: &Path| {
                    let lit = path.frame >= 8 && within(path.pixel);
                    grey(path.noise() * if lit { times } else { 1.0 })
                };
                let images: Vec<Vec<Rgb>> = (0..26).map(|_| host.frame(&light)).collect();
                mean(&images[18..].concat())
            });
            worst.add((limited / believed - 1.0).abs(), || format!("{side}×{side}, × {times:e}, {name}"));
        }
    }
    worst
}

fn albedos() -> Worst {
    let mut worst = Worst::default();
    for (name, settings) in settings() {
        for (kind, most, zeros) in [("0 … 1", 1.0, 0.0), ("0 … 10", 10.0, 0.0), ("0 … 10 and zeros", 10.0, 0.2)] {
            let mut host = Painted::new(SIZE, settings.clone());
            let mut sums = [0.0; 2];
            for frame in 0..24 {
                let mut views = host.views(&|path| grey(0.5 * path.noise()));
                for (i, albedo) in views.albedo.iter_mut().enumerate() {
                    let path = Path { pixel: [i as u32, 1], seed: frame, frame };
                    let a = if path.uniform(4) < zeros { 0.0 } else { most * path.uniform(6) };
                    *albedo = grey(a);
                    views.radiance[i] = views.radiance[i].map(|c| c * a as f32);
                }
                let image = host.denoise(&views);
                if frame >= 8 {
                    sums[0] += mean(&image);
                    sums[1] += mean(&views.radiance);
                }
            }
            worst.add((sums[0] / sums[1] - 1.0).abs(), || format!("{kind}, {name}"));
        }
    }
    worst
}
