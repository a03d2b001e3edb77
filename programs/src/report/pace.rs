//! Speed of a suite on this machine, from a few frames of its first sequence.

use crate::film::Film;
use crate::gpu::Gpu;
use crate::report::budget::Pace;
use crate::report::record::Row;
use crate::report::score;
use crate::report::script::Script;
use crate::report::suite::Suite;
use crate::report::truth::{Moment, Rgb, move_to};
use crate::tracing;
use asvgf::scene::GpuScene;
use asvgf::{Mode, Settings, TracerSettings};
use std::error::Error;
use std::time::Instant;

/// Frames before the first that counts, and frames that count.
const WARM_UP: u32 = 2;
const FRAMES: u32 = 3;

/// Paths per pixel of an unfiltered frame: enough for them to dominate the time.
const PATHS: u32 = 4;

pub fn measure(gpu: &Gpu, suite: &Suite) -> Result<Pace, Box<dyn Error>> {
    let tracer = TracerSettings { samples: PATHS, ..Default::default() };
    let noisy = Settings { mode: Mode::Noisy, tracer, ..Settings::adaptive() };
    let (run, filtered, image) = frame(gpu, suite, Settings::adaptive())?;
    let (_, traced, _) = frame(gpu, suite, noisy)?;
    Ok(Pace { run, filtered, path: traced / f64::from(PATHS), scored: scored(suite, image)? })
}

/// Measures the seconds until the first counted frame, less those of the frames before it, and the seconds of a frame.
/// Both are wall time, as a budget is. Returns the last frame's image too.
fn frame(gpu: &Gpu, suite: &Suite, settings: Settings) -> Result<(f64, f64, Vec<Rgb>), Box<dyn Error>> {
    let script = Script::load(suite, &suite.sequences[0])?;
    let mut scene = GpuScene::new(&gpu.device, &gpu.queue, &script.stage.scene)?;
    let begun = Instant::now();
    let mut film = Film::new(gpu, suite.size, settings)?;
    let (mut start, mut image) = (begun, Vec::new());
    for i in 0..WARM_UP + FRAMES {
        if i == WARM_UP {
            start = Instant::now();
        }
        let index = suite.first() + i;
        let (pose, camera) = script.frame(index);
        move_to(gpu, &mut scene, &pose)?;
        tracing::render(&mut film, &scene, camera, index)?;
        image = gpu.read_colors(&film.target);
    }
    let each = start.elapsed().as_secs_f64() / f64::from(FRAMES);
    let before = (start - begun).as_secs_f64() - f64::from(WARM_UP) * each;
    Ok((before.max(0.0), each, image))
}

/// Measures the seconds of scoring a frame: compares an image with itself, and with the frame before, which is the
/// same.
fn scored(suite: &Suite, image: Vec<Rgb>) -> Result<f64, Box<dyn Error>> {
    let script = Script::load(suite, &suite.sequences[0])?;
    let moment = || {
        let (index, pixels) = (suite.first(), image.len());
        let (pose, camera) = script.frame(index);
        let steady = (0..pixels).map(Some).collect();
        let (counted, ages) = (vec![true; pixels], vec![u32::MAX; pixels]);
        Moment { index, pose, camera, reference: image.clone(), half: image.clone(), counted, steady, ages }
    };
    let frames = FRAMES as usize;
    let moments: Vec<Moment> = (0..frames).map(|_| moment()).collect();
    let (images, mut rows) = (vec![image.clone(); frames], vec![Row::default(); frames]);
    let start = Instant::now();
    score::fill(&mut rows, &images, &moments, suite.size)?;
    Ok(start.elapsed().as_secs_f64() / f64::from(FRAMES))
}
