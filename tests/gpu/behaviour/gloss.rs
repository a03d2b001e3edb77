//! Specular light as a signal of its own: the sum of both signals is the light, and nothing that does not shine notices.

use crate::common::scenes::{block, emitter, floor, glass, lambert, quad, scene};
use crate::common::stage::Stage;
use crate::common::statistics::{Estimate, Rgb, luminance, mean};
use asvgf::scene::{Clearcoat, Material, Scene, builtin};
use asvgf::{Camera, FilterSettings, Gradient, Mode, Settings, View};

const SIZE: [u32; 2] = [40, 30];

/// Without a gradient, no pixel repeats the path of another.
fn with_gloss(gloss: bool, gradient: Gradient) -> Settings {
    Settings { filter: FilterSettings { gloss, gradient, ..Default::default() }, ..Settings::adaptive() }
}

/// Mean luminance of each block of 4×4 pixels.
fn blocks(image: &[Rgb]) -> Vec<f64> {
    let [width, height] = SIZE.map(|s| s as usize);
    let corners = (0..height).step_by(4).flat_map(|y| (0..width).step_by(4).map(move |x| (x, y)));
    corners
        .map(|(x, y)| {
            let rows = y..(y + 4).min(height);
            let pixels: Vec<Rgb> = rows.flat_map(|y| image[y * width + x..y * width + x + 4].to_vec()).collect();
            mean(&pixels)
        })
        .collect()
}

#[test]
fn both_signals_together_are_the_light() {
    assert_sum(|settings| Stage::built_in("gloss", "static", SIZE, settings));
}

#[test]
fn both_signals_of_glass_together_are_the_light() {
    let before = Camera { eye: [0.0, 1.0, 3.0], target: [0.0, 0.2, 0.0], fov_y: 0.8, ..Default::default() };
    // Within the body that absorbs.
    let inside = Camera { eye: [0.4, 0.4, 0.3], target: [0.2, 0.1, -0.2], fov_y: 1.2, ..Default::default() };
    for camera in [before, inside] {
        assert_sum(|settings| {
            let mut stage = Stage::new(behind_glass(), SIZE, settings);
            stage.camera = Some(camera);
            stage
        });
    }
}

#[test]
fn both_signals_of_a_coat_together_are_the_light() {
    let camera = Camera { eye: [0.0, 1.0, 3.0], target: [0.0, 0.2, 0.0], fov_y: 0.8, ..Default::default() };
    assert_sum(|settings| {
        let mut scene = behind_glass();
        for (material, roughness) in scene.materials.iter_mut().zip([0.0, 0.2, 0.5, 0.1]) {
            material.clearcoat = Clearcoat { weight: 0.9, roughness, ..Default::default() };
        }
        let mut stage = Stage::new(scene, SIZE, settings);
        stage.camera = Some(camera);
        stage
    });
}

/// A shiny floor and a lamp, half of it behind frosted glass that a clear body touches.
fn behind_glass() -> Scene {
    let shiny = Material { specular: [0.04; 3], roughness: 0.3, ..lambert([0.6, 0.4, 0.2]) };
    let frosted = Material { transmission: 0.7, ..glass(1.5, 0.6, None) };
    let floor = floor(0);
    let lamp = quad([-0.5, 1.5, -1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], 3);
    let pane = quad([-0.6, 0.0, 0.5], [0.6, 0.0, 0.0], [0.0, 1.0, 0.0], 1);
    let mut meshes = vec![floor, lamp, pane];
    meshes.extend(block([0.1, 0.1, -0.2], [0.7, 0.7, 0.4], 2));
    let materials = vec![shiny, frosted, glass(1.5, 0.0, Some([0.2, 0.5, 1.0])), emitter([6.0; 3])];
    scene(materials, meshes)
}

