//! A scene and a camera that stand still.

use crate::common::stage::Stage;
use crate::common::statistics::{mean, relative_mse};
use asvgf::{FilterSettings, Gradient, Mode, Settings, TracerSettings, View};

const SIZE: [u32; 2] = [64, 36];

fn with_gradient(gradient: Gradient) -> Settings {
    Settings { filter: FilterSettings { gradient, ..Default::default() }, ..Settings::adaptive() }
}

/// Asserts over 100 frames that the filter sees no change.
fn assert_no_gradient(scene: &str, settings: Settings) {
    let gradient = settings.filter.gradient;
    let mut stage = Stage::built_in(scene, "static", [48, 27], settings).leaving_nothing_out();
    for frame in 0..100 {
        stage.frame();
        assert_eq!(stage.largest(View::Lambda), 0.0, "{scene}, {gradient:?}, frame {frame}: λ");
        if gradient != Gradient::Off {
            assert_eq!(stage.largest(View::Gradient), 0.0, "{scene}, {gradient:?}, frame {frame}: gradient");
        }
    }
    // The comparison was real: wherever something was hit, histories are as long as their limit of 64 allows or as the least α does,
    // (2 − α)/α. (Pixels that repeat a path add nothing to theirs, in 1 of 9 frames.)
    let worth = (2.0 / stage.denoiser.settings().filter.alpha - 1.0).min(64.0);
    let longest = stage.largest(View::HistoryLength);
    assert!((0.93 * worth..=1.01 * worth).contains(&longest), "{scene}: history of {longest}, not {worth}");
}

#[test]
fn repeated_paths_of_a_still_scene_are_the_same_to_the_last_bit() {
    assert_no_gradient("cornell", with_gradient(Gradient::Reshade));
    assert_no_gradient("pillars", with_gradient(Gradient::Reshade));
}

#[test]
fn the_published_formulas_find_no_change_either() {
    assert_no_gradient("cornell", Settings::classic());
    assert_no_gradient("pillars", Settings::classic());
}

#[test]
fn analytic_shading_of_a_still_scene_is_the_same_to_the_last_bit() {
    assert_no_gradient("cornell", with_gradient(Gradient::BlinnPhong));
    assert_no_gradient("pillars", with_gradient(Gradient::BlinnPhong));
}

#[test]
fn without_a_gradient_nothing_changes() {
    assert_no_gradient("cornell", with_gradient(Gradient::Off));
    assert_no_gradient("pillars", with_gradient(Gradient::Off));
}

#[test]
fn what_stands_still_has_no_motion() {
    for (scene, animation) in [("cornell", "static"), ("pillars", "static"), ("cornell", "blink")] {
        let mut stage = Stage::built_in(scene, animation, SIZE, Settings::adaptive());
        for _ in 0..3 {
            let motion = stage.frame().view(View::Motion);
            assert!(motion.iter().all(|m| m[0] == 0.0 && m[1] == 0.0), "{scene}, {animation}");
        }
        // Radiance is stored with 14 bits of mantissa.
        let rounded = |now: f32, before: f32| (before - now).abs() <= now * 2.0_f32.powi(-15);
        assert!(
            stage.view(View::Motion).iter().zip(stage.view(View::Depth)).all(|(m, d)| rounded(d[0], m[2])),
            "{scene}: the depth before is the depth now"
        );
    }
}

/// Mean brightness over 64 frames of one sample per pixel.
fn mean_of_64(settings: Settings) -> f64 {
    let mut stage = Stage::built_in("cornell", "static", SIZE, settings);
    (0..64).map(|_| mean(&stage.frame().image())).sum::<f64>() / 64.0
}

#[test]
fn filtering_keeps_the_energy() {
    let noisy = mean_of_64(Settings { mode: Mode::Noisy, ..Settings::adaptive() });
    let filtered = [
        ("adaptive", with_gradient(Gradient::Reshade), 0.01),
        ("analytic gradient", with_gradient(Gradient::BlinnPhong), 0.01),
        ("no gradient", with_gradient(Gradient::Off), 0.01),
        ("classic", Settings::classic(), 0.05),
    ];
    for (name, settings, allowed) in filtered {
        let bias = mean_of_64(settings) / noisy - 1.0;
        println!("energy, {name}: {:+.2} %", 100.0 * bias);
        assert!(bias.abs() <= allowed, "{name}: {bias:+.4} of the unfiltered mean {noisy}");
    }
}

#[test]
fn after_32_frames_the_error_is_a_twentieth_of_one_frames() {
    let tracer = TracerSettings { samples: 64, seed: 1, ..Default::default() };
    let truth = Settings { mode: Mode::Reference, tracer, ..Settings::adaptive() };
    let reference = Stage::built_in("cornell", "static", SIZE, truth).frames(8).image();
    let mut stage = Stage::built_in("cornell", "static", SIZE, Settings::adaptive());
    stage.frames(32);
    let filtered = relative_mse(&stage.image(), &reference);
    let noisy = relative_mse(&stage.view(View::Noisy), &reference);
    println!("relMSE: noisy {noisy:.5}, filtered {filtered:.5}, ratio {:.0}", noisy / filtered);
    assert!(20.0 * filtered <= noisy);
}
