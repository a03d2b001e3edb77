//! Views that no renderer should hand in. tests/gpu/host/cleaning.rs tests the counts and the guards too (pairs among
//! them), and src/twins/temporal.rs those for λ.

use super::painted::{Painted, Path, Views, adaptive, grey};
use super::{Breaks, Case, Named, Worst, difference, unusable};
use crate::stability::common::gpu::gpu;
use crate::stability::common::statistics::Rgb;
use asvgf::{InputCounts, View};
use std::time::Duration;

const SIZE: [u32; 2] = [24, 18];

pub const CASES: &[Case] = &[
    Case {
        name: "radiance, albedo, emission",
        varied: "NaN, −NaN, ±∞, −1, −10³⁰, 3.4·10³⁸; one pixel, a block, everywhere; in one frame, in each of four",
        quantity: "pixels of the image or the history that are not finite and ≥ 0, in that frame or later, and miscounts",
        bound: 0.0,
        origin: "no unusable number may enter the history; `take_counts` counts them",
        measure: light,
        breaks: Breaks::Never("exponent bits are tested, which no compiler may assume away"),
    },
    Case {
        name: "depth, normal, motion, previous depth",
        varied: "NaN, ±∞, 0, −1, 10⁻⁴², 10⁻³⁰, 10³⁰, 3.4·10³⁸; one pixel, a block, everywhere; in one frame, in each of four",
        quantity: "pixels of the image or the history that are not finite and ≥ 0, in that frame or later, and miscounts",
        bound: 0.0,
        origin: "such a surface is a miss, or new; `take_counts` counts them",
        measure: surfaces,
        breaks: Breaks::Never("a depth outside 10⁻¹⁸ … 10¹⁸ is a miss, so that its square is a normal number"),
    },
    Case {
        name: "views of specular light",
        varied: "NaN, −NaN, ±∞, −1, −5, −10³⁰, 10¹⁰, 3.4·10³⁸ in radiance, reflectance, roughness, distance, motion; one pixel, a block, everywhere; in one \
            frame, in each of four",
        quantity: "pixels of the image or a history that are not finite and ≥ 0, in that frame or later, and miscounts",
        bound: 0.0,
        origin: "no unusable number may enter the history; `take_counts` counts those of radiance and reflectance",
        measure: specular,
        breaks: Breaks::Never("exponent bits are tested, which no compiler may assume away"),
    },
    Case {
        name: "one clean frame later",
        varied: "NaN in 6×9 pixels of one frame, in each of these views",
        quantity: "largest difference from a clean run outside the filter's reach, and pixels within it that are not finite",
        bound: 0.0,
        origin: "a frame reaches 30 pixels by spatial taps and 13 strata by the gradient",
        measure: afterwards,
        breaks: Breaks::Never("no global reduction could carry it farther"),
    },
];

const KINDS: [f32; 7] = [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, -1e30, f32::MAX];
const SURFACE_KINDS: [f32; 9] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -1.0, 1e-42, 1e-30, 1e30, f32::MAX];

/// A view, and a function that spoils a pixel of it.
type Spoil = Named<fn(&mut Views, usize, f32)>;

const LIGHT: [Spoil; 3] = [
    ("radiance", |v, i, x| v.radiance[i][i % 3] = x),
    ("albedo", |v, i, x| v.albedo[i][i % 3] = x),
    ("emission", |v, i, x| v.emission[i][i % 3] = x),
];

const SURFACE: [Spoil; 4] = [
    ("depth", |v, i, x| v.depth[i][0] = x),
    ("normal", |v, i, x| v.normal[i] = [0.0, 0.0, x]),
    ("motion", |v, i, x| v.motion[i][i % 2] = x),
    ("previous depth", |v, i, x| v.previous_depth[i][0] = x),
];

const SPECULAR_KINDS: [f32; 9] =
    [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, -5.0, -1e30, 1e10, f32::MAX];

const SPECULAR: [Spoil; 5] = [
    ("specular radiance", |v, i, x| v.gloss.iter_mut().for_each(|gloss| gloss.radiance[i][i % 3] = x)),
    ("reflectance", |v, i, x| v.gloss.iter_mut().for_each(|gloss| gloss.reflectance[i][i % 3] = x)),
    ("roughness", |v, i, x| v.gloss.iter_mut().for_each(|gloss| gloss.roughness[i] = [x])),
    ("hit distance", |v, i, x| v.gloss.iter_mut().for_each(|gloss| gloss.hit_distance[i] = [x])),
    ("reflection's motion", |v, i, x| v.gloss.iter_mut().for_each(|gloss| gloss.motion[i][i % 2] = x)),
];

fn has(spoils: &[Spoil], name: &str) -> bool {
    spoils.iter().any(|(other, _)| *other == name)
}

/// Predicate of the spoilt pixels.
type Hit = fn(usize) -> bool;

