//! Sizes, restarts and changes between frames.

use crate::common::stage::Stage;
use asvgf::scene::{GpuScene, builtin};
use asvgf::{FilterSettings, Gradient, Mode, Settings, View};

fn still(size: [u32; 2]) -> Stage {
    Stage::built_in("cornell", "static", size, Settings::adaptive())
}

/// The first frames of a denoiser that starts at frame `first`.
fn fresh(size: [u32; 2], settings: Settings, first: u32) -> Vec<Vec<[f32; 3]>> {
    let mut stage = Stage::built_in("cornell", "static", size, settings);
    stage.index = first;
    (0..3).map(|_| stage.frame().image()).collect()
}

fn next(stage: &mut Stage) -> Vec<Vec<[f32; 3]>> {
    (0..3).map(|_| stage.frame().image()).collect()
}

#[test]
fn every_size_works_and_may_follow_any_other() {
    for settings in [Settings::adaptive(), Settings::classic()] {
        let mut stage = Stage::built_in("cornell", "all", [64, 36], settings);
        for size in [[1, 1], [1, 9], [3, 3], [8, 8], [31, 17], [9, 1], [64, 36]] {
            stage.resize(size);
            let image = stage.frames(5).image();
            assert_eq!(image.len(), (size[0] * size[1]) as usize);
            assert!(image.iter().flatten().all(|c| c.is_finite() && *c >= 0.0), "{size:?}");
            assert!(image.iter().flatten().any(|c| *c > 0.0), "{size:?} is black");
            assert_eq!(stage.largest(View::NonFinite), 0.0, "{size:?}");
        }
    }
}

#[test]
fn a_new_size_begins_anew() {
    let mut stage = still([40, 24]);
    stage.frames(5);
    stage.resize([31, 17]);
    assert_eq!(next(&mut stage), fresh([31, 17], Settings::adaptive(), 5));
}

#[test]
fn the_same_size_again_changes_nothing() {
    let (mut a, mut b) = (still([40, 24]), still([40, 24]));
    a.frames(5).resize([40, 24]);
    b.frames(5);
    assert_eq!(next(&mut a), next(&mut b));
}

#[test]
fn a_reset_begins_anew() {
    let mut stage = still([31, 17]);
    stage.frames(5).denoiser.reset();
    assert_eq!(next(&mut stage), fresh([31, 17], Settings::adaptive(), 5));
}

#[test]
fn another_mode_begins_anew() {
    let mut stage = still([31, 17]);
    let reference = Settings { mode: Mode::Reference, ..Settings::adaptive() };
    stage.frames(4).denoiser.set_settings(reference.clone()).unwrap();
    assert_eq!(next(&mut stage), fresh([31, 17], reference, 4));
    stage.denoiser.set_settings(Settings::adaptive()).unwrap();
    assert_eq!(next(&mut stage), fresh([31, 17], Settings::adaptive(), 7));
}

#[test]
fn other_numbers_keep_the_history() {
    let mut stage = still([31, 17]);
    let before = stage.frames(6).largest(View::HistoryLength);
    let filter = FilterSettings { alpha: 0.3, sigma_luminance: 1.0, iterations: 2, ..Default::default() };
    stage.denoiser.set_settings(Settings { filter, ..Settings::adaptive() }).unwrap();
    assert!(stage.frame().largest(View::HistoryLength) >= before);
}

#[test]
fn the_gradient_may_be_changed_at_any_time() {
    let mut stage = still([31, 17]);
    for gradient in [Gradient::Reshade, Gradient::Off, Gradient::BlinnPhong, Gradient::Reshade, Gradient::BlinnPhong] {
        let filter = FilterSettings { gradient, ..Default::default() };
        stage.denoiser.set_settings(Settings { filter, ..Settings::adaptive() }).unwrap();
        stage.frames(3);
        assert_eq!(stage.largest(View::Lambda), 0.0, "{gradient:?}");
        assert!(stage.largest(View::HistoryLength) >= 2.0, "{gradient:?}");
    }
}

#[test]
fn another_scene_begins_anew() {
    let mut stage = still([31, 17]);
    stage.frames(6);
    // The other scene is an exact copy, so that only the history's length can tell.
    let gpu = stage.gpu;
    stage.uploaded = GpuScene::new(&gpu.device, &gpu.queue, &builtin::scene("cornell", "static").unwrap()).unwrap();
    assert_eq!(next(&mut stage), fresh([31, 17], Settings::adaptive(), 6));
}

#[test]
fn a_frame_that_was_left_out_begins_anew() {
    let mut stage = still([31, 17]);
    stage.frames(6).index += 1;
    assert_eq!(next(&mut stage), fresh([31, 17], Settings::adaptive(), 7));
}

#[test]
fn a_reference_is_a_mean_of_one_view() {
    let reference = Settings { mode: Mode::Reference, ..Settings::adaptive() };
    let mut stage = Stage::built_in("cornell", "static", [31, 17], reference.clone());
    let mut camera = stage.camera_in(&stage.pose_at(0));
    camera.eye[0] += 0.1;
    stage.frames(4).camera = Some(camera);
    let moved = stage.frame().image();
    let mut alone = Stage::built_in("cornell", "static", [31, 17], reference);
    (alone.index, alone.camera) = (4, Some(camera));
    assert_eq!(moved, alone.frame().image());
}
