//! The mean is the same for any number of paths and any depth of the trees.

use super::channel;
use crate::common::scenes::{emitter, lambert, quad, scene};
use crate::common::stage::Stage;
use crate::common::statistics::{Estimate, Rgb};
use asvgf::scene::{Mesh, Scene, builtin};
use asvgf::{Mode, Settings, TracerSettings, View};

const SIZE: [u32; 2] = [12, 8];

/// Images of a scene with `samples` paths per pixel, and the number of dispatches that traced each.
fn images(scene: &Scene, samples: u32, count: u32) -> (Vec<Vec<Rgb>>, usize, Stage) {
    let tracer = TracerSettings { samples, ..Default::default() };
    let mut stage = Stage::new(scene.clone(), SIZE, Settings { mode: Mode::Noisy, tracer, ..Settings::adaptive() });
    let pose = scene.pose(None, 0.0);
    let images = (0..count).map(|_| stage.frame_in(&pose).image()).collect();
    let traces = stage.denoiser.plan().unwrap().steps.iter().filter(|step| step.pass.name() == "trace").count();
    (images, traces, stage)
}

/// Asserts that the mean of many paths is the mean of one.
fn assert_mean(scene: &Scene, most: &[u32], what: &str) {
    let (one, ..) = images(scene, 1, 128);
    let expected = channel(&one, 1);
    let mut rays_of_a_path = None;
    for &samples in most {
        let (found, dispatches, mut stage) = images(scene, samples, 4);
        let mean = channel(&found, 1);
        let error = expected.error / f64::from(samples).sqrt();
        println!("{what}, {samples} paths in {dispatches} dispatches: {mean:?}, of one {expected:?}");
        // Four images are too few for an estimate of their own error.
        Estimate { error, ..mean }.assert_agrees(expected, 1e-3, &format!("{what}, {samples} paths"));
        let pixels = f64::from(SIZE[0] * SIZE[1]);
        let rays = stage.view(View::Rays).iter().map(|r| f64::from(r[0])).sum::<f64>();
        let each = (rays - pixels) / f64::from(samples);
        let off = each / *rays_of_a_path.get_or_insert(each) - 1.0;
        assert!(off.abs() < 0.05, "{what}, {samples} paths: rays are {off:+.3} off");
    }
}

#[test]
fn a_thousand_paths_have_the_mean_of_one() {
    let pillars = builtin::scene("pillars", "static").unwrap();
    assert_mean(&pillars, &[16, 128, 1024], "pillars");
    let (_, dispatches, _) = images(&pillars, 1024, 1);
    assert!(dispatches > 1, "they were traced in one dispatch");
    assert_mean(&builtin::scene("cornell", "all").unwrap(), &[16, 1024], "cornell");
}

/// A lamp over a floor of a million triangles, bumpy enough that rays pass many of them.
fn million() -> Scene {
    let side = 708;
    let at = |x: usize, y: usize| {
        let [u, v] = [x, y].map(|i| i as f32 / side as f32);
        let height = 0.05 * ((40.0 * u).sin() * (37.0 * v).cos() + 0.3 * (311.0 * u + 173.0 * v).sin());
        [4.0 * u - 2.0, height, 2.0 - 4.0 * v]
    };
    let index = |x: usize, y: usize| (y * (side + 1) + x) as u32;
    let floor = Mesh {
        positions: (0..=side).flat_map(|y| (0..=side).map(move |x| at(x, y))).collect(),
        triangles: (0..side)
            .flat_map(|y| {
                (0..side).flat_map(move |x| {
                    let [a, b, c, d] = [index(x, y), index(x + 1, y), index(x + 1, y + 1), index(x, y + 1)];
                    [[a, b, c], [a, c, d]]
                })
            })
            .collect(),
        material: 0,
        ..Default::default()
    };
    let lamp = quad([-0.5, 2.0, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], 1);
    scene(vec![lambert([0.7; 3]), emitter([8.0; 3])], vec![floor, lamp])
}

#[test]
fn many_paths_over_a_million_triangles_have_the_mean_of_one() {
    let mut scene = million();
    assert!(scene.triangle_count() > 1_000_000);
    scene.nodes.push(asvgf::scene::Node {
        camera: Some(0),
        transform: asvgf::scene::Transform::Trs {
            translation: [0.0, 0.6, 2.6],
            rotation: [-0.15, 0.0, 0.0, 0.9887],
            scale: [1.0; 3],
        },
        ..Default::default()
    });
    scene.cameras.push(asvgf::scene::Perspective { fov_y: 0.7 });
    assert_mean(&scene, &[16, 128, 1024], "a million triangles");
}
