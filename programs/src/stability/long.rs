//! Runs that take minutes: only the program has them, not the test.

use crate::stability::cases::furnace::{self, Furnace, ROUNDING};
use crate::stability::cases::painted::{Path, grey};
use crate::stability::cases::{Breaks, Case, Worst, dynamics, mirrors, unusable};
use crate::stability::common::gpu::gpu;
use crate::stability::common::images::{colors, upload};
use crate::stability::common::stage::Stage;
use crate::stability::common::statistics::{Rgb, mean};
use asvgf::scene::Mesh;
use asvgf::{Camera, Denoiser, DenoiserDescriptor, Mode, Settings, Shading, Surfaces, TracerSettings, View};
use wgpu::TextureFormat;

pub const CASES: &[Case] = &[
    Case {
        name: "many triangles at one point",
        varied: "10⁴ triangles of no area and of little, beside a plane",
        quantity: "largest difference of a pixel from 1",
        bound: ROUNDING,
        origin: "a plane of albedo ½ under a white sky",
        measure: heap,
        breaks: Breaks::Known("none: more than 1000 equal boxes get a tree of medians, as obvhs takes n² steps for n"),
    },
    Case {
        name: "10 000 frames of a shaking camera",
        varied: "shifts of up to a pixel and jitter of half a pixel, another in each frame; 16×12",
        quantity: "pixels that cannot be shown, or relative difference of the last 1000 frames' mean from the reference's",
        bound: 0.02,
        origin: "the reference shakes in the same way; the filter and resampling have a bias",
        measure: shaking,
        breaks: Breaks::Known("shifts of many pixels are motion: see the error tables of the report"),
    },
    Case {
        name: "100 000 frames of one wall",
        varied: "histories of 64 and 32 768 frames; noise of a cycle of 97 images; 48×32",
        quantity: "largest relative difference of the mean over the last 970 frames from the cycle's mean",
        bound: 1e-3,
        origin: "rounding 13 bits at random is right on average: a pixel of n frames strays by 10⁻⁴ √(n/2), the mean of 1536 by 3.3·10⁻⁴; three \
            times that is 10⁻³; a stalled f16 average would be 2.5 % short at a weight of 0.01",
        measure: one_wall,
        breaks: Breaks::Known("a single pixel strays by 1.3 % at n = 32 768"),
    },
    Case {
        name: "100 000 traced frames",
        varied: "the Cornell box, still, 8×8, default settings",
        quantity: "largest λ, pixels that cannot be shown, or relative difference of the mean from the reference's in percent",
        bound: 1.0,
        origin: "a still image has no gradient; the reference has 16 384 paths per pixel, and the filter's bias is within 1 %",
        measure: traced,
        breaks: Breaks::Never("history lengths end at `max_history`, frame numbers wrap"),
    },
    Case { name: "100 000 frames of a still mirror", measure: || mirrors::drift_within(100_000), ..mirrors::STILL },
];

/// Images of the cycle: a prime, so that it does not beat with the nine places of a stratum.
const CYCLE: u32 = 97;

fn one_wall() -> Worst {
    let mut worst = Worst::default();
    let size = [48, 32];
    let pixels = size[0] * size[1];
    let gpu = gpu();
    let path = |pixel: u32, seed: u32| Path { pixel: [pixel % size[0], pixel / size[0]], seed, frame: 0 };
    let images: Vec<Vec<Rgb>> =
        (0..CYCLE).map(|seed| (0..pixels).map(|pixel| grey(path(pixel, seed).noise())).collect()).collect();
    let truth = images.iter().map(|image| mean(image)).sum::<f64>() / f64::from(CYCLE);
    let views: Vec<_> = images.iter().map(|image| upload(gpu, size, image)).collect();
    let depth = upload(gpu, size, &vec![[2.0]; pixels as usize]);
    let normal = upload(gpu, size, &vec![[0.0, 0.0, 1.0]; pixels as usize]);
    let motion = upload(gpu, size, &vec![[0.0; 2]; pixels as usize]);
    for history in [64.0, 32768.0] {
        let descriptor = DenoiserDescriptor { size, settings: dynamics::plain(history), ..Default::default() };
        let mut denoiser = Denoiser::new(&gpu.device, &gpu.queue, &descriptor).unwrap();
        let target = gpu.target(size, TextureFormat::Rgba32Float);
        let mut late = Vec::new();
        for index in 0..100_000_u32 {
            gpu.submit(|encoder| {
                let surfaces = Surfaces::new(Camera::default(), index, &depth, &normal, &motion);
                denoiser.begin_frame(&gpu.device, encoder, &surfaces).unwrap();
                let shading = Shading::new(&views[(index % CYCLE) as usize], &target);
                denoiser.denoise(&gpu.device, encoder, &shading).unwrap();
            });
            if index % 64 == 0 {
                gpu.wait();
            }
            if index >= 100_000 - 970 {
                late.push(mean(&colors(gpu, &target)));
            }
        }
        let found = late.iter().sum::<f64>() / late.len() as f64;
        worst.add((found / truth - 1.0).abs(), || format!("{history} frames: {found:.6} for {truth:.6}"));
    }
    worst
}

