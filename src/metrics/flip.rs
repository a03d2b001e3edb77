//! ꟻLIP, through NVIDIA's own program.

use super::{MetricError, Pair, mean};
use nv_flip::{FlipImageFloat, FlipImageRgb8};

/// Default resolution of an eye that sees a display, in pixels per degree: 0.7 m away from a 0.7 m wide one with 3840 pixels.
pub const PIXELS_PER_DEGREE: f32 = nv_flip::DEFAULT_PIXELS_PER_DEGREE;

/// The differences that an eye sees when it flips between two images.
#[derive(Clone, Debug, PartialEq)]
pub struct Flip {
    /// Difference of each pixel, 0…1.
    pub map: Vec<f32>,
    /// Mean over the pixels that count.
    pub mean: f64,
    size: [u32; 2],
}

impl Flip {
    /// Returns the map in the colours of its authors, from black over purple to light yellow (magma).
    pub fn picture(&self) -> Vec<[u8; 4]> {
        let map = FlipImageFloat::with_data(self.size[0], self.size[1], &self.map);
        let colors = map.apply_color_lut(&nv_flip::magma_lut()).to_vec();
        colors.as_chunks::<3>().0.iter().map(|&[r, g, b]| [r, g, b, 255]).collect()
    }
}

/// LDR-ꟻLIP of two images as displays show them (see [`encode`](super::encode)), rounded to 8 bits (Andersson et al. 2020, *ꟻLIP: a
/// difference evaluator for alternating images*).
///
/// # Errors
/// Fails for an image of another size than is said, or without pixels.
pub fn flip(pair: &Pair<'_>, size: [u32; 2], pixels_per_degree: f32) -> Result<Flip, MetricError> {
    MetricError::size(size, pair.image().len())?;
    let [width, height] = size;
    if pair.image().is_empty() {
        return Err(MetricError::TooSmall { width, height, least: 1 });
    }
    let rounded = |colors: &[[f32; 3]]| {
        let bytes: Vec<u8> = colors.as_flattened().iter().map(|x| (x.clamp(0.0, 1.0) * 255.0).round() as u8).collect();
        FlipImageRgb8::with_data(width, height, &bytes)
    };
    let map = nv_flip::flip(rounded(pair.reference()), rounded(pair.image()), pixels_per_degree).to_vec();
    let counted = map.iter().enumerate().filter(|&(pixel, _)| pair.counts(pixel));
    let mean = mean(counted.map(|(_, &difference)| f64::from(difference)));
    Ok(Flip { mean, map, size })
}
