//! The pair of images that is compared.

use super::MetricError;

/// An image `a`, the reference `b` that it should have been, and the mask of the pixels that count.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'a> {
    image: &'a [[f32; 3]],
    reference: &'a [[f32; 3]],
    /// All pixels count if there is no mask.
    counted: Option<&'a [bool]>,
}

impl<'a> Pair<'a> {
    /// Pairs an image and its reference; all pixels count.
    ///
    /// # Errors
    /// Fails for images of different lengths.
    pub fn new(image: &'a [[f32; 3]], reference: &'a [[f32; 3]]) -> Result<Self, MetricError> {
        MetricError::length("reference", reference.len(), image.len())?;
        Ok(Self { image, reference, counted: None })
    }

    /// Counts only the pixels that are true in a mask: commonly those that are neither emitters nor misses, which bypass the
    /// filter.
    ///
    /// # Errors
    /// Fails for a mask of another length.
    pub fn counting(self, mask: &'a [bool]) -> Result<Self, MetricError> {
        MetricError::length("mask", mask.len(), self.image.len())?;
        Ok(Self { counted: Some(mask), ..self })
    }

    /// The image, `a`.
    pub fn image(&self) -> &'a [[f32; 3]] {
        self.image
    }

    /// The reference, `b`.
    pub fn reference(&self) -> &'a [[f32; 3]] {
        self.reference
    }

    /// Returns true if a pixel counts.
    pub fn counts(&self, pixel: usize) -> bool {
        pixel < self.image.len() && self.counted.is_none_or(|mask| mask[pixel])
    }

    /// Iterates over each counted channel of the image and the reference, of the pixels that pass.
    pub(super) fn samples(&self, passes: impl Fn(usize) -> bool) -> impl Iterator<Item = (f64, f64)> {
        let pixels = self.image.iter().zip(self.reference).enumerate();
        let counted = pixels.filter(move |&(pixel, _)| self.counts(pixel) && passes(pixel));
        counted.flat_map(|(_, (a, b))| a.iter().zip(b).map(|(&a, &b)| (f64::from(a), f64::from(b))))
    }
}