fn assert_sum(stage: impl Fn(Settings) -> Stage) {
    let mut split = stage(with_gloss(true, Gradient::Off));
    let mut whole = stage(with_gloss(false, Gradient::Off));
    // Other random numbers than `split` has, for a mean that owes it nothing.
    let mut apart = stage(with_gloss(false, Gradient::Off));
    apart.index = 1000;
    let (mut of_split, mut of_apart) = (Vec::new(), Vec::new());
    for frame in 0..32 {
        let [a, b, c] = [&mut split, &mut whole, &mut apart].map(|stage| stage.frame().view(View::Noisy));
        let brightest = b.iter().map(|&c| luminance(c)).fold(0.0, f64::max);
        for (i, (a, b)) in a.iter().zip(&b).enumerate() {
            let largest = f64::from(b.iter().fold(0.0_f32, |m, x| m.max(*x)));
            for channel in 0..3 {
                let off = f64::from((a[channel] - b[channel]).abs());
                // The paths are the same. Each signal has 18 bits, and an albedo of 11.
                assert!(off <= 1e-3 * largest + 1e-6 * brightest, "frame {frame}, pixel {i}: {a:?} and {b:?}");
            }
        }
        of_split.push(blocks(&a));
        of_apart.push(blocks(&c));
    }
    let estimate =
        |frames: &[Vec<f64>], block: usize| Estimate::of(&frames.iter().map(|f| f[block]).collect::<Vec<_>>());
    let count = of_split[0].len();
    let beyond = |k: f64| {
        (0..count)
            .filter(|&block| {
                let [a, b] = [&of_split, &of_apart].map(|frames| estimate(frames, block));
                (a.mean - b.mean).abs() > k * a.error.hypot(b.error) + 1e-3 * b.mean
            })
            .count()
    };
    println!(
        "{} of {count} blocks are more than two standard errors apart, {} more than three",
        beyond(2.0),
        beyond(3.0)
    );
    // Of normal errors, 4.6 % are beyond two and 0.3 % beyond three; those of few bright paths are no normal ones.
    assert!(beyond(2.0) <= count / 10 && beyond(3.0) <= count / 40);
}

#[test]
fn filtering_both_signals_keeps_the_energy() {
    let of = |settings: Settings| {
        let mut stage = Stage::built_in("gloss", "static", SIZE, settings);
        (0..64).map(|_| mean(&stage.frame().image())).sum::<f64>() / 64.0
    };
    let noisy = of(Settings { mode: Mode::Noisy, ..Settings::adaptive() });
    let plain = FilterSettings { outlier_limit: 0.0, gloss_clamp: 0.0, ..with_gloss(true, Gradient::Off).filter };
    let cases = [
        ("without limits", Settings { filter: plain, ..Settings::adaptive() }, 0.005),
        // The limit of outliers and the clamp take light from what few paths have met.
        ("by default", with_gloss(true, Gradient::Off), 0.01),
    ];
    for (name, settings, allowed) in cases {
        let bias = of(settings) / noisy - 1.0;
        println!("energy, {name}: {:+.2} %", 100.0 * bias);
        assert!(bias.abs() < allowed, "{name}: {bias:+.4} of the unfiltered mean {noisy}");
    }
}

#[test]
fn repeated_paths_of_a_still_scene_that_shines_are_the_same() {
    let mut stage = Stage::built_in("gloss", "static", SIZE, with_gloss(true, Gradient::Reshade)).leaving_nothing_out();
    for frame in 0..16 {
        stage.frame();
        assert_eq!(stage.largest(View::Lambda), 0.0, "frame {frame}: λ");
        assert_eq!(stage.largest(View::Gradient), 0.0, "frame {frame}: gradient");
    }
    assert!(stage.largest(View::HistoryLength) > 12.0);
}

#[test]
fn the_order_of_materials_does_not_matter() {
    let scene = builtin::scene("gloss", "static").unwrap();
    let mut renamed = scene.clone();
    renamed.materials.reverse();
    for mesh in &mut renamed.meshes {
        mesh.material = scene.materials.len() - 1 - mesh.material;
    }
    let [mut a, mut b] = [scene, renamed].map(|scene| Stage::new(scene, SIZE, Settings::adaptive()));
    for frame in 0..8 {
        assert_eq!(a.frame().image(), b.frame().image(), "frame {frame}");
    }
}

#[test]
fn where_nothing_shines_there_is_one_signal() {
    for gradient in [Gradient::Automatic, Gradient::Statistics] {
        let [mut a, mut b] =
            [true, false].map(|gloss| Stage::built_in("cornell", "all", SIZE, with_gloss(gloss, gradient)));
        for frame in 0..4 {
            assert_eq!(a.frame().image(), b.frame().image(), "frame {frame}");
        }
        assert!(a.denoiser.plan().unwrap().specular.is_none());
    }
}
