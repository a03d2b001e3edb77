//! The three ways to an adaptive α agree with each other, and with the path tracer's own gradient.

use super::{SIZE, Uploaded, colors, denoiser, difference, recorded, replay, reshading, target, upload, view};
use crate::common::gpu::gpu;
use crate::common::statistics::Rgb;
use asvgf::{FilterSettings, Gradient, Lambda, Pairs, Settings, Shading, View};
use wgpu::TextureView;

fn with(gradient: Gradient, history_ratio: bool) -> Settings {
    let filter = FilterSettings { gradient, history_ratio, ..Default::default() };
    Settings { filter, ..Settings::adaptive() }
}

/// Rounding: the host's light went through a product and a quotient in f32, and is rounded once more to 18 bits. If that makes the
/// gradient see a change of a path by some 2⁻¹⁷, an equally small part of a history is lost.
const ROUNDING: [f64; 2] = [5e-3, 1e-4];

fn assert_same(a: &[Rgb], b: &[Rgb], allowed: [f64; 2], what: &str) {
    let found = difference(a, b);
    assert!(found[0] <= allowed[0] && found[1] <= allowed[1], "{what}: {found:?} is more than {allowed:?}");
}

#[test]
fn level_2_is_the_path_tracers_own_gradient() {
    let frames = recorded(Settings::adaptive());
    let images = replay(&mut denoiser(reshading()), &frames);
    // A host may repeat the same noise in every frame; the path tracer does not. Where two samples agree to a thousandth by chance, the
    // pixel of a host takes its neighbours' variance.
    let allowed = [0.03, ROUNDING[1]];
    for (image, frame) in images.iter().zip(&frames) {
        assert_same(image, &frame.denoised, allowed, &format!("frame {}", frame.index));
    }
    // The gradient makes the difference: without it, the lamp stays on in the history.
    let blind = replay(&mut denoiser(with(Gradient::Off, false)), &frames);
    let last = frames.len() - 1;
    assert!(difference(&blind[last], &frames[last].denoised)[1] > 0.5, "nothing changed in this scene");
}

/// Pairs from the re-shaded paths of a frame, where `begin_frame` asks for them.
fn pairs(repeats: &TextureView, now: &[Rgb], before: &[Rgb]) -> [Vec<Rgb>; 2] {
    let words: Vec<u32> = bytemuck::pod_collect_to_vec(&gpu().read(repeats.texture()));
    let mut images = [vec![[-1.0; 3]; now.len()], vec![[-1.0; 3]; now.len()]];
    let across = SIZE[0].div_ceil(3);
    for (i, pair) in words.chunks_exact(4).enumerate() {
        let (x, y) = (i as u32 % across, i as u32 / across);
        if let Some(place) = pair[0].checked_sub(1) {
            let pixel = ((3 * y + place / 3) * SIZE[0] + 3 * x + place % 3) as usize;
            let previous = ((pair[1] >> 16) * SIZE[0] + (pair[1] & 0xffff)) as usize;
            images[0][pixel] = now[pixel];
            images[1][pixel] = before[previous];
        }
    }
    images
}

#[test]
fn level_1_is_level_2_with_the_pairs_by_hand() {
    let frames = recorded(Settings::adaptive());
    let (mut shown, mut told) = (denoiser(reshading()), denoiser(with(Gradient::Pairs, true)));
    let [a, b] = [0; 2].map(|_| target());
    let mut largest = 0.0_f32;
    for (i, frame) in frames.iter().enumerate() {
        let host = Uploaded::new(gpu(), frame);
        let reshade = gpu().submit(|encoder| {
            let reshade = shown.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
            shown.denoise(&gpu().device, encoder, &host.shading(&a)).unwrap();
            reshade.expect("what to repeat")
        });
        let [current, previous] = pairs(&reshade.repeats, &frame.light, &frames[i.saturating_sub(1)].light);
        let [current, previous] = [current, previous].map(|image| upload(gpu(), SIZE, &image));
        gpu().submit(|encoder| {
            let none = told.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
            assert!(none.is_none(), "nothing is to be repeated");
            let pairs = Some(Pairs { current: &current, previous: &previous, in_place: true });
            told.denoise(&gpu().device, encoder, &Shading { pairs, ..host.shading(&b) }).unwrap();
        });
        assert_same(&colors(&b), &colors(&a), [1e-5, 1e-6], &format!("frame {}", frame.index));
        largest = view(&mut told, View::Lambda).iter().fold(largest, |largest, l| largest.max(l[0]));
    }
    assert!(largest > 0.5, "the lamp went out");
}

