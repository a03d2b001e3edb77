//! Cuts, teleports and other events between two frames. Other files test related events:
//! - tests/gpu/behaviour/lifecycle.rs and tests/gpu/host/recording.rs have new sizes, scenes and modes, and skipped
//!   frames, after which histories begin anew.
//! - Files named `recording.rs` have several frames in one submission.
//! - Files named `refusals.rs` have refused cameras.

use super::painted::{Painted, Path, adaptive, grey, with};
use super::{Breaks, Case, Worst, difference, unusable};
use crate::stability::common::scenes::{lambert, quad, scene, shine};
use crate::stability::common::stage::Stage;
use crate::stability::common::statistics::{Rgb, relative_mse};
use asvgf::scene::{Environment, LightKind, Transform};
use asvgf::{
    Blend, Camera, FilterSettings, Frame, Gradient, Kernel, Mode, Settings, Stops, TracerSettings, Variance, View,
};

pub const CASES: &[Case] = &[
    Case {
        name: "camera cut without `reset`",
        varied: "the Cornell box from three other places, with consecutive frame numbers",
        quantity: "relative MSE 4 frames later, over that of a run that was reset, less 1",
        bound: 1.0,
        origin: "old history is reused only where it shows the same surface; half of the samples would give 1",
        measure: cut,
        breaks: Breaks::Known("a cut to a view of the same surfaces keeps their history, which is still right"),
    },
    Case {
        name: "`reset` in each frame",
        varied: "ten frames with noise",
        quantity: "largest difference from a new denoiser for each frame",
        bound: 0.0,
        origin: "a reset keeps nothing",
        measure: resets,
        breaks: Breaks::Never("equal to the last bit"),
    },
    Case {
        name: "another size in each frame",
        varied: "24×18, 7×5, 1×1, 31×17, … ten frames",
        quantity: "largest difference from a new denoiser for each frame",
        bound: 0.0,
        origin: "a new size starts a new history",
        measure: resizes,
        breaks: Breaks::Never("equal to the last bit"),
    },
    Case {
        name: "every pixel disoccluded in each frame",
        varied: "motion −10⁹, NaN, ∞, another side; depth and normals of another wall each frame",
        quantity: "largest difference from a denoiser that is reset in each frame",
        bound: 0.0,
        origin: "no tap of the history shows the same surface",
        measure: disoccluded,
        breaks: Breaks::Never("equal to the last bit"),
    },
    Case {
        name: "an object teleports",
        varied: "a card before a lit wall, 0.1 … 3 sizes to the side, at once",
        quantity: "relative MSE 4 frames later, over that of a run that begins there, less 1",
        bound: 1.0,
        origin: "surfaces that it uncovers have no history, and surfaces that it shadows have a gradient; half of the samples would give 1",
        measure: teleports,
        breaks: Breaks::Never("exact motion leads out of the image, or to another surface"),
    },
    Case {
        name: "one of 200 lights changes",
        varied: "a light that is switched off, on, or made ten times as strong; all others beyond its range; 64 paths per pixel, so that some find it",
        quantity: "largest λ where only others shine",
        bound: 0.0,
        origin: "lights keep their number and probability, so paths to the others repeat to the last bit",
        measure: lights,
        breaks: Breaks::Known("λ spreads by 13 strata, 39 pixels, around the change"),
    },
    Case {
        name: "other settings in each frame",
        varied: "17 sets: α 0 … 1, σ 0 … 10⁶, iterations 0 … 8, both blends, stops, kernels, variances, feedback, modes",
        quantity: "pixels that are not finite and ≥ 0",
        bound: 0.0,
        origin: "all settings that `check` accepts are usable after any other",
        measure: settings,
        breaks: Breaks::Known("σ and α outside of their range, infinite and NaN are refused by name"),
    },
    Case {
        name: "each setting by itself",
        varied: "the same 17 sets but the modes; a wall with noise, 24 frames",
        quantity: "largest relative bias of the mean of the last 12 frames",
        bound: 0.05,
        origin: "three standard errors of the least smoothing are 2.5 %; as much again for bias of the luminance stop",
        measure: bias_of_settings,
        breaks: Breaks::Known("σ and α outside of their range, infinite and NaN are refused by name"),
    },
    Case {
        name: "frame numbers past 2³² − 1",
        varied: "the Cornell box, still, from 6 frames before to 6 after",
        quantity: "largest λ, or pixels whose history was lost",
        bound: 0.0,
        origin: "numbers are compared and hashed modulo 2³²",
        measure: wrap,
        breaks: Breaks::Never("no number is compared by size"),
    },
];

