//! Blend of two estimates of a frame: one from its past, one from its future.
//!
//! Each estimate is an average of n or m samples, its history length: the weights n/(n + m) and m/(n + m) give the
//! least variance (Gauss). That is right as long as both estimates have the same light. Failure: a lamp that dimmed
//! unnoticed left the past three times too bright for eight frames, and the past weighed most. Reason: a length cannot
//! show that the light has changed. Rule: this frame's own samples s around a pixel decide. Each votes v = (f − b)(s −
//! (f + b)/2), which compares its distances to the past f and to the future b, as in the likelihood ratio of two normal
//! distributions of one variance (Neyman and Pearson 1933). The odds of the weights are n/m·exp(z|z|/2) with z =
//! Σv/√Σv², the votes over their expected size by chance: a single bright sample is one vote, whatever its brightness.
//! Samples that are already part of an estimate favour it anyway: the factor (1 − 1/n)(1 − 1/m) discounts them.

use crate::denoise::parallel;
use crate::sequence::Pixels;
use crate::sequence::layers::Layer;

/// A frame's estimate from a run in one direction of time.
pub struct Estimate {
    pub image: Vec<[f32; 3]>,
    /// History lengths, in samples.
    pub lengths: Vec<f32>,
}

impl Estimate {
    /// Mixes another estimate in, by per-pixel weights.
    pub fn mix(&mut self, other: &Self, weights: &[f32]) {
        for (i, &weight) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
            let (here, there) = (self.image[i], other.image[i]);
            self.image[i] = std::array::from_fn(|c| here[c] + weight * (there[c] - here[c]));
            self.lengths[i] += weight * (other.lengths[i] - self.lengths[i]);
        }
    }
}

/// Pixels to each side of each of two box sums: together they are a tent of 9×9.
const AROUND: usize = 2;

/// √(N/W) of that tent: its weights sum to W = 625, and N = 625²/85² pixels of equal weight would have its noise.
const VOICES: f32 = 0.294;

/// Largest logarithm of the odds from the samples: e⁴ = 55 to 1.
const MOST: f32 = 4.0;

/// Blends the future of a frame into its past.
pub fn blend(now: &mut Estimate, later: &Estimate, pixels: &Pixels, size: [u32; 2]) {
    let evidence = evidence(now, later, pixels, size.map(|side| side as usize));
    let lengths = now.lengths.iter().zip(&later.lengths).zip(&evidence);
    for ((here, there), ((n, m), evidence)) in now.image.iter_mut().zip(&later.image).zip(lengths) {
        // If neither has an average, both are the sample itself.
        let weight = match (*n > 0.0, *m > 0.0) {
            (true, true) => 1.0 / (1.0 + n / m * evidence.exp()),
            (false, true) => 1.0,
            _ => 0.0,
        };
        if weight > 0.0 {
            *here = std::array::from_fn(|c| here[c] + weight * (there[c] - here[c]));
        }
    }
}

/// Returns z|z|/2 of each pixel: above 0 if the samples around favour the past.
fn evidence(now: &Estimate, later: &Estimate, pixels: &Pixels, size: [usize; 2]) -> Vec<f32> {
    let count = size[0] * size[1];
    let get = |layer| Pixels::get(pixels, layer);
    let (color, depth) = (get(Layer::Color).unwrap_or_default(), get(Layer::Depth).unwrap_or_default());
    let light = |color: [f32; 3], i: usize| {
        let emitted = get(Layer::Emission).map_or(0.0, |e| luminance([e[3 * i], e[3 * i + 1], e[3 * i + 2]]));
        // Divides by the albedo, as the denoiser does.
        let albedo = get(Layer::Albedo).map_or(1.0, |a| {
            luminance(
                [a[3 * i], a[3 * i + 1], a[3 * i + 2]].map(|x| if x.is_finite() { x.clamp(0.02, 1.0) } else { 1.0 }),
            )
        });
        (luminance(color) - emitted).max(0.0) / albedo
    };
    let vote = |i: usize| {
        let (f, b) = (light(now.image[i], i), light(later.image[i], i));
        let s = light([color[3 * i], color[3 * i + 1], color[3 * i + 2]], i);
        let vote = (f - b) * (s - 0.5 * (f + b));
        if depth[i] > 0.0 && vote.is_finite() { [vote, vote * vote] } else { [0.0; 2] }
    };
    let mut sums = parallel::map(count, vote);
    for (length, step) in [(size[0], 1), (size[1], size[0])] {
        sums = box_sums(&box_sums(&sums, length, step), length, step);
    }
    let of_pixel = |(i, [votes, squares]): (usize, [f32; 2])| {
        let z = VOICES * votes / squares.sqrt().max(1e-30);
        let own = |length: f32| (1.0 - 1.0 / length.max(1.0)).max(0.0);
        (0.5 * z * z.abs() * own(now.lengths[i]) * own(later.lengths[i])).clamp(-MOST, MOST)
    };
    sums.into_iter().enumerate().map(of_pixel).collect()
}

/// Sums each value and its neighbours along lines of a length; the values of a line lie a step apart.
fn box_sums(values: &[[f32; 2]], length: usize, step: usize) -> Vec<[f32; 2]> {
    let sum = |i: usize| {
        let at = i / step % length;
        let start = i - at * step;
        let near = at.saturating_sub(AROUND)..=(at + AROUND).min(length - 1);
        near.fold([0.0; 2], |sum, k| {
            let value = values[start + k * step];
            std::array::from_fn(|c| sum[c] + value[c])
        })
    };
    parallel::map(values.len(), sum)
}

fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}
