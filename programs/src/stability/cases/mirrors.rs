//! Mirrors of the path tracer's scenes.

use super::furnace::{Furnace, ROUNDING};
use super::{Breaks, Case, Worst, unusable};
use crate::stability::common::scenes::{emitter, lambert, quad, scene};
use crate::stability::common::stage::Stage;
use crate::stability::common::statistics::mean;
use asvgf::scene::{Environment, Material, Mesh, Scene};
use asvgf::{Camera, Mode, Settings, TracerSettings, View};
use std::f32::consts::PI;

pub const CASES: &[Case] = &[
    Case {
        name: "curvature of a needle",
        varied: "cylinders of 20, 5, 2, 1, 0.6 pixels in radius, bumps and dishes of 200 and 20 pixels; a camera that slides past; roughness 0",
        quantity: "difference of the farthest pixel from 1, less that of the farthest sample; infinite if no surface is seen",
        bound: ROUNDING,
        origin: "a surface that reflects all light shows 1 under a white sky, whatever its curvature does to the motion; samples at grazing angles lose some of it",
        measure: needles,
        breaks: Breaks::Found(needles_break),
    },
    Case {
        name: "mirrors that face each other",
        varied: "a lamp and a floor between two mirrors of reflectance 0.95, roughness 0, 0.1, 0.3; 0 and 8 bounces; a camera at rest, and one that slides",
        quantity: "pixels that cannot be shown, or relative difference of the mean over frames 16 to 47 from the reference's",
        bound: 0.03,
        origin: "the clamp's bias is within 3 %; the reference has 64 paths per pixel in each frame",
        measure: facing,
        breaks: Breaks::Known("a mirror in a mirror has the distance of the first bounce alone"),
    },
    Case {
        name: "600 frames of a still mirror",
        bound: 5.0,
        origin: "three standard errors: a mean of 64 pixels and 100 frames is off by 1.3 %, and the filter shows up to 64 frames before them too",
        measure: || drift_within(600),
        ..STILL
    },
];

/// The row of a still mirror, without a number of frames.
pub const STILL: Case = Case {
    name: "",
    varied: "the scene `gloss`, still, 8×8, default settings, with nothing left out",
    quantity: "pixels that cannot be shown, λ above 0, or drift: relative difference of the last and the second sixth in percent, each a mean over that of its samples",
    bound: 1.0,
    origin: "a still image has no gradient, and its mean stays",
    measure: || Worst::default(),
    breaks: Breaks::Never("history lengths end at `max_history`, frame numbers wrap"),
};

const SIZE: [u32; 2] = [48, 36];

fn metal(reflectance: f32, roughness: f32) -> Material {
    Material { metallic: 1.0, roughness, ..lambert([reflectance; 3]) }
}

/// Builds an open cylinder along y around the origin, of 48 flat sides: a ray that a smooth normal reflects into a flat side finds no
/// light.
fn cylinder(radius: f32) -> Mesh {
    const SIDES: u32 = 48;
    let around = |side: u32| (2.0 * PI * side as f32 / SIDES as f32).sin_cos();
    let sides = || 0..SIDES;
    let ring = |y: f32| sides().map(move |side| (around(side), y)).map(move |((s, c), y)| [radius * c, y, radius * s]);
    let triangles = sides().flat_map(|side| {
        let next = (side + 1) % SIDES;
        [[side, SIDES + side, next], [next, SIDES + side, SIDES + next]]
    });
    Mesh { positions: ring(-2.0).chain(ring(2.0)).collect(), triangles: triangles.collect(), ..Default::default() }
}

/// Returns a cylinder with the smooth normals of a round one.
fn smooth(radius: f32) -> Mesh {
    let flat = cylinder(radius);
    let normals = flat.positions.iter().map(|[x, _, z]| [x / radius, 0.0, z / radius]).collect();
    Mesh { normals, ..flat }
}