const SIZE: [u32; 2] = [24, 18];

fn noisy(path: &Path) -> Rgb {
    grey(path.noise())
}

/// Returns the error after four frames of a run with eight other frames before, over that of a run with none, minus 1.
fn against_a_fresh_run(mut used: Stage, mut fresh: Stage, reference: &[Rgb]) -> f64 {
    fresh.index = used.index;
    let errors = [&mut used, &mut fresh].map(|stage| relative_mse(&stage.frames(4).image(), reference));
    errors[0] / errors[1] - 1.0
}

fn reference(mut stage: Stage) -> Vec<Rgb> {
    let tracer = TracerSettings { samples: 32, seed: 1, ..Default::default() };
    stage.denoiser.set_settings(Settings { mode: Mode::Reference, tracer, ..Settings::adaptive() }).unwrap();
    stage.frames(4).image()
}

fn cut() -> Worst {
    let mut worst = Worst::default();
    let stage = |camera| {
        let mut stage = Stage::built_in("cornell", "static", [48, 36], Settings::adaptive());
        stage.camera = Some(camera);
        stage
    };
    let first = Camera { eye: [0.0, 1.0, 3.4], target: [0.0, 1.0, 0.0], fov_y: 0.6, ..Default::default() };
    let others = [
        ("the left wall", [0.5, 1.0, 0.5], [-1.0, 0.6, 0.0]),
        ("the floor", [0.0, 1.8, 0.3], [0.1, 0.0, -0.2]),
        ("aside", [0.7, 1.2, 3.2], [-0.2, 0.9, 0.0]),
    ];
    for (name, eye, target) in others {
        let other = Camera { eye, target, fov_y: 0.6, ..Default::default() };
        let reference = reference(stage(other));
        let mut used = stage(first);
        used.frames(8).camera = Some(other);
        worst.add(against_a_fresh_run(used, stage(other), &reference), || name.into());
    }
    worst
}

fn resets() -> Worst {
    let mut worst = Worst::default();
    let mut host = Painted::new(SIZE, adaptive());
    for frame in 0..10 {
        host.denoiser.reset();
        let mut fresh = Painted::new(SIZE, adaptive());
        fresh.index = frame;
        worst.add(difference(&host.frame(&noisy), &fresh.frame(&noisy)), || format!("frame {frame}"));
    }
    worst
}

fn resizes() -> Worst {
    let mut worst = Worst::default();
    let mut host = Painted::new(SIZE, adaptive());
    for (frame, size) in
        [SIZE, [7, 5], [1, 1], [31, 17], [1, 9], SIZE, [9, 1], [3, 3], [64, 2], [2, 2]].iter().enumerate()
    {
        host.resize(*size);
        let mut fresh = Painted::new(*size, adaptive());
        fresh.index = frame as u32;
        worst.add(difference(&host.frame(&noisy), &fresh.frame(&noisy)), || format!("frame {frame}, {size:?}"));
    }
    worst
}

fn disoccluded() -> Worst {
    let mut worst = Worst::default();
    let kinds: [(&str, f32, bool); 5] = [
        ("motion −10⁹", -1e9, false),
        ("motion NaN", f32::NAN, false),
        ("motion ∞", f32::INFINITY, false),
        ("motion beyond the other side", 30.0, false),
        ("another wall", 0.0, true),
    ];
    for (name, motion, turned) in kinds {
        let (mut host, mut reset) = (Painted::new(SIZE, adaptive()), Painted::new(SIZE, adaptive()));
        for frame in 0..6_u32 {
            let mut views = host.views(&noisy);
            views.motion.fill([motion, 0.0]);
            if turned && frame % 2 == 1 {
                views.depth.fill([5.0]);
                views.normal.fill([0.0, 1.0, 0.0]);
            }
            reset.denoiser.reset();
            let found = difference(&host.denoise(&views), &reset.denoise(&views));
            worst.add(found, || format!("{name}, frame {frame}"));
        }
    }
    worst
}

