//! What lies behind clear glass is filtered as if the glass were not there.

use crate::common::scenes::{block, emitter, glass, lambert, quad, scene};
use crate::common::stage::Stage;
use crate::common::statistics::relative_mse;
use asvgf::scene::{Material, Mesh, Scene};
use asvgf::{Camera, Mode, Settings, TracerSettings, View};

const SIZE: [u32; 2] = [48, 36];

/// A chequered wall with a box before it, lit from above.
fn room() -> (Vec<Material>, Vec<Mesh>) {
    let materials = vec![lambert([0.8, 0.7, 0.6]), lambert([0.2, 0.3, 0.5]), emitter([9.0; 3])];
    let mut meshes = vec![quad([-3.0, -1.0, 3.0], [6.0, 0.0, 0.0], [0.0, 0.0, -6.0], 0)];
    for i in 0..8 {
        let left = i as f32 * 0.75 - 3.0;
        meshes.push(quad([left, -1.0, -1.0], [0.75, 0.0, 0.0], [0.0, 3.0, 0.0], i % 2));
    }
    meshes.extend(block([-0.4, -1.0, -0.6], [0.3, -0.2, 0.0], 1));
    meshes.push(quad([-0.5, 2.0, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], 2));
    (materials, meshes)
}

/// The room behind a pane that fills the picture, or behind nothing.
fn behind(pane: Option<Material>) -> Scene {
    let (mut materials, mut meshes) = room();
    if let Some(pane) = pane {
        materials.push(pane);
        meshes.push(quad([-3.0, -0.99, 1.0], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0], 3));
    }
    scene(materials, meshes)
}

/// A camera that slides along the wall.
fn camera(frame: u32) -> Camera {
    let x = 0.02 * f64::from(frame);
    Camera { eye: [x, 0.3, 3.0], target: [x, 0.0, 0.0], fov_y: 0.7, ..Default::default() }
}

fn stage(scene: Scene, mode: Mode) -> Stage {
    Stage::new(scene, SIZE, Settings { mode, ..Settings::adaptive() })
}

#[test]
fn the_filter_is_given_what_lies_behind_a_pane() {
    let mut stages = [None, Some(glass(1.5, 0.0, None))].map(|pane| stage(behind(pane), Mode::Denoise));
    for frame in 0..3 {
        let mut frames = stages.each_mut().map(|stage| {
            stage.camera = Some(camera(frame));
            stage.frame()
        });
        for view in [View::Depth, View::Normal, View::Motion] {
            let [without, with] = frames.each_mut().map(|frame| frame.view(view));
            for (pixel, (a, b)) in without.iter().zip(&with).enumerate() {
                let off = (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max);
                let size = a.iter().fold(0.0_f32, |m, x| m.max(x.abs()));
                assert!(off <= 1e-3 * size + 2e-3, "frame {frame}, pixel {pixel}, {view:?}: {a:?} and {b:?}");
            }
        }
    }
}

#[test]
fn a_lamp_behind_glass_has_no_noise() {
    for absorption in [None, Some([0.0, 0.3, 1.0])] {
        let mut meshes = vec![quad([-3.0, -3.0, -1.0], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0], 0)];
        match absorption {
            None => meshes.push(quad([-3.0, -3.0, 1.0], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0], 1)),
            Some(_) => meshes.extend(block([-3.0, -3.0, 0.5], [3.0, 3.0, 1.0], 1)),
        }
        let mut stage = stage(scene(vec![emitter([2.0; 3]), glass(1.5, 0.0, absorption)], meshes), Mode::Denoise);
        stage.camera = Some(Camera { fov_y: 0.02, ..camera(0) });
        let emission = stage.frame().view(View::Emission);
        // Boundaries mirror 4 % each; the view at 0.1 rad makes ways a two-hundredth longer.
        for (i, sigma) in absorption.unwrap_or_default().into_iter().enumerate() {
            let boundaries = if absorption.is_some() { 2 } else { 1 };
            let expected = 2.0 * 0.96_f32.powi(boundaries) * (-0.5 * sigma).exp();
            for color in &emission {
                assert!((color[i] / expected - 1.0).abs() < 0.01, "{absorption:?}: {color:?}, not {expected}");
            }
        }
    }
}

#[test]
fn a_moving_camera_loses_nothing_behind_a_pane() {
    // Clear glass that mirrors nothing changes no light, so it must not change the error.
    let mut truth = stage(behind(None), Mode::Reference);
    truth.camera = Some(camera(12));
    let reference = (0..512).map(|_| truth.frame().image()).last().unwrap();
    let error = |pane: Option<Material>| {
        let of_seed = |seed| {
            let tracer = TracerSettings { seed, ..Default::default() };
            let mut filtered = Stage::new(behind(pane.clone()), SIZE, Settings { tracer, ..Settings::adaptive() });
            for frame in 0..12 {
                filtered.camera = Some(camera(frame));
                filtered.frame();
            }
            filtered.camera = Some(camera(12));
            relative_mse(&filtered.frame().image(), &reference)
        };
        (0..6).map(of_seed).sum::<f64>() / 6.0
    };
    let [without, with] = [None, Some(glass(1.0, 0.0, None))].map(error);
    println!("error without a pane {without:.5}, behind one {with:.5}");
    assert!(with <= 1.2 * without, "{with} behind a pane, {without} without one");
}
