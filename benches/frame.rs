//! Measures the cost of a frame: `cargo bench --bench frame [-- [FRAMES] [CASE]]`; CASE is a part of a case's name, as
//! printed.
//!
//! Prints the adapter and the clock, and for each case the median over the frames of each pass and the rays per second.
//! Compare only figures of one run.

use asvgf::scene::{GpuScene, builtin};
use asvgf::{FilterSettings, Settings, View};
use asvgf_programs::film::Film;
use asvgf_programs::gpu::Gpu;
use asvgf_programs::times::{Clock, median};
use asvgf_programs::tracing;
use std::collections::BTreeMap;

/// Frames before the first that counts: pipelines compile in the first frame, and histories are short in the next ones.
const WARM_UP: u32 = 5;

fn main() {
    let frames = std::env::args().skip(1).filter_map(|a| a.parse().ok()).next().unwrap_or(15);
    let gpu = Gpu::new().unwrap_or_else(|e| {
        eprintln!("{e}");
        std::process::exit(1);
    });
    println!(
        "{} ({}, {:?}), {frames} frames after {WARM_UP}, by {}",
        gpu.adapter.name,
        gpu.adapter.driver_info,
        gpu.adapter.backend,
        Clock::of(&gpu).name()
    );
    let chosen: Vec<String> =
        std::env::args().skip(1).filter(|a| a.parse::<u32>().is_err() && !a.starts_with('-')).collect();
    let runs = |case: &str| chosen.iter().all(|c| case.contains(c.as_str()));
    // The box fills a square image; filters are usually quoted for the wide one.
    for [scene, animation] in [["cornell", "static"], ["cornell", "all"], ["pillars", "static"]] {
        if runs(&format!("trace {scene}, {animation}")) {
            trace(&gpu, scene, animation, [512, 512], frames);
        }
    }
    // The lamp moves, because the denoiser skips most of the filter if nothing changes.
    for (name, scene, animation, settings) in [
        ("adaptive", "cornell", "move-light", Settings::adaptive()),
        ("constant 0.1", "cornell", "move-light", Settings::adaptive().constant(0.1)),
        ("classic", "cornell", "move-light", Settings::classic()),
        ("adaptive, still", "cornell", "static", Settings::adaptive()),
        ("two signals", "gloss", "all", Settings::adaptive()),
        ("one signal", "gloss", "all", one_signal()),
    ] {
        if runs(&format!("filter {name}")) {
            filter(&gpu, name, (scene, animation), settings, frames);
        }
    }
}

/// Measures rays per second of the tracing passes, at three bounces with light samples.
fn trace(gpu: &Gpu, scene: &str, animation: &str, size: [u32; 2], frames: u32) {
    let (times, rays) = measure(gpu, scene, animation, size, Settings::adaptive(), frames);
    let milliseconds = times["visibility"] + times["trace"];
    println!(
        "trace {scene}, {animation}, {}×{}: {:.2} M rays in {milliseconds:.1} ms = {:.1} M rays/s",
        size[0],
        size[1],
        rays / 1e6,
        rays / milliseconds / 1e3,
    );
}

/// Settings without a signal for specular light.
fn one_signal() -> Settings {
    let adaptive = Settings::adaptive();
    Settings { filter: FilterSettings { gloss: false, ..adaptive.filter }, ..adaptive }
}

/// Measures the milliseconds of all passes except tracing.
fn filter(gpu: &Gpu, name: &str, (scene, animation): (&str, &str), settings: Settings, frames: u32) {
    let size = [1280, 720];
    let (times, _) = measure(gpu, scene, animation, size, settings, frames);
    let passes: Vec<_> = times.iter().filter(|(n, _)| !["visibility", "trace"].contains(n)).collect();
    let total: f64 = passes.iter().map(|(_, ms)| *ms).sum();
    println!("filter {name}, {}×{}: {total:.1} ms", size[0], size[1]);
    for (pass, ms) in passes {
        println!("    {pass:24}{ms:8.1} ms");
    }
}

/// Returns the median milliseconds of each pass, iterations added up, and the rays of the last frame.
fn measure(
    gpu: &Gpu,
    name: &str,
    animation: &str,
    size: [u32; 2],
    settings: Settings,
    frames: u32,
) -> (BTreeMap<&'static str, f64>, f64) {
    let scene = builtin::scene(name, animation).expect("a built-in scene");
    let mut uploaded = GpuScene::new(&gpu.device, &gpu.queue, &scene).expect("it fits");
    let mut film = Film::new(gpu, size, settings).expect("a denoiser");
    let mut samples = BTreeMap::<&'static str, Vec<f64>>::new();
    for index in 0..WARM_UP + frames {
        let pose = scene.pose(Some(0), index as f32 / 30.0);
        let camera = scene.camera_node().and_then(|n| scene.camera_view(&pose, n)).expect("a camera");
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        uploaded.update(&gpu.device, &mut encoder, &pose).expect("a pose of the scene");
        gpu.queue.submit([encoder.finish()]);
        let mut times = BTreeMap::<&'static str, f64>::new();
        for (pass, ms) in tracing::render(&mut film, &uploaded, camera, index).expect("a frame") {
            *times.entry(pass).or_default() += ms;
        }
        if index >= WARM_UP {
            for (pass, ms) in times {
                samples.entry(pass).or_default().push(ms);
            }
        }
    }
    let rays = film.numbers(View::Rays).expect("a view").iter().map(|c| f64::from(c[0])).sum();
    (samples.into_iter().map(|(pass, times)| (pass, median(times))).collect(), rays)
}
