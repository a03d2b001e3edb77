//! Speed of a suite on this machine, from a few frames of its first sequence.

use crate::film::Film;
use crate::gpu::Gpu;
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

/// Remaining work, once through.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// Runs: methods in sequences.
    pub runs: u64,
    /// Frames of methods that filter.
    pub filtered: u64,
    /// Paths per pixel of unfiltered frames: of references, and of path tracing alone.
    pub paths: u64,
    /// Frames that are compared with their references.
    pub scored: u64,
}

/// Seconds for one of each, at one size.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Fixed time of a run, for any number of pixels: the driver compiles shaders.
    pub run: f64,
    pub filtered: f64,
    pub path: f64,
    pub scored: f64,
}

impl Pace {
    /// Returns the seconds of a load at a part of the pixels: all but the fixed time of the runs is proportional to
    /// their number.
    pub fn seconds(&self, load: &Load, part: f64) -> f64 {
        let parts = [(self.filtered, load.filtered), (self.path, load.paths), (self.scored, load.scored)];
        self.run * load.runs as f64 + part * parts.map(|(seconds, count)| seconds * count as f64).iter().sum::<f64>()
    }
}

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
