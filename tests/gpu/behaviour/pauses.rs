//! Motion follows from the frame that a denoiser rendered last: the time, number and purpose of scene updates make no difference.

use crate::common::stage::Stage;
use crate::common::statistics::{Rgb, relative_mse};
use asvgf::scene::Pose;
use asvgf::{FilterSettings, Frame, Gradient, Mode, Settings, View};

const SIZE: [u32; 2] = [40, 24];

fn settings() -> [Settings; 4] {
    let with = |gradient| FilterSettings { gradient, ..Default::default() };
    let filters = [with(Gradient::Reshade), with(Gradient::BlinnPhong), FilterSettings::classic(), with(Gradient::Off)];
    filters.map(|filter| Settings { filter, ..Settings::adaptive() })
}

/// A stage in the middle of an animation in which everything moves.
fn moving(settings: Settings) -> Stage {
    moving_in("cornell", settings)
}

fn moving_in(scene: &str, settings: Settings) -> Stage {
    let mut stage = Stage::built_in(scene, "all", SIZE, settings);
    stage.index = 20;
    stage.frames(4);
    stage
}

/// Renders the next frame of the scene as of its last update.
fn render(stage: &mut Stage, pose: &Pose) -> Vec<Rgb> {
    let frame =
        Frame { scene: &stage.uploaded, camera: stage.camera_in(pose), index: stage.index, target: &stage.target };
    let gpu = stage.gpu;
    gpu.submit(|encoder| stage.denoiser.render(&gpu.device, encoder, &frame)).unwrap();
    stage.index += 1;
    stage.image()
}

/// Updates a stage's scene to poses without rendering.
fn update(stage: &mut Stage, poses: &[&Pose]) {
    let gpu = stage.gpu;
    gpu.submit(|encoder| poses.iter().for_each(|pose| stage.uploaded.update(&gpu.device, encoder, pose).unwrap()));
}

fn assert_still_in_pauses(scene: &str, settings: Settings) {
    let what = |frame: u32| format!("{scene}, {:?}, frame {frame}", settings.filter.gradient);
    let [mut left, mut updated, mut shaken] = [0; 3].map(|_| moving_in(scene, settings.clone()));
    let (pose, other) = (left.pose_at(23), left.pose_at(50));
    for frame in 0..6 {
        update(&mut updated, &[&pose]);
        update(&mut shaken, &[&other, &pose]);
        let image = render(&mut left, &pose);
        assert!(image == render(&mut updated, &pose), "{}: updated", what(frame));
        assert!(image == render(&mut shaken, &pose), "{}: elsewhere in between", what(frame));
        let mut motions = vec![View::Motion];
        motions.extend(left.denoiser.plan().unwrap().specular.is_some().then_some(View::ReflectionMotion));
        for view in motions {
            assert!(left.view(view).iter().all(|m| m[0] == 0.0 && m[1] == 0.0), "{}: {view:?}", what(frame));
        }
        assert_eq!(left.largest(View::Lambda), 0.0, "{}", what(frame));
        assert_eq!(left.denoiser.plan().unwrap().features, updated.denoiser.plan().unwrap().features);
    }
    assert!(left.denoiser.plan().unwrap().features.has(asvgf::plan::Feature::Still), "{}", what(5));
}

#[test]
fn a_paused_scene_stands_still_whether_it_is_updated_or_not() {
    settings().into_iter().for_each(|settings| assert_still_in_pauses("cornell", settings));
}

#[test]
fn reflections_stand_still_in_a_paused_scene() {
    let [reshade, analytic, _, off] = settings();
    [reshade, analytic, off].into_iter().for_each(|settings| assert_still_in_pauses("gloss", settings));
}

/// Share of the pixels with gloss whose specular history is at least this long.
fn share_of_histories(stage: &mut Stage, length: f32) -> f64 {
    let lengths = stage.view(View::SpecularHistoryLength);
    let shines: Vec<f32> = lengths.iter().map(|l| l[0]).filter(|&l| l > 0.0).collect();
    shines.iter().filter(|&&l| l >= length).count() as f64 / shines.len() as f64
}