fn teleports() -> Worst {
    let mut worst = Worst::default();
    let stage = || {
        let card = quad([-0.5, -0.5, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], 0);
        let wall = quad([-4.0, -4.0, -1.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0], 1);
        let mut scene = scene(vec![lambert([0.2, 0.6, 0.3]), lambert([0.7; 3])], vec![card, wall]);
        scene.environment = Some(Environment::uniform([0.3; 3]));
        shine(&mut scene, LightKind::Point, [20.0; 3], f32::INFINITY, [1.0, 3.0, 2.0]);
        scene.nodes[0].movable = true;
        let mut stage = Stage::new(scene, [48, 36], Settings::adaptive());
        stage.camera = Some(Camera { eye: [0.0, 0.0, 5.0], target: [0.0; 3], ..Default::default() });
        stage
    };
    let place = |stage: &mut Stage, x: f32| {
        let (rotation, scale) = ([0.0, 0.0, 0.0, 1.0], [1.0; 3]);
        stage.scene.nodes[0].transform = Transform::Trs { translation: [x, 0.0, 0.0], rotation, scale };
    };
    for shift in [0.1, 0.5, 1.0, 3.0] {
        let [mut used, mut fresh, mut still] = [0; 3].map(|_| stage());
        [&mut fresh, &mut still].into_iter().for_each(|stage| place(stage, shift));
        let reference = reference(still);
        place(used.frames(8), shift);
        worst.add(against_a_fresh_run(used, fresh, &reference), || format!("{shift} sizes"));
    }
    worst
}

/// Builds a floor of 40 × 4 with 200 lights over it, each with a range of 1. The last is at its right end.
fn many_lights() -> Stage {
    let floor = quad([-20.0, 0.0, 2.0], [40.0, 0.0, 0.0], [0.0, 0.0, -4.0], 0);
    let mut scene = scene(vec![lambert([0.8; 3])], vec![floor]);
    for i in 0..200 {
        let x = -19.0 + 38.0 * (i / 2) as f32 / 99.0;
        shine(&mut scene, LightKind::Point, [1.0; 3], 1.0, [x, 0.5, if i % 2 == 0 { 0.5 } else { -0.5 }]);
    }
    let tracer = TracerSettings { bounces: 0, samples: 64, ..Default::default() };
    let mut stage = Stage::new(scene, [160, 16], Settings { tracer, ..Settings::adaptive() });
    let up = [0.0, 0.0, -1.0];
    stage.camera = Some(Camera { eye: [0.0, 20.0, 0.0], target: [0.0; 3], up, fov_y: 0.2, ..Default::default() });
    stage
}

fn lights() -> Worst {
    let mut worst = Worst::default();
    for (name, factors) in [("off", [1.0, 0.0]), ("on", [0.0, 1.0]), ("stronger", [1.0, 10.0])] {
        let mut stage = many_lights();
        let mut seen = 0.0_f32;
        for frame in 0..12 {
            let mut pose = stage.pose_at(0);
            pose.intensity[199] = [factors[usize::from(frame >= 8)]; 3];
            stage.frame_in(&pose);
            let lambda = stage.view(View::Lambda);
            let part = |range: std::ops::Range<usize>| {
                (0..16).flat_map(|y| lambda[160 * y..][range.clone()].iter()).fold(0.0, |m, c| f32::max(m, c[0]))
            };
            seen = seen.max(part(120..160));
            worst.add(part(0..100).into(), || format!("{name}, frame {frame}"));
        }
        assert!(seen > 0.0, "{name}: the light itself was not seen to change");
    }
    worst
}

