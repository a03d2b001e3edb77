//! Samples that are missing, infinite, or the same in every frame, and averages without end.

use super::painted::{Painted, Path, adaptive, grey};
use super::{Breaks, Case, Named, Worst};
use crate::stability::common::statistics::{Rgb, mean, relative_mse};
use asvgf::{FilterSettings, Gradient, Settings};

const SIZE: [u32; 2] = [48, 32];

pub const CASES: &[Case] = &[
    Case {
        name: "a tenth of the radiance is NaN",
        varied: "at random; adaptive and constant α, published formulas; after 12 frames",
        quantity: "largest relative error of the mean",
        bound: 0.02,
        origin: "NaN is no sample; counted as black, it would take a tenth of the light away",
        measure: tenth,
        breaks: Breaks::Never("a pixel without a sample keeps its history, or is filled from its neighbours"),
    },
    Case {
        name: "a hundredth of the radiance is infinite",
        varied: "at random; adaptive and constant α, published formulas; frames 8 to 15",
        quantity: "largest relative error of the mean",
        bound: 0.02,
        origin: "infinite radiance enters no average, and is shown only where there is no history",
        measure: hundredth,
        breaks: Breaks::Never("a pixel with a history goes on with half of it"),
    },
    Case {
        name: "a block of radiance that is NaN in every frame",
        varied: "1×1 to 24×24 pixels, in the middle and in a corner",
        quantity: "largest difference of a pixel of the block from the wall, relative",
        bound: 0.25,
        origin: "the noise that the filter leaves of a mean over six pixels",
        measure: block,
        breaks: Breaks::Known("pixels farther inside than 27 pixels find no sample and are black"),
    },
    Case {
        name: "infinite radiance beside a wall",
        varied: "as radiance of the sky; as radiance and emission; as radiance of the wall; of the wall from frame 16 on",
        quantity: "relative difference of the infinite pixels from 65504, and of the wall from its own radiance",
        bound: 0.02,
        origin: "65504 is the largest 16-bit float; the wall has its noise after 32 frames",
        measure: sun,
        breaks: Breaks::Never("an infinite channel becomes 65504 wherever it comes from"),
    },
    Case {
        name: "the same noise in every frame",
        varied: "adaptive and constant α of 0.1, 0.2, 0.5; 24 frames",
        quantity: "largest error of a later frame over the first's (relMSE)",
        bound: 1.5,
        origin: "any number of frames has one sample, so a later frame is no better than the first, and must be hardly worse",
        measure: repeated,
        breaks: Breaks::Known("where the camera moves, each pixel's history sees other noise, as it should"),
    },
    Case {
        name: "light that few paths find, without pairs",
        varied: "one path in 2, 5, 10, 20, 50; still; frames 8 to 39",
        quantity: "largest relative difference of the mean from that of the samples",
        bound: 0.09,
        origin: "a rare bright path is no change of light; with a constant α, the spatial filter loses 7 % of the light that one in 50 finds",
        measure: sparse,
        breaks: Breaks::Known(
            "where fewer than one path in a hundred finds light, the spatial filter takes it for noise",
        ),
    },
    Case {
        name: "a step of the light, without pairs",
        varied: "noise; × 1.5, 4, 30, 1000 and their inverses in frame 12",
        quantity: "largest relative error of the mean in frames 13 to 16",
        bound: 0.12,
        origin: "three standard errors of 1536 samples of uniform noise are 5 %; as much again for bias",
        measure: step,
        breaks: Breaks::Known(
            "a change that is smaller than the noise of some hundred samples is followed a few frames late",
        ),
    },
    Case {
        name: "80 frames of a constant α",
        varied: "α = 0.05, 0.1, 0.2, 0.5, 1",
        quantity: "error (relMSE) of the last 8 frames over that of frames 8 to 15",
        bound: 2.0,
        origin: "an average of constant weights is worth (2 − α)/α samples, and the filter knows it; the noise of 8 frames comes on top",
        measure: endless,
        breaks: Breaks::Never("the history length counts what the average is worth, not its frames"),
    },
];

fn noisy(path: &Path) -> Rgb {
    grey(path.noise())
}

fn settings() -> [Named<Settings>; 3] {
    let classic = Settings::classic();
    [
        ("adaptive", adaptive()),
        ("constant α", Settings::adaptive().constant(0.2)),
        ("classic, constant α", classic.constant(0.2)),
    ]
}

fn tenth() -> Worst {
    mean_with(0.1, f32::NAN, 0..12)
}

fn hundredth() -> Worst {
    mean_with(0.01, f32::INFINITY, 8..16)
}

/// Returns the error of the mean over frames if a part of the samples is not finite.
fn mean_with(part: f64, value: f32, frames: std::ops::Range<usize>) -> Worst {
    let mut worst = Worst::default();
    for (name, settings) in settings() {
        let mut host = Painted::new(SIZE, settings);
        let spoilt = |path: &Path| if path.uniform(7) < part { [value; 3] } else { noisy(path) };
        let images: Vec<Vec<Rgb>> = (0..frames.end).map(|_| host.frame(&spoilt)).collect();
        worst.add((mean(&images[frames.clone()].concat()) - 1.0).abs(), || name.into());
    }
    worst
}

