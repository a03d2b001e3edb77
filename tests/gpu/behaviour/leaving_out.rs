//! The parts that a frame leaves out are not missed.

use crate::common::gpu::gpu;
use crate::common::stage::Stage;
use crate::common::statistics::{mean, relative_mse};
use asvgf::scene::builtin;
use asvgf::{Denoiser, DenoiserDescriptor, FilterSettings, Gradient, Mode, Settings, TracerSettings, View};
use wgpu::TextureFormat;

const SIZE: [u32; 2] = [48, 27];

/// Names of the last frame's passes.
fn passes(stage: &Stage) -> Vec<&'static str> {
    stage.denoiser.plan().unwrap().steps.iter().map(|step| step.pass.name()).collect()
}

fn constant() -> Settings {
    Settings { filter: FilterSettings { gradient: Gradient::Off, ..Default::default() }, ..Settings::adaptive() }
}

/// Asserts that histories have this length. Beyond 32 they are counted at random, with an error of n/√32 per pixel at worst.
fn assert_counted(stage: &mut Stage, frames: u32) {
    let lengths: Vec<f64> =
        stage.view(View::HistoryLength).iter().map(|n| f64::from(n[0])).filter(|&n| n > 0.0).collect();
    let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
    println!("{frames} frames, counted as {mean:.1}");
    let allowed = 5.0 * f64::from(frames) / (32.0 * lengths.len() as f64).sqrt();
    assert!((mean - f64::from(frames)).abs() <= allowed, "{mean} instead of {frames} ± {allowed}");
}

#[test]
fn a_still_image_converges_like_the_mean_of_its_frames() {
    let tracer = TracerSettings { samples: 256, seed: 1, ..Default::default() };
    let truth = Settings { mode: Mode::Reference, tracer, ..Settings::adaptive() };
    let reference = Stage::built_in("cornell", "static", SIZE, truth).frames(64).image();
    let errors = |iterations| {
        let filter = FilterSettings { iterations, ..Default::default() };
        let settings = Settings { filter, ..Settings::adaptive() };
        let mut stage = Stage::built_in("cornell", "static", SIZE, settings);
        let errors = [64, 960].map(|frames| relative_mse(&stage.frames(frames).image(), &reference).sqrt());
        assert_counted(&mut stage, 1024);
        errors
    };
    // The root of the mean squared error of a mean of n falls as n^(−1/2); with a floor of α = 1/64 it would not fall at all.
    let mean = errors(0);
    let slope = (mean[1] / mean[0]).ln() / 16.0_f64.ln();
    println!("error of the mean {mean:.5?} after 64 and 1024 frames: slope {slope:.3}");
    assert!((-0.55..=-0.45).contains(&slope), "{slope}");
    // In space, remaining noise is filtered, and a pixel without noise is left alone.
    let filtered = errors(FilterSettings::default().iterations);
    println!("filtered {filtered:.5?}");
    assert!(filtered[0] < 0.75 * mean[0] && filtered[1] < mean[1]);
}

#[test]
fn frames_without_a_change_run_no_gradient_and_the_next_change_is_seen() {
    let mut stage = Stage::built_in("cornell", "blink", SIZE, Settings::adaptive());
    let mut left_out = 0;
    // The lamp goes out in frame 30.
    for frame in 0..30 {
        stage.frame();
        left_out += u32::from(!passes(&stage).contains(&"gradient_sample"));
        assert_eq!(frame > 0, !passes(&stage).contains(&"gradient"), "frame {frame}");
    }
    assert_eq!(left_out, 29);
    let lit = mean(&stage.image());
    stage.frame();
    assert!(passes(&stage).contains(&"gradient"), "something changed");
    assert!(stage.largest(View::Lambda) > 0.9, "λ {}", stage.largest(View::Lambda));
    let dark = mean(&stage.image());
    println!("mean {lit:.4} with the lamp, {dark:.4} in the frame after");
    assert!(dark < 0.5 * lit, "the history was dropped");
    stage.frame();
    assert!(!passes(&stage).contains(&"gradient"), "nothing changed any more");
}

#[test]
fn a_history_that_grew_while_nothing_moved_is_cut_when_something_does() {
    let mut stage = Stage::built_in("cornell", "static", SIZE, Settings::adaptive());
    stage.frames(100);
    assert_counted(&mut stage, 100);
    let pose = stage.pose_at(0);
    let mut camera = stage.camera_in(&pose);
    camera.eye[0] += 0.01;
    stage.camera = Some(camera);
    assert_eq!(stage.frame().largest(View::HistoryLength), 64.0);
    // The lights and surfaces are the same: only the camera moved.
    let features = stage.denoiser.plan().unwrap().features;
    assert!(features.has(asvgf::plan::Feature::Unchanged));
    assert!(!features.has(asvgf::plan::Feature::Still));
}

#[test]
fn without_reprojection_a_still_history_is_the_same() {
    // α is constant, so that the same samples go into both.
    let mut spared = Stage::built_in("pillars", "static", SIZE, constant());
    let mut reprojected = Stage::built_in("pillars", "static", SIZE, constant()).leaving_nothing_out();
    for _ in 0..8 {
        spared.frame();
        reprojected.frame();
    }
    assert!(spared.denoiser.plan().unwrap().features.has(asvgf::plan::Feature::Still));
    let difference = relative_mse(&spared.image(), &reprojected.image());
    println!("relative squared difference {difference:.1e}");
    // Two levels of trees instead of one round rays' hits differently: one path in ten thousand goes elsewhere.
    assert!(difference < 1e-5);
}

#[test]
fn textures_that_are_shared_change_nothing() {
    for settings in [Settings::adaptive(), Settings::classic(), constant()] {
        let scene = builtin::scene("cornell", "all").unwrap();
        let mut kept = Stage::new(scene.clone(), SIZE, settings.clone());
        let mut shared = Stage::new(scene, SIZE, settings.clone());
        let descriptor = DenoiserDescriptor { size: SIZE, settings, ..Default::default() };
        shared.denoiser = Denoiser::new(&gpu().device, &gpu().queue, &descriptor).unwrap();
        for frame in 0..6 {
            assert_eq!(kept.frame().image(), shared.frame().image(), "frame {frame}");
        }
        let [kept, shared] = [&kept, &shared].map(|stage| stage.denoiser.memory());
        println!("{shared} bytes instead of {kept}");
        assert!(shared < kept);
    }
}

#[test]
fn what_was_prepared_is_all_that_frames_need_and_is_shared() {
    let mut first = Stage::built_in("cornell", "blink", SIZE, Settings::adaptive());
    first.denoiser.prepare(&first.uploaded, TextureFormat::Rgba32Float).unwrap();
    let prepared = first.denoiser.pipelines().count();
    let pipelines = Some(first.denoiser.pipelines().clone());
    let descriptor = DenoiserDescriptor { size: SIZE, pipelines, views: true, ..Default::default() };
    let second = Denoiser::new(&gpu().device, &gpu().queue, &descriptor).unwrap();
    // Three cases: a still scene, a light that goes out, and a view from elsewhere.
    first.frames(32);
    first.denoiser = second;
    first.index = 28;
    first.frames(4);
    let pose = first.pose_at(40);
    let mut camera = first.camera_in(&pose);
    camera.eye[0] += 0.01;
    first.camera = Some(camera);
    first.frames(1);
    assert_eq!(first.denoiser.pipelines().count(), prepared);
}
