//! A host that hands in an image and its G-buffer, without pairs.

use super::{SIZE, Uploaded, denoiser, difference, recorded, replay, reshading, target, upload, view};
use crate::common::gpu::gpu;
use crate::common::stage::Stage;
use crate::common::statistics::{Rgb, mean, relative_mse};
use asvgf::{FilterSettings, Gradient, Lambda, Mode, Pairs, Settings, Shading, View};

fn with(gradient: Gradient) -> Settings {
    Settings { filter: FilterSettings { gradient, ..Default::default() }, ..Settings::adaptive() }
}

#[test]
fn a_lamp_that_goes_out_is_followed_without_pairs() {
    let frames = recorded(Settings::adaptive());
    let [adaptive, constant] =
        [Settings::adaptive(), Settings::adaptive().constant(0.1)].map(|s| replay(&mut denoiser(s), &frames));
    // The lamp went out at least two frames before the last one.
    let last = frames.len() - 1;
    let truth = mean(&frames[last].denoised);
    let off = |image: &[Rgb]| (mean(image) / truth - 1.0).abs();
    // The renderers' images also differ by their noise.
    assert!(off(&adaptive[last]) < 0.25, "{} of the light is left or missing", off(&adaptive[last]));
    assert!(off(&constant[last]) > 2.0, "the lamp is nothing to lag behind");
}

#[test]
fn a_still_scene_keeps_its_history() {
    let frames: Vec<_> = recorded(Settings::adaptive());
    // The sequence repeats the frames before the lamp goes out, each with noise of its own.
    let mut stage = Stage::built_in("cornell", "static", SIZE, Settings::adaptive()).leaving_nothing_out();
    (stage.camera, stage.index) = (Some(frames[0].camera), 0);
    let reference = {
        let settings = Settings { mode: Mode::Reference, ..Settings::adaptive() };
        let mut stage = Stage::built_in("cornell", "static", SIZE, settings);
        stage.camera = Some(frames[0].camera);
        stage.frames(2000).image()
    };
    let settings = with(Gradient::Statistics);
    stage.denoiser.set_settings(settings.clone()).unwrap();
    let mut lambda = 0.0;
    for _ in 0..24 {
        lambda += stage.frame().view(View::Lambda).iter().map(|l| f64::from(l[0])).sum::<f64>();
    }
    let lambda = lambda / f64::from(24 * SIZE[0] * SIZE[1]);
    assert!(lambda <= 0.01, "mean λ {lambda}");
    let error = relative_mse(&stage.image(), &reference);
    let mut constant = Stage::built_in("cornell", "static", SIZE, Settings::adaptive().constant(0.02));
    (constant.camera, constant.index) = (Some(frames[0].camera), 0);
    let best = relative_mse(&constant.leaving_nothing_out().frames(24).image(), &reference);
    assert!(error < 1.15 * best, "{error} after 24 frames, {best} with a constant α of 0.02");
}

#[test]
fn what_a_frame_brings_is_used() {
    let frames = recorded(Settings::adaptive());
    // −1 marks a pixel without a pair.
    let none = upload(gpu(), SIZE, &vec![[-1.0_f32; 3]; frames[0].light.len()]);
    let half = upload(gpu(), SIZE, &vec![[0.5_f32]; frames[0].light.len()]);
    let run = |gradient: Gradient, pairs: bool, lambda: bool| {
        let (mut denoiser, target) = (denoiser(with(gradient)), target());
        for frame in &frames {
            let host = Uploaded::new(gpu(), frame);
            let shading = Shading {
                pairs: pairs.then_some(Pairs { current: &none, previous: &none, in_place: false }),
                lambda: lambda.then_some(Lambda { view: &half, block: 1, confidence: false }),
                ..host.shading(&target)
            };
            gpu().submit(|encoder| {
                let reshade = denoiser.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
                assert!(reshade.is_none(), "the host was not asked to repeat a path");
                denoiser.denoise(&gpu().device, encoder, &shading).unwrap();
            });
        }
        view(&mut denoiser, View::Denoised)
    };
    let automatic = |pairs, lambda| run(Gradient::Automatic, pairs, lambda);
    assert_eq!(automatic(false, false), run(Gradient::Statistics, false, false), "nothing but an image");
    assert_eq!(automatic(true, false), run(Gradient::Pairs, true, false), "pairs");
    assert_eq!(automatic(true, true), run(Gradient::Lambda, false, true), "λ");
    let [a, b] = [run(Gradient::Statistics, false, false), run(Gradient::Lambda, false, true)];
    assert!(difference(&a, &b)[1] > 1e-3, "these differ");
}

#[test]
fn pairs_may_come_and_go_without_losing_the_history() {
    let frames = recorded(Settings::adaptive());
    let none = upload(gpu(), SIZE, &vec![[-1.0_f32; 3]; frames[0].light.len()]);
    let (mut denoiser, target) = (denoiser(Settings::adaptive()), target());
    for (i, frame) in frames[..4].iter().enumerate() {
        let host = Uploaded::new(gpu(), frame);
        let pairs = (i % 2 == 1).then_some(Pairs { current: &none, previous: &none, in_place: false });
        gpu().submit(|encoder| {
            denoiser.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
            denoiser.denoise(&gpu().device, encoder, &Shading { pairs, ..host.shading(&target) }).unwrap();
        });
    }
    let lengths = view(&mut denoiser, View::HistoryLength);
    let long = lengths.iter().filter(|n| n[0] > 2.5).count();
    assert!(2 * long > lengths.len(), "{long} of {} pixels have three frames", lengths.len());
}

#[test]
fn repeated_paths_are_asked_for_where_the_settings_say_so() {
    let frames = recorded(Settings::adaptive());
    let host = Uploaded::new(gpu(), &frames[0]);
    let mut denoiser = denoiser(reshading());
    let reshade = gpu().submit(|encoder| denoiser.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap());
    assert!(reshade.is_some());
}