/// Builds a square of 2×2 with the smooth normals of a sphere of this radius: a bump, or below 0 a dish.
fn bent(radius: f32) -> Mesh {
    const CELLS: u32 = 24;
    let at = |i: u32| -1.0 + 2.0 * i as f32 / CELLS as f32;
    let places: Vec<[f32; 2]> = (0..=CELLS).flat_map(|y| (0..=CELLS).map(move |x| [at(x), at(y)])).collect();
    let height = |[x, y]: [f32; 2]| radius.signum() * ((radius * radius - x * x - y * y).sqrt() - radius.abs());
    let normal = |p: [f32; 2]| {
        let z = (radius * radius - p[0] * p[0] - p[1] * p[1]).sqrt();
        [p[0] / radius, p[1] / radius, z / radius.abs()]
    };
    let corner = |x: u32, y: u32| y * (CELLS + 1) + x;
    let cells = (0..CELLS).flat_map(|y| (0..CELLS).map(move |x| (x, y)));
    let triangles = cells.flat_map(|(x, y)| {
        let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
        [[a, b, c], [a, c, d]]
    });
    Mesh {
        positions: places.iter().map(|&p| [p[0], p[1], height(p)]).collect(),
        normals: places.iter().map(|&p| normal(p)).collect(),
        triangles: triangles.collect(),
        ..Default::default()
    }
}

/// Width of a pixel at the origin, seen by `sliding`.
fn pixel() -> f32 {
    2.0 * 4.0 * 0.4_f32.tan() / SIZE[1] as f32
}

/// A camera 4 from the origin that slides by ¾ of a pixel a frame.
fn sliding(frame: u32) -> Camera {
    let x = 0.75 * f64::from(pixel()) * (f64::from(frame) - 4.0);
    Camera { eye: [x, 0.0, 4.0], target: [x, 0.0, 0.0], fov_y: 0.8, ..Default::default() }
}

/// A mesh that reflects all light, under a white sky.
fn silver(mesh: Mesh) -> Scene {
    Scene { environment: Some(Environment::uniform([1.0; 3])), ..scene(vec![metal(1.0, 0.0)], vec![mesh]) }
}

fn needles() -> Worst {
    let mut worst = Worst::default();
    let [mut filtered, mut traced] = [Mode::Denoise, Mode::Noisy].map(|mode| Furnace::in_mode(mode, SIZE));
    let cylinders = [20.0, 5.0, 2.0, 1.0, 0.6].map(|radius| (format!("radius {radius}"), cylinder(radius * pixel())));
    let bent = [200.0, 20.0, -20.0, -200.0].map(|radius| (format!("bent by {radius}"), bent(radius * pixel())));
    for (name, mesh) in cylinders.into_iter().chain(bent) {
        let [found, of_samples] =
            [&mut filtered, &mut traced].map(|furnace| furnace.farthest_from_white(silver(mesh.clone()), 9, sliding));
        worst.add((found - of_samples).max(0.0), || format!("{name}; a sample is {of_samples:.1e} off"));
    }
    worst
}

/// Measures the misplacement of the sky in needles: its image is half a radius behind the surface, and moves as the needle does, to 0.05
/// pixels.
fn needles_break() -> String {
    let off = |pixels: f32| {
        let tracer = TracerSettings { bounces: 0, ..Default::default() };
        let mut stage = Stage::new(silver(smooth(pixels * pixel())), SIZE, Settings { tracer, ..Settings::adaptive() });
        for frame in 0..4 {
            stage.camera = Some(sliding(frame));
            stage.frame();
        }
        let [surface, reflection, gloss] =
            [View::Motion, View::ReflectionMotion, View::HitDistance].map(|view| stage.view(view));
        let seen: Vec<usize> = (0..gloss.len()).filter(|&i| gloss[i][0] > 0.0).collect();
        let apart = seen.iter().map(|&i| f64::from((surface[i][0] - reflection[i][0]).abs()));
        apart.sum::<f64>() / seen.len().max(1) as f64
    };
    let measured = [5.0, 2.0, 1.0, 0.6].map(|pixels| format!("{:.2} at a radius of {pixels}", off(pixels)));
    format!(
        "the sky in a needle moves as the needle does, but few pixels show the curvature: the reflection is misplaced by, in pixels, {}",
        measured.join(", ")
    )
}