const PLACES: [Named<Hit>; 3] =
    [("a pixel", |i| i == 100), ("a block", |i| i % 24 < 6 && i / 24 < 9), ("everywhere", |_| true)];

fn noisy(path: &Path) -> Rgb {
    grey(path.noise())
}

/// Returns the counts of a finished frame. The counts may arrive through another test's poll of the shared device.
fn counts(host: &mut Painted) -> InputCounts {
    for _ in 0..1000 {
        if let Some(counts) = host.denoiser.take_counts() {
            return counts;
        }
        gpu().wait();
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("no counts of a finished frame");
}

/// Filters eight frames, some of them spoilt; returns the number of pixels that cannot be shown, plus the miscounts.
fn spoilt(host: &mut Painted, frames: u32, spoil: Spoil, value: f32, hit: Hit) -> f64 {
    host.denoiser.reset();
    host.index = 0;
    let mut broken = 0.0;
    for frame in 0..8 {
        let glossy = has(&SPECULAR, spoil.0);
        let mut views = if glossy { host.glossy_views(&noisy, &noisy) } else { host.views(&noisy) };
        let bad = (2..2 + frames).contains(&frame);
        let chosen: Vec<usize> = (0..views.depth.len()).filter(|&i| bad && hit(i)).collect();
        chosen.iter().for_each(|&i| spoil.1(&mut views, i, value));
        broken += unusable(&host.denoise(&views)) as f64;
        let found = counts(host);
        let number = |is: bool| if is { chosen.len() as f64 } else { 0.0 };
        let is_light = has(&LIGHT, spoil.0) || has(&SPECULAR[..2], spoil.0);
        let expected = [
            number(is_light && !value.is_finite()),
            number(is_light && value.is_finite() && value < 0.0),
            number(match spoil.0 {
                // Any length above 0 is accepted.
                "normal" => !(1e-6..1e18).contains(&value.abs()),
                "motion" | "previous depth" => !value.is_finite(),
                // A depth of 0 is a miss, which is allowed.
                _ => false,
            }),
        ];
        let found = [found.non_finite, found.negative, found.surfaces].map(f64::from);
        broken += found.iter().zip(expected).map(|(f, e)| (f - e).abs()).sum::<f64>();
        broken += unusable(&host.view(View::Variance)) as f64;
        if glossy {
            broken += unusable(&host.view(View::Specular)) as f64;
            broken += unusable(&host.view(View::SpecularHistoryLength)) as f64;
        }
    }
    broken
}

fn each(spoils: &[Spoil], kinds: &[f32]) -> Worst {
    let mut worst = Worst::default();
    let mut host = Painted::new(SIZE, adaptive());
    for &spoil in spoils {
        for &value in kinds {
            for (place, hit) in PLACES {
                // Four frames in a row are the harder case; one kind is enough to test single frames.
                for frames in if value.is_nan() { &[1, 4][..] } else { &[4] } {
                    worst.add(spoilt(&mut host, *frames, spoil, value, hit), || {
                        format!("{value:e} in {}, {place}, {frames} frames", spoil.0)
                    });
                }
            }
        }
    }
    worst
}

fn light() -> Worst {
    each(&LIGHT, &KINDS)
}

fn surfaces() -> Worst {
    each(&SURFACE, &SURFACE_KINDS)
}

fn specular() -> Worst {
    each(&SPECULAR, &SPECULAR_KINDS)
}

fn afterwards() -> Worst {
    let size = [120, 9];
    let mut worst = Worst::default();
    let run = |spoil: Option<Spoil>, glossy: bool| {
        let mut host = Painted::new(size, adaptive());
        let mut images = Vec::new();
        for frame in 0..6 {
            let mut views = if glossy { host.glossy_views(&noisy, &noisy) } else { host.views(&noisy) };
            if let (3, Some(spoil)) = (frame, spoil) {
                (0..views.depth.len()).filter(|i| i % 120 < 6).for_each(|i| spoil.1(&mut views, i, f32::NAN));
            }
            images.push(host.denoise(&views));
        }
        images
    };
    let clean = [false, true].map(|glossy| run(None, glossy));
    for spoil in LIGHT.into_iter().chain(SURFACE).chain(SPECULAR) {
        let glossy = has(&SPECULAR, spoil.0);
        let (images, clean) = (run(Some(spoil), glossy), &clean[usize::from(glossy)]);
        // Columns beyond the reach of the filter in two frames.
        let far = |image: &[Rgb]| -> Vec<Rgb> {
            image.iter().enumerate().filter(|(i, _)| i % 120 >= 80).map(|(_, c)| *c).collect()
        };
        for (frame, (found, expected)) in images.iter().zip(clean).enumerate() {
            let value = difference(&far(found), &far(expected)).max(unusable(found) as f64);
            worst.add(value, || format!("{}, frame {frame}", spoil.0));
        }
    }
    worst
}