/// Returns filters at the limits of the accepted ranges.
fn extremes() -> Vec<FilterSettings> {
    let default = FilterSettings::default;
    let classic = FilterSettings::classic;
    vec![
        default(),
        classic(),
        FilterSettings { alpha: 0.0, max_history: 32768.0, ..default() },
        FilterSettings { alpha: 1e-4, max_history: 32768.0, ..default() },
        FilterSettings { alpha: 1.0, ..default() },
        FilterSettings { alpha: 1.0, max_history: 1.0, ..classic() },
        FilterSettings { sigma_luminance: 0.0, sigma_depth: 1e-6, sigma_normal: 0.0, ..default() },
        FilterSettings { sigma_luminance: 1e6, sigma_depth: 1e6, sigma_normal: 1e6, ridge: 1e-6, ..default() },
        FilterSettings { sigma_luminance: 1e-6, ridge: 1e6, ..default() },
        FilterSettings { sigma_luminance: 0.0, sigma_depth: 1e-6, sigma_normal: 0.0, ..classic() },
        FilterSettings { sigma_luminance: 1e6, sigma_depth: 1e6, sigma_normal: 1e6, ..classic() },
        FilterSettings { iterations: 0, ..default() },
        FilterSettings { iterations: 8, kernel: Kernel::Full, feedback: true, ..default() },
        FilterSettings { gradient_gamma: 0.0, gradient_iterations: 7, ratio_iterations: 7, ..default() },
        FilterSettings { gradient_gamma: 1.0, gradient_iterations: 0, ratio_iterations: 0, ..default() },
        FilterSettings { history_power: 0.0, blend: Blend::Lambda, variance: Variance::OfSample, ..default() },
        FilterSettings { history_power: 64.0, gradient_signed: true, stops: Stops::Classic, ..default() },
    ]
}

fn settings() -> Worst {
    let mut worst = Worst::default();
    let mut host = Painted::new(SIZE, adaptive());
    // Adds a second surface at a right angle, and some sky.
    let spoil = |views: &mut super::painted::Views| {
        for i in 0..views.depth.len() {
            match i % 24 {
                0..8 => views.normal[i] = [1.0, 0.0, 0.0],
                20.. => views.depth[i] = [0.0],
                _ => {}
            }
        }
    };
    for round in 0..3 {
        for (i, filter) in extremes().into_iter().enumerate() {
            let mode = if (i + round) % 5 == 4 { [Mode::Noisy, Mode::Reference][round % 2] } else { Mode::Denoise };
            host.denoiser.set_settings(Settings { mode, ..with(filter) }).unwrap();
            for _ in 0..=round {
                let light = |path: &Path| grey(if path.frame % 7 == 3 { 0.0 } else { path.noise() });
                let mut views = host.views(&light);
                spoil(&mut views);
                worst.add(unusable(&host.denoise(&views)) as f64, || format!("round {round}, set {i}"));
            }
        }
    }
    worst
}

fn bias_of_settings() -> Worst {
    let mut worst = Worst::default();
    for (i, filter) in extremes().into_iter().enumerate() {
        let mut host = Painted::new(SIZE, with(filter));
        let mut sums = [0.0; 2];
        for frame in 0..24 {
            let views = host.views(&noisy);
            let image = host.denoise(&views);
            if frame >= 12 {
                sums[0] += crate::stability::common::statistics::mean(&image);
                sums[1] += 1.0;
            }
        }
        worst.add((sums[0] / sums[1] - 1.0).abs(), || format!("set {i}"));
    }
    worst
}

fn wrap() -> Worst {
    let mut worst = Worst::default();
    for gradient in [Gradient::Reshade, Gradient::BlinnPhong] {
        // The outlier limit is off, because a highlight drops a pixel's history when it is detected, and here no
        // history may fall.
        let filter = FilterSettings { gradient, outlier_limit: 0.0, ..Default::default() };
        let settings = Settings { filter, ..Settings::adaptive() };
        let mut stage = Stage::built_in("cornell", "static", [31, 17], settings);
        let mut before: Vec<Rgb> = Vec::new();
        for frame in 0..12_u32 {
            let pose = stage.pose_at(0);
            let index = (u32::MAX - 5).wrapping_add(frame);
            let gpu = stage.gpu;
            gpu.submit(|encoder| {
                stage.uploaded.update(&gpu.device, encoder, &pose).unwrap();
                let camera = stage.camera_in(&pose);
                let frame = Frame::new(&stage.uploaded, camera, index, &stage.target);
                stage.denoiser.render(&gpu.device, encoder, &frame)
            })
            .unwrap();
            let lengths = stage.view(View::HistoryLength);
            // Nothing changes, so no length may fall.
            let lost = lengths.iter().zip(&before).filter(|(now, then)| now[0] < then[0]).count();
            before = lengths;
            worst.add(f64::from(stage.largest(View::Lambda)).max(lost as f64), || {
                format!("{gradient:?}, number {index}")
            });
        }
    }
    worst
}