/// Two mirrors that face each other over a floor, and a lamp between them.
fn gallery(roughness: f32) -> Scene {
    let left = quad([-1.0, -1.0, 3.0], [0.0, 0.0, -6.0], [0.0, 2.0, 0.0], 0);
    let right = quad([1.0, -1.0, -3.0], [0.0, 0.0, 6.0], [0.0, 2.0, 0.0], 0);
    let floor = quad([-1.0, -1.0, 3.0], [2.0, 0.0, 0.0], [0.0, 0.0, -6.0], 1);
    let lamp = quad([-0.4, 0.9, -1.4], [0.8, 0.0, 0.0], [0.0, 0.0, 0.8], 2);
    let materials = vec![metal(0.95, roughness), lambert([0.6; 3]), emitter([4.0; 3])];
    let environment = Some(Environment::uniform([0.3; 3]));
    Scene { environment, ..scene(materials, vec![left, right, floor, lamp]) }
}

fn facing() -> Worst {
    let mut worst = Worst::default();
    for (roughness, bounces) in [(0.0, 0), (0.0, 8), (0.1, 8), (0.3, 8)] {
        for speed in [0.0, 0.02] {
            let tracer = TracerSettings { bounces, ..Default::default() };
            let many = TracerSettings { bounces, samples: 64, seed: 7, ..Default::default() };
            let reference = Settings { mode: Mode::Reference, tracer: many, ..Settings::adaptive() };
            let filter = Settings { tracer, ..Settings::adaptive() };
            let [mut stage, mut truth] =
                [filter, reference].map(|settings| Stage::new(gallery(roughness), [24, 18], settings));
            let mut sums = [0.0; 2];
            for frame in 0..48 {
                let x = speed * f64::from(frame) - 0.5;
                let camera = Camera { eye: [x, 0.0, 2.5], target: [0.6, -0.2, 0.0], fov_y: 1.0, ..Default::default() };
                stage.camera = Some(camera);
                let image = stage.frame().image();
                worst.add(unusable(&image) as f64, || {
                    format!("roughness {roughness}, {bounces} bounces, frame {frame}")
                });
                if frame >= 16 {
                    truth.camera = Some(camera);
                    sums[0] += mean(&image);
                    sums[1] += mean(&truth.frame().image());
                }
            }
            worst.add((sums[0] / sums[1] - 1.0).abs(), || {
                format!(
                    "roughness {roughness}, {bounces} bounces, {speed} a frame: {:.4} for {:.4}",
                    sums[0] / 32.0,
                    sums[1] / 32.0
                )
            });
        }
    }
    worst
}

/// Renders frames of a still mirror, and measures what they lose or gain.
pub fn drift_within(frames: u32) -> Worst {
    let mut worst = Worst::default();
    let mut stage = Stage::built_in("gloss", "static", [8, 8], Settings::adaptive()).leaving_nothing_out();
    let sixth = frames / 6;
    // Means of the filtered and of the noisy image, so that the noise of the samples cancels.
    let mut sums = [[0.0; 2]; 2];
    for frame in 0..frames {
        stage.frame();
        if frame % (frames / 100).max(1) == 0 {
            let value = f64::from(stage.largest(View::Lambda)).max(unusable(&stage.image()) as f64);
            worst.add(if value > 0.0 { f64::INFINITY } else { 0.0 }, || format!("frame {frame}"));
        }
        let part = match frame / sixth {
            1 => &mut sums[0],
            5 => &mut sums[1],
            _ => continue,
        };
        part[0] += mean(&stage.image());
        part[1] += mean(&stage.view(View::Noisy));
    }
    let [early, late] = sums.map(|[filtered, noisy]| filtered / noisy);
    worst.add((late / early - 1.0).abs() / 0.01, || format!("{late:.4} of the samples' mean after {early:.4}"));
    worst
}