fn block() -> Worst {
    let mut worst = Worst::default();
    for (name, settings) in settings() {
        for (side, [left, top]) in [(1, [20, 10]), (8, [20, 10]), (24, [12, 4]), (24, [0, 0])] {
            let within = |[x, y]: [u32; 2]| (left..left + side).contains(&x) && (top..top + side).contains(&y);
            let mut host = Painted::new(SIZE, settings.clone());
            let image = host.frames(8, &|path| if within(path.pixel) { [f32::NAN; 3] } else { noisy(path) });
            for (i, pixel) in image.iter().enumerate() {
                if within([i as u32 % SIZE[0], i as u32 / SIZE[0]]) {
                    worst.add(f64::from((pixel[0] - 1.0).abs()), || format!("{name}, {side}×{side} at {left}, {top}"));
                }
            }
        }
    }
    worst
}

fn sun() -> Worst {
    let mut worst = Worst::default();
    for (name, from) in [("sky", 0), ("emitter", 0), ("part of the wall", 0), ("part of the wall that lights up", 16)] {
        let mut host = Painted::new(SIZE, adaptive());
        let is_sun =
            |i: usize| (10..14).contains(&(i % SIZE[0] as usize)) && (10..14).contains(&(i / SIZE[0] as usize));
        let mut image = Vec::new();
        for frame in 0..32 {
            let mut views = host.views(&noisy);
            for i in (0..views.radiance.len()).filter(|&i| is_sun(i) && frame >= from) {
                views.radiance[i] = [f32::INFINITY; 3];
                views.pairs.iter_mut().for_each(|pair| pair[i] = [-1.0; 3]);
                match name {
                    "emitter" => views.emission[i] = [f32::INFINITY; 3],
                    "sky" => views.depth[i] = [0.0],
                    _ => {}
                }
            }
            image = host.denoise(&views);
        }
        let wall: Vec<Rgb> = (0..image.len()).filter(|&i| !is_sun(i)).map(|i| image[i]).collect();
        let shown: Vec<Rgb> = (0..image.len()).filter(|&i| is_sun(i)).map(|i| image[i]).collect();
        worst.add((mean(&wall) - 1.0).abs(), || format!("wall beside a {name}"));
        worst.add((mean(&shown) / 65504.0 - 1.0).abs(), || name.into());
    }
    worst
}

fn repeated() -> Worst {
    let mut worst = Worst::default();
    let constant = [0.1, 0.2, 0.5].map(|alpha| Settings::adaptive().constant(alpha));
    let truth = vec![[1.0; 3]; (SIZE[0] * SIZE[1]) as usize];
    for settings in [adaptive(), pairless()].into_iter().chain(constant) {
        let adapts = settings.filter.gradient != Gradient::Off;
        let mut host = Painted::new(SIZE, settings.clone());
        // Exponential noise, as from paths that rarely find a light.
        let fixed = |path: &Path| grey(-(1.0 - Path { seed: 3, ..*path }.uniform(0)).ln());
        let errors: Vec<f64> = (0..24).map(|_| relative_mse(&host.frame(&fixed), &truth)).collect();
        for (frame, error) in errors.iter().enumerate().skip(1) {
            worst.add(error / errors[0], || format!("frame {frame}, adapts: {adapts}, α {}", settings.filter.alpha));
        }
    }
    worst
}

/// Returns the default filter of a host that hands in no pairs.
fn pairless() -> Settings {
    let filter = FilterSettings { gradient: Gradient::Statistics, ..Default::default() };
    Settings { filter, ..Settings::adaptive() }
}

fn sparse() -> Worst {
    let mut worst = Worst::default();
    for rarity in [2.0, 5.0, 10.0, 20.0, 50.0] {
        let light = move |path: &Path| if path.uniform(1) * rarity < 1.0 { rarity } else { 0.0 };
        let mut host = Painted::new(SIZE, pairless());
        let mut sums = [0.0; 2];
        for frame in 0..40 {
            let views = host.views(&|path| grey(light(path)));
            let image = host.denoise(&views);
            if frame >= 8 {
                sums[0] += mean(&image);
                sums[1] += mean(&views.radiance);
            }
        }
        worst.add((sums[0] / sums[1] - 1.0).abs(), || format!("one in {rarity}"));
    }
    worst
}

fn step() -> Worst {
    let mut worst = Worst::default();
    for factor in [1.5, 4.0, 30.0, 1000.0_f64].into_iter().flat_map(|f| [f, 1.0 / f]) {
        let level = move |frame: u32| if frame < 12 { 1.0 } else { factor };
        let mut host = Painted::new(SIZE, pairless());
        for frame in 0..17 {
            let image = host.frame(&|path| grey(level(path.frame) * path.noise()));
            if frame > 12 {
                worst.add((mean(&image) / level(frame) - 1.0).abs(), || format!("× {factor:.4}, frame {frame}"));
            }
        }
    }
    worst
}

fn endless() -> Worst {
    let mut worst = Worst::default();
    let truth = vec![[1.0; 3]; (SIZE[0] * SIZE[1]) as usize];
    for alpha in [0.05, 0.1, 0.2, 0.5, 1.0] {
        let mut host = Painted::new(SIZE, Settings::adaptive().constant(alpha));
        let errors: Vec<f64> = (0..80).map(|_| relative_mse(&host.frame(&noisy), &truth)).collect();
        let mean = |errors: &[f64]| errors.iter().sum::<f64>() / errors.len() as f64;
        worst.add(mean(&errors[72..]) / mean(&errors[8..16]), || format!("α = {alpha}"));
    }
    worst
}