/// A pause adds samples to the reflections' histories, and costs none of what was there when the scene goes on.
#[test]
fn reflections_have_their_histories_after_a_pause() {
    let animation = |stage: &mut Stage, poses: std::ops::Range<u32>| {
        for pose in poses {
            let pose = stage.pose_at(pose);
            stage.frame_in(&pose);
        }
    };
    let [mut paused, mut moving] = [0; 2].map(|_| Stage::built_in("gloss", "move-camera", SIZE, Settings::adaptive()));
    for stage in [&mut paused, &mut moving] {
        animation(stage, 20..28);
    }
    for _ in 0..4 {
        animation(&mut paused, 27..28);
    }
    let [before, after] = [28..28, 28..29].map(|poses| {
        for stage in [&mut paused, &mut moving] {
            animation(stage, poses.clone());
        }
        [share_of_histories(&mut paused, 9.0), share_of_histories(&mut moving, 5.0)]
    });
    println!("long histories, paused and moving: {before:.3?} before the next motion, {after:.3?} after it");
    assert!(after[0] >= after[1] - 0.02, "{after:?}");
}

#[test]
fn what_moves_at_half_the_frame_rate_rests_in_between() {
    let mut stage = moving(Settings::adaptive());
    for step in 0..3 {
        let pose = stage.pose_at(24 + 2 * step);
        update(&mut stage, &[&pose]);
        render(&mut stage, &pose);
        assert!(stage.view(View::Motion).iter().any(|m| m[0] != 0.0 || m[1] != 0.0), "step {step}");
        render(&mut stage, &pose);
        assert!(stage.view(View::Motion).iter().all(|m| m[0] == 0.0 && m[1] == 0.0), "step {step}");
    }
}

#[test]
fn each_of_several_denoisers_sees_its_own_motion() {
    for settings in settings() {
        // One denoiser sees every pose of a scene, another every second pose. Two more do the same with scenes of their own.
        let (mut every, mut every_alone) = (moving(settings.clone()), moving(settings.clone()));
        let mut second_alone = Stage::built_in("cornell", "all", SIZE, settings.clone());
        let mut second = Stage::built_in("cornell", "all", SIZE, settings).denoiser;
        for step in 0..6 {
            let pose = every.pose_at(24 + step);
            update(&mut every, &[&pose]);
            update(&mut every_alone, &[&pose]);
            if step % 2 == 1 {
                update(&mut second_alone, &[&pose]);
                let index = std::mem::replace(&mut every.index, second_alone.index);
                std::mem::swap(&mut every.denoiser, &mut second);
                let image = render(&mut every, &pose);
                std::mem::swap(&mut every.denoiser, &mut second);
                every.index = index;
                assert!(image == render(&mut second_alone, &pose), "step {step}: every second pose");
            }
            assert!(render(&mut every, &pose) == render(&mut every_alone, &pose), "step {step}: every pose");
        }
    }
}

#[test]
fn a_mean_over_frames_goes_on_in_a_scene_that_has_moved() {
    let settings = Settings { mode: Mode::Reference, ..Settings::adaptive() };
    let mut moved = moving(settings.clone());
    let mut rested = Stage::built_in("cornell", "all", SIZE, settings);
    let pose = moved.pose_at(40);
    rested.index = moved.index;
    update(&mut moved, &[&pose]);
    update(&mut rested, &[&pose]);
    for frame in 0..8 {
        assert!(render(&mut moved, &pose) == render(&mut rested, &pose), "frame {frame}");
    }
    // The result is a mean, with an eighth of the variance of one frame.
    let mut noisy = Stage::built_in("cornell", "all", SIZE, Settings { mode: Mode::Noisy, ..Settings::adaptive() });
    noisy.index = 1000;
    update(&mut noisy, &[&pose]);
    let one = render(&mut noisy, &pose);
    let eight = moved.image();
    let truth = (0..192).map(|_| render(&mut rested, &pose)).last().unwrap();
    let [one, eight] = [one, eight].map(|image| relative_mse(&image, &truth));
    println!("relative squared error {one:.4} after one frame, {eight:.4} after eight");
    assert!((4.0..16.0).contains(&(one / eight)));
}

#[test]
fn a_frame_number_out_of_step_begins_anew_in_every_mode() {
    let reference = Settings { mode: Mode::Reference, ..Settings::adaptive() };
    for settings in settings().into_iter().chain([reference]) {
        for step in [0, 2, -1_i64] {
            let what = format!("{:?}, {:?}, step {step}", settings.mode, settings.filter.gradient);
            let mut stage = Stage::built_in("cornell", "static", SIZE, settings.clone());
            stage.frames(5);
            stage.index = (4 + step) as u32;
            let mut fresh = Stage::built_in("cornell", "static", SIZE, settings.clone());
            fresh.index = stage.index;
            assert!(stage.frame().image() == fresh.frame().image(), "{what}");
        }
    }
}
