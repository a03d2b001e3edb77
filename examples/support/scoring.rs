//! The scores of a denoised sequence that lies in files.

use crate::layers::{Layer, Names};
use crate::sequence::{Pixels, Sequence};
use asvgf::image_io::{self, Channels};
use asvgf::metrics::{self, MetricError, Pair};
use std::error::Error;
use std::fmt;
use std::path::Path;

/// Means over the frames.
#[derive(Clone, Copy, Debug)]
pub struct Scores {
    pub rel_mse: f64,
    pub bias: f64,
    pub flicker: f64,
    pub frames: usize,
}

impl fmt::Display for Scores {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rel_mse, bias, flicker, frames } = self;
        write!(f, "relMSE {rel_mse:.5}  bias {:+.2} %  flicker {flicker:.4}  ({frames} frames)", 100.0 * bias)
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
    fn pair(&self) -> Result<Pair<'_>, MetricError> {
        Pair::new(&self.image, &self.reference)?.counting(&self.counted)
    }
}

/// Scores `out/denoised_0000.exr`, … against `input/reference_0000.exr`, …
pub fn score(out: &Path, input: &Path) -> Result<Scores, Box<dyn Error>> {
    let sequence = Sequence::open(input, Names::new(), None, |_| {})?;
    let mut scores = [const { Vec::new() }; 3];
    let mut before: Option<Frame> = None;
    for frame in sequence.first..=sequence.last {
        let now = read(&sequence, out, input, frame)?;
        scores[0].push(metrics::relative_mse(&now.pair()?));
        scores[1].push(metrics::bias(&now.pair()?));
        if let Some(before) = &before {
            let origins = origins(&sequence, &now, before)?;
            scores[2].push(metrics::flicker(&now.pair()?, &before.pair()?, &origins)?);
        }
        before = Some(now);
    }
    let frames = scores[0].len();
    let [rel_mse, bias, flicker] = scores.map(|values| values.iter().sum::<f64>() / values.len().max(1) as f64);
    Ok(Scores { rel_mse, bias, flicker, frames })
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
        return Err(
            format!("{name}: is {}×{} pixels, the frames are {width}×{height}", image.width, image.height).into()
        );
    }
    let channel = |name: &str| image.get(name).ok_or_else(|| format!("{}: there is no channel {name}", path.display()));
    let (r, g, b) = (channel("R")?, channel("G")?, channel("B")?);
    Ok((0..r.len()).map(|i| [r[i], g[i], b[i]]).collect())
}

/// For each counted pixel the one of the last frame that its motion leads to, if it is of the same object.
fn origins(sequence: &Sequence, now: &Frame, before: &Frame) -> Result<Vec<Option<usize>>, MetricError> {
    let pixels = now.counted.len();
    let motion = now.pixels.get(Layer::Motion).map_or_else(|| vec![[0.0; 2]; pixels], |m| m.as_chunks().0.to_vec());
    let ids = now.pixels.get(Layer::Id).zip(before.pixels.get(Layer::Id));
    let same = |p: usize, q: usize| now.counted[p] && ids.is_none_or(|(now, before)| now[p] == before[q]);
    metrics::origins(sequence.size, &motion, same)
}
