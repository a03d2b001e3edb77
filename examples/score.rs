//! Scores a denoised sequence against its references: `cargo run --release --example score -- OUT_DIR IN_DIR`.

#[allow(dead_code, reason = "shared with `denoise`")]
#[path = "support/camera.rs"]
mod camera;
#[path = "support/layers.rs"]
mod layers;
#[path = "support/metrics.rs"]
mod metrics;
#[path = "support/sequence.rs"]
mod sequence;

use asvgf::image_io::{self, Channels};
use layers::{Layer, Names};
use metrics::Pair;
use sequence::{Pixels, Sequence};
use std::error::Error;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const HELP: &str = "\
Scores a denoised sequence against its references.

Usage: cargo run --release --example score -- OUT_DIR IN_DIR

OUT_DIR holds denoised_0000.exr, …, as `denoise` or another denoiser wrote them; IN_DIR the
frames, and beside each its converged image, reference_0000.exr, …

Over the pixels that are neither emitters nor misses, and then over the frames:
  relMSE    mean (a − b)² / (b² + 0.01)
  bias      mean (a − b) / mean b
  flicker   mean |(a − a′) − (b − b′)| / mean b, ′ for the last frame, along the motion
";

fn main() -> ExitCode {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let result = match arguments.as_slice() {
        [only] if [Path::new("-h"), Path::new("--help")].contains(&only.as_path()) => {
            say(HELP);
            Ok(())
        }
        [out, input] => score(out, input),
        _ => {
            eprintln!("error: two folders are needed, OUT_DIR and IN_DIR\n(--help says more)");
            return ExitCode::from(2);
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// What is known of a frame once it was read.
struct Frame {
    pixels: Pixels,
    image: Vec<[f32; 3]>,
    reference: Vec<[f32; 3]>,
    counted: Vec<bool>,
}

impl Frame {
    fn pair(&self) -> Pair<'_> {
        Pair { image: &self.image, reference: &self.reference, counted: &self.counted }
    }
}

fn score(out: &Path, input: &Path) -> Result<(), Box<dyn Error>> {
    let sequence = Sequence::open(input, Names::new(), |_| {})?;
    let mut scores = [const { Vec::new() }; 3];
    let mut before: Option<Frame> = None;
    for frame in sequence.first..=sequence.last {
        let now = read(&sequence, out, input, frame)?;
        scores[0].push(metrics::rel_mse(&now.pair()));
        scores[1].push(metrics::bias(&now.pair()));
        if let Some(before) = &before {
            let origins = origins(&sequence, &now, before);
            scores[2].push(metrics::flicker(&now.pair(), &before.pair(), &origins));
        }
        before = Some(now);
    }
    let [error, bias, flicker] = scores.map(|values| metrics::mean(values.into_iter()));
    let frames = sequence.last - sequence.first + 1;
    say(&format!("relMSE {error:.5}  bias {:+.2} %  flicker {flicker:.4}  ({frames} frames)\n", 100.0 * bias));
    Ok(())
}

fn read(sequence: &Sequence, out: &Path, input: &Path, frame: u32) -> Result<Frame, Box<dyn Error>> {
    let pixels = sequence.read(frame)?;
    let image = colors(sequence, &out.join(format!("denoised_{frame:04}.exr")))?;
    let reference = colors(sequence, &input.join(format!("reference_{frame:04}.exr")))?;
    let depth = pixels.get(Layer::Depth).unwrap_or_default();
    let emission = pixels.get(Layer::Emission);
    let emits = |i: usize| emission.is_some_and(|e| e[3 * i..3 * i + 3].iter().any(|&x| x > 0.0));
    let counted = depth.iter().enumerate().map(|(i, &z)| z > 0.0 && z.is_finite() && !emits(i)).collect();
    Ok(Frame { pixels, image, reference, counted })
}

/// R, G and B of a file that belongs to the sequence.
fn colors(sequence: &Sequence, path: &Path) -> Result<Vec<[f32; 3]>, Box<dyn Error>> {
    let image: Channels = image_io::read_exr(path)?;
    let ([width, height], name) = (sequence.size, path.display());
    if [image.width, image.height] != sequence.size {
        return Err(format!("{name}: is {}×{} pixels, the frames are {width}×{height}", image.width, image.height).into());
    }
    let channel = |name: &str| image.get(name).ok_or_else(|| format!("{}: there is no channel {name}", path.display()));
    let (r, g, b) = (channel("R")?, channel("G")?, channel("B")?);
    Ok((0..r.len()).map(|i| [r[i], g[i], b[i]]).collect())
}

/// For each counted pixel the one of the last frame that its motion leads to, if it is of the same object.
fn origins(sequence: &Sequence, now: &Frame, before: &Frame) -> Vec<Option<usize>> {
    let size = sequence.size.map(|s| s as usize);
    let motion = now.pixels.get(Layer::Motion);
    let ids = now.pixels.get(Layer::Id).zip(before.pixels.get(Layer::Id));
    let origin = |p: usize| {
        let offset = |axis: usize| motion.map_or(0.0, |m| m[2 * p + axis]);
        let at = |axis: usize, pixel: usize| (pixel as f32 + 0.5 + offset(axis)).floor();
        let (x, y) = (at(0, p % size[0]), at(1, p / size[0]));
        let inside = x >= 0.0 && y >= 0.0 && x < size[0] as f32 && y < size[1] as f32;
        let q = inside.then(|| y as usize * size[0] + x as usize)?;
        (now.counted[p] && ids.is_none_or(|(now, before)| now[p] == before[q])).then_some(q)
    };
    (0..now.counted.len()).map(origin).collect()
}

/// Prints; whoever reads may have seen enough, as `head` does.
fn say(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}