#[test]
fn level_0_with_the_same_lambda_does_the_same() {
    let frames = recorded(with(Gradient::Reshade, false));
    let (mut found, mut told) = (denoiser(with(Gradient::Pairs, false)), denoiser(with(Gradient::Lambda, false)));
    let mut doubting = denoiser(with(Gradient::Lambda, false));
    let mut guide = denoiser(with(Gradient::Reshade, false));
    let [a, b, c] = [0; 3].map(|_| target());
    for (i, frame) in frames.iter().enumerate() {
        let host = Uploaded::new(gpu(), frame);
        let reshade = gpu().submit(|encoder| {
            let reshade = guide.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
            guide.denoise(&gpu().device, encoder, &host.shading(&a)).unwrap();
            reshade.expect("what to repeat")
        });
        let images = pairs(&reshade.repeats, &frame.light, &frames[i.saturating_sub(1)].light);
        let [current, previous] = images.map(|image| upload(gpu(), SIZE, &image));
        gpu().submit(|encoder| {
            found.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
            // With `in_place: false`, the pairs affect λ alone.
            let pairs = Some(Pairs { current: &current, previous: &previous, in_place: false });
            found.denoise(&gpu().device, encoder, &Shading { pairs, ..host.shading(&a) }).unwrap();
        });
        let lambda: Vec<f32> = view(&mut found, View::Lambda).iter().map(|l| l[0]).collect();
        let image = |f: &dyn Fn(f32) -> f32| upload(gpu(), SIZE, &lambda.iter().map(|&l| [f(l)]).collect::<Vec<_>>());
        let (lambda, confidence) = (image(&|l| l), image(&|l| 1.0 - l));
        for (denoiser, view, confidence, target) in
            [(&mut told, &lambda, false, &b), (&mut doubting, &confidence, true, &c)]
        {
            gpu().submit(|encoder| {
                denoiser.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
                let lambda = Some(Lambda { view, block: 1, confidence });
                denoiser.denoise(&gpu().device, encoder, &Shading { lambda, ..host.shading(target) }).unwrap();
            });
        }
        let what = format!("frame {}", frame.index);
        assert_same(&colors(&b), &colors(&a), [1e-3, 1e-4], &what);
        assert_same(&colors(&c), &colors(&b), [1e-4, 1e-6], &what);
    }
}

#[test]
fn lambda_may_come_at_a_part_of_the_resolution() {
    // The left third keeps all, the middle half, the right nothing: one texel stands for 16 pixels.
    let frames = recorded(Settings::adaptive());
    let coarse = upload(gpu(), [3, 3], &[0.0, 0.5, 1.0, 0.0, 0.5, 1.0, 0.0, 0.5, 1.0].map(|l| [l]));
    let target = target();
    let (mut told, mut plain) = (denoiser(with(Gradient::Lambda, false)), denoiser(with(Gradient::Off, false)));
    for frame in &frames {
        let host = Uploaded::new(gpu(), frame);
        gpu().submit(|encoder| {
            told.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
            let lambda = Some(Lambda { view: &coarse, block: 16, confidence: false });
            told.denoise(&gpu().device, encoder, &Shading { lambda, ..host.shading(&target) }).unwrap();
            plain.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
            plain.denoise(&gpu().device, encoder, &host.shading(&target)).unwrap();
        });
    }
    let lengths = [&mut told, &mut plain].map(|denoiser| view(denoiser, View::HistoryLength));
    let mut sums = [[0.0_f32; 3]; 3];
    for (i, (told, plain)) in lengths[0].iter().zip(&lengths[1]).enumerate() {
        // Pixels without a history are skipped, as at the edge that the camera uncovers.
        if plain[0] > 1.0 {
            let sum = &mut sums[i % SIZE[0] as usize / 16];
            *sum = [sum[0] + told[0], sum[1] + plain[0], sum[2] + 1.0];
        }
    }
    let [all, half, nothing] = sums.map(|[told, plain, count]| [told / count, plain / count]);
    // Pixels that move over from the middle have lost some history.
    assert!(all[0] > 0.8 * all[1], "{all:?}: nothing was to be dropped");
    // In the long run, n = n·(1 − ½)^3.5 + 1.
    assert!((half[0] - 1.097).abs() < 0.05, "{half:?}: all but a tenth was to be dropped");
    assert_eq!(nothing[0], 1.0, "all was to be dropped");
}
