//! Scores of a denoised sequence in files.

use crate::sequence::layers::{self, Layer};
use crate::sequence::{Pixels, Sequence};
use asvgf::image_io::ExrFile;
use asvgf::metrics::{self, MetricError, Pair};
use std::error::Error;
use std::fmt;
use std::path::{Path, PathBuf};

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

/// Data of a frame that was read.
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

/// Scores `out/denoised_0000.exr`, … against `references/reference_0000.exr`, … for the frames of `input`. A result or
/// a reference may also have the name of its frame.
pub fn score(out: &Path, input: &Path, references: &Path) -> Result<Scores, Box<dyn Error>> {
    let sequence = Sequence::open(input, |_| {})?;
    let mut scores = [const { Vec::new() }; 3];
    let mut before: Option<Frame> = None;
    for index in 0..sequence.frames() {
        let now = read(&sequence, out, references, index)?;
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

fn read(sequence: &Sequence, out: &Path, references: &Path, index: usize) -> Result<Frame, Box<dyn Error>> {
    let pixels = sequence.read(index)?;
    let image = colors(sequence, &of_frame(sequence, out, "denoised", index)?)?;
    let reference = colors(sequence, &of_frame(sequence, references, "reference", index)?)?;
    let depth = pixels.get(Layer::Depth).unwrap_or_default();
    let emission = pixels.get(Layer::Emission);
    let emits = |i: usize| emission.is_some_and(|e| e[3 * i..3 * i + 3].iter().any(|&x| x > 0.0));
    let counted = depth.iter().enumerate().map(|(i, &z)| z > 0.0 && z < 1e9 && !emits(i)).collect();
    Ok(Frame { pixels, image, reference, counted })
}

/// Returns the file of a frame in another folder: by its number, or by its name.
fn of_frame(sequence: &Sequence, folder: &Path, kind: &str, index: usize) -> Result<PathBuf, String> {
    let file = &sequence.files[index];
    let own = file.path.file_name().unwrap_or_default();
    let numbered = folder.join(format!("{kind}_{:0>4}.exr", file.digits));
    let named = folder.join(own);
    // The frame itself is neither its result nor its reference.
    let is_other = named.exists() && named.canonicalize().ok() != file.path.canonicalize().ok();
    match () {
        () if numbered.exists() => Ok(numbered),
        () if is_other => Ok(named),
        () => Err(format!("{}: is missing, and so is {}", numbered.display(), own.display())),
    }
}

/// Returns the colours of a file that belongs to the sequence, over its window.
fn colors(sequence: &Sequence, path: &Path) -> Result<Vec<[f32; 3]>, Box<dyn Error>> {
    let file = ExrFile::read(path)?;
    let (image, window) = (file.channels(), file.data_window());
    let fits = window.union(sequence.window) == sequence.window;
    if !fits {
        let ([w, h], [width, height], name) = (window.size, sequence.size, path.display());
        return Err(format!("{name}: is {w}×{h} pixels, the frames are {width}×{height}").into());
    }
    let places = layers::find(&Vec::new(), None, &image).map_err(|e| format!("{}: {e}", path.display()))?;
    let color = places.get(Layer::Color).map(|place| place.channels.clone()).unwrap_or_default();
    let placed: Vec<Vec<f32>> =
        color.into_iter().map(|c| window.place(&image.channels[c].1, sequence.window, 0.0)).collect();
    Ok((0..placed[0].len()).map(|i| [placed[0][i], placed[1][i], placed[2][i]]).collect())
}

/// Returns, for each counted pixel, the pixel of the last frame at the end of its motion, if it shows the same object.
fn origins(sequence: &Sequence, now: &Frame, before: &Frame) -> Result<Vec<Option<usize>>, MetricError> {
    let pixels = now.counted.len();
    let motion = now.pixels.get(Layer::Motion).map_or_else(|| vec![[0.0; 2]; pixels], |m| m.as_chunks().0.to_vec());
    let ids = now.pixels.get(Layer::Id).zip(before.pixels.get(Layer::Id));
    let same = |p: usize, q: usize| now.counted[p] && ids.is_none_or(|(now, before)| now[p] == before[q]);
    metrics::origins(sequence.size, &motion, same)
}
