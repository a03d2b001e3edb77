//! Glass at its limits.

use super::{Breaks, Case, Worst, unusable};
use crate::stability::common::scenes::{block, emitter, glass, lambert, quad, scene};
use crate::stability::common::stage::Stage;
use crate::stability::common::statistics::mean;
use asvgf::scene::{Environment, GpuScene, Material, Mesh, Scene};
use asvgf::{Camera, Mode, Sampling, Settings, TracerSettings};

const SIZE: [u32; 2] = [16, 12];

pub const CASES: &[Case] = &[
    Case {
        name: "clear glass under a white sky",
        varied: "plates 1, 10⁻³ and 0 thick, a pane, ten panes and ten plates in each other; indices 1, 1.0001, 1.5, 3, 10; roughness 0, 0.5, 1; seen from \
            above, at 0.5°, and from inside",
        quantity: "difference of the mean over 16 unfiltered frames from 1",
        bound: 0.045,
        origin: "each microfacet mirrors or refracts all of its light. Sky that is seen through clear glass is no part of a path's light, so the 3072 \
            paths find 0 or 1: five standard errors",
        measure: white,
        breaks: Breaks::Known("of light that meets more than 96 boundaries nothing is left"),
    },
    Case {
        name: "glass with numbers at their limits",
        varied: "absorption 0, 10⁻³⁰, 1, 10³⁰; transmission 0, 10⁻³⁰, ½, 1; index 1, 10; a plate 0 and 1 thick, open bodies, 1000 walls in each \
            other; a lamp outside and inside",
        quantity: "pixels that are not finite and ≥ 0",
        bound: 0.0,
        origin: "absorption ends at 10⁶ per unit of length, whose product with the longest ray is a number of f32",
        measure: limits,
        breaks: Breaks::Never("numbers outside of their ranges are refused by name"),
    },
];

fn pane(y: f32) -> Mesh {
    quad([-9.0, y, 9.0], [18.0, 0.0, 0.0], [0.0, 0.0, -18.0], 0)
}

fn plate(thickness: f32) -> Vec<Mesh> {
    block([-9.0, -thickness, -9.0], [9.0, 0.0, 9.0], 0)
}

/// Boxes in each other.
fn nested(count: u32) -> Vec<Mesh> {
    (0..count)
        .flat_map(|i| {
            let side = 1.0 + i as f32 / count as f32;
            block([-side, -side, -side], [side; 3], 0)
        })
        .collect()
}

fn cameras() -> [(&'static str, Camera); 3] {
    let at = |eye: [f64; 3], target: [f64; 3]| Camera { eye, target, up: [0.0, 0.5, -1.0], ..Default::default() };
    [
        ("above", at([0.2, 3.0, 0.1], [0.2, 0.0, 0.1])),
        ("at 0.5°", at([0.2, 0.026, 3.0], [0.2, 0.0, 0.0])),
        ("inside", at([0.2, -0.4, 0.1], [0.9, 0.0, -0.2])),
    ]
}

fn show(stage: &mut Stage, scene: Scene) {
    stage.uploaded = GpuScene::new(&stage.gpu.device, &stage.gpu.queue, &scene).unwrap();
    stage.scene = scene;
}

fn white() -> Worst {
    let mut worst = Worst::default();
    let tracer = TracerSettings { bounces: 0, sampling: Sampling::Scattered, ..Default::default() };
    let mut stage = Stage::new(Scene::default(), SIZE, Settings { mode: Mode::Noisy, tracer, ..Settings::adaptive() });
    let panes = || (0..10).map(|i| pane(-0.1 * i as f32)).collect();
    for index in [1.0, 1.0001, 1.5, 3.0, 10.0] {
        for roughness in [0.0, 0.5, 1.0] {
            let solid = Some([0.0; 3]);
            let shapes = [
                ("a plate", plate(1.0), solid),
                ("a thin plate", plate(1e-3), solid),
                ("a plate without thickness", plate(0.0), solid),
                ("a pane", vec![pane(0.0)], None),
                ("ten panes", panes(), None),
                ("ten plates", nested(10), solid),
            ];
            for (shape, meshes, absorption) in shapes {
                let environment = Some(Environment::uniform([1.0; 3]));
                show(&mut stage, Scene { environment, ..scene(vec![glass(index, roughness, absorption)], meshes) });
                for (place, camera) in cameras() {
                    stage.camera = Some(camera);
                    let found = (0..16).map(|_| mean(&stage.frame().image())).sum::<f64>() / 16.0;
                    worst.add((found - 1.0).abs(), || {
                        format!("{shape}, index {index}, roughness {roughness}, {place}: {found}")
                    });
                }
            }
        }
    }
    worst
}

fn limits() -> Worst {
    let mut worst = Worst::default();
    let mut stage = Stage::new(Scene::default(), SIZE, Settings::adaptive());
    let open = || block([-9.0, -1.0, -9.0], [9.0, 0.0, 9.0], 0).into_iter().take(5).collect();
    let shapes: [(&str, Vec<Mesh>); 4] =
        [("a plate", plate(1.0)), ("without thickness", plate(0.0)), ("open", open()), ("1000 walls", nested(1000))];
    for (shape, meshes) in shapes {
        for absorption in [0.0, 1e-30, 1.0, 1e30] {
            for (transmission, index) in [(0.0, 1.5), (1e-30, 1.0), (0.5, 10.0), (1.0, 1.5)] {
                let body = Material { transmission, ..glass(index, 0.1, Some([absorption, 0.0, 1.0])) };
                let mut meshes = meshes.clone();
                meshes.push(quad([-1.0, 1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], 1));
                meshes.push(quad([-0.1, -0.5, -0.1], [0.2, 0.0, 0.0], [0.0, 0.0, 0.2], 1));
                meshes.push(quad([-9.0, -2.5, 9.0], [18.0, 0.0, 0.0], [0.0, 0.0, -18.0], 2));
                let scene = scene(vec![body, emitter([9.0; 3]), lambert([0.5; 3])], meshes);
                show(&mut stage, scene);
                for (place, camera) in cameras() {
                    stage.camera = Some(camera);
                    let images = (0..2).map(|_| stage.frame().image());
                    let broken = images.map(|image| unusable(&image)).sum::<usize>();
                    worst.add(broken as f64, || format!("{shape}, {absorption}, {transmission}, {index}, {place}"));
                }
            }
        }
    }
    worst
}
