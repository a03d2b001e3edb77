//! Errors of single pixels. Means are over all channels of the counted pixels.

use super::{Pair, mean};

/// ε in [`relative_mse`], which keeps dark pixels from deciding alone. A reference of 0.1 counts half as much as a bright
/// one.
pub const EPSILON: f64 = 0.01;

/// Root mean square error, √mean (a − b)².
pub fn rmse(pair: &Pair<'_>) -> f64 {
    mse(pair).sqrt()
}

/// Relative mean square error, mean (a − b)² / (b² + ε), with [`EPSILON`] as ε (after Rousselle et al. 2011, *Adaptive sampling
/// and reconstruction using greedy error minimization*).
pub fn relative_mse(pair: &Pair<'_>) -> f64 {
    mean(relative_squares(pair, |_| true))
}

/// Peak signal-to-noise ratio in decibels, 10·log₁₀(peak² / mean (a − b)²); infinite for an image and itself. `peak` is the
/// largest value that is displayed: 1 for colours from [`encode`](super::encode).
pub fn psnr(pair: &Pair<'_>, peak: f64) -> f64 {
    10.0 * (peak * peak / mse(pair)).log10()
}

/// Relative bias of the energy, mean (a − b) / mean b. Above 0 the image is brighter than the truth, below it is darker.
pub fn bias(pair: &Pair<'_>) -> f64 {
    mean(pair.samples(|_| true).map(|(a, b)| a - b)) / mean(pair.samples(|_| true).map(|(_, b)| b))
}

/// (a − b)² / (b² + ε) of the pixels that pass.
pub(super) fn relative_squares(pair: &Pair<'_>, passes: impl Fn(usize) -> bool) -> impl Iterator<Item = f64> {
    pair.samples(passes).map(|(a, b)| (a - b).powi(2) / (b * b + EPSILON))
}

fn mse(pair: &Pair<'_>) -> f64 {
    mean(pair.samples(|_| true).map(|(a, b)| (a - b).powi(2)))
}