/// Returns a stage of the Cornell box, and the same stage as a reference.
fn cornell(size: [u32; 2], samples: u32) -> [Stage; 2] {
    let tracer = TracerSettings { samples, seed: 7, ..Default::default() };
    let reference = Settings { mode: Mode::Reference, tracer, ..Settings::adaptive() };
    [Settings::adaptive(), reference].map(|settings| Stage::built_in("cornell", "static", size, settings))
}

fn traced() -> Worst {
    let mut worst = Worst::default();
    let [mut stage, mut reference] = cornell([8, 8], 64);
    let truth = mean(&reference.frames(256).image());
    let mut late = 0.0;
    for frame in 0..100_000 {
        stage.frame();
        if frame % 1000 == 0 {
            let value = f64::from(stage.largest(View::Lambda)).max(unusable(&stage.image()) as f64);
            worst.add(value, || format!("frame {frame}"));
        }
        if frame >= 99_000 {
            late += mean(&stage.image()) / 1000.0;
        }
    }
    worst.add((late / truth - 1.0).abs() / 0.01, || format!("mean {late:.5} for {truth:.5}"));
    worst
}

fn shaking() -> Worst {
    let mut worst = Worst::default();
    let [mut stage, mut reference] = cornell([16, 12], 8);
    let still = stage.camera_in(&stage.pose_at(0));
    let camera = |frame: u32| {
        let random = |draw| {
            let path = Path { pixel: [0; 2], seed: frame, frame };
            (path.uniform(draw) - 0.5) as f32
        };
        // A pixel is about a twelfth of the field of view wide, here 0.2 m at the box.
        let mut camera = Camera { jitter: [random(0), random(1)], ..still };
        camera.eye[0] += 0.2 * f64::from(random(2));
        camera.eye[1] += 0.2 * f64::from(random(3));
        camera
    };
    let (mut late, mut truth) = (0.0, 0.0);
    for frame in 0..10_000 {
        stage.camera = Some(camera(frame));
        let image = stage.frame().image();
        if frame % 100 == 0 {
            worst.add(unusable(&image) as f64, || format!("frame {frame}"));
        }
        if frame >= 9_000 {
            reference.camera = Some(camera(frame));
            late += mean(&image);
            truth += mean(&reference.frame().image());
        }
    }
    worst.add((late / truth - 1.0).abs(), || format!("mean {:.5} for {:.5}", late / 1000.0, truth / 1000.0));
    worst
}

fn heap() -> Worst {
    let mut worst = Worst::default();
    let mut furnace = Furnace::new([32, 24]);
    let plane = crate::stability::common::scenes::quad([-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], 0);
    for (name, side) in [("no area", 0.0), ("little area", 1e-4)] {
        let positions = vec![[0.0, 0.0, 0.5], [side, 0.0, 0.5], [0.0, side, 0.5]];
        let heap = Mesh { positions, triangles: vec![[0, 1, 2]; 10_000], ..Default::default() };
        let camera = |_| Camera { eye: [0.5, 0.2, 3.0], target: [0.0; 3], ..Default::default() };
        worst.add(furnace.farthest_seen(furnace::grey(vec![plane.clone(), heap]), 2, camera), || name.into());
    }
    worst
}
