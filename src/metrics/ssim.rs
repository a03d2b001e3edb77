//! Structural similarity.

use super::{MetricError, Pair, luminance, mean};

/// Reach of the window: 11 pixels in each direction.
const RADIUS: usize = 5;
/// Standard deviation of the window's weights, in pixels.
const SIGMA: f64 = 1.5;
/// Constants that keep the quotients from 0/0: (K₁·L)² and (K₂·L)² with K₁ = 0.01, K₂ = 0.03 and a range L of 1.
const C1: f64 = 1e-4;
const C2: f64 = 9e-4;

/// Mean structural similarity of two images as displays show them (see [`encode`](super::encode)), 1 if they are equal (Wang,
/// Bovik, Sheikh and Simoncelli 2004, *Image quality assessment: from error visibility to structural similarity*):
///
/// (2·μₐ·μ_b + C₁)·(2·σₐ_b + C₂) / ((μₐ² + μ_b² + C₁)·(σₐ² + σ_b² + C₂)),
///
/// with means μ and covariances σ of Rec. 709 luma in an 11×11 Gaussian window of 1.5 pixels. Only windows inside the image
/// whose centre counts are taken, as in the authors' own program.
///
/// # Errors
/// Fails for an image of another size than is said, or smaller than the window.
pub fn ssim(pair: &Pair<'_>, size: [u32; 2]) -> Result<f64, MetricError> {
    MetricError::size(size, pair.image().len())?;
    let [width, height] = size;
    let least = 2 * RADIUS as u32 + 1;
    if width < least || height < least {
        return Err(MetricError::TooSmall { width, height, least });
    }
    let size = size.map(|side| side as usize);
    let a: Vec<f64> = pair.image().iter().map(|&color| luminance(color)).collect();
    let b: Vec<f64> = pair.reference().iter().map(|&color| luminance(color)).collect();
    let product = |x: &[f64], y: &[f64]| -> Vec<f64> { x.iter().zip(y).map(|(x, y)| x * y).collect() };
    let [mean_a, mean_b] = [&a, &b].map(|plane| blurred(plane, size));
    let [aa, bb, ab] = [product(&a, &a), product(&b, &b), product(&a, &b)].map(|plane| blurred(&plane, size));
    let similarity = |i: usize| {
        let (ma, mb) = (mean_a[i], mean_b[i]);
        let (va, vb, covariance) = (aa[i] - ma * ma, bb[i] - mb * mb, ab[i] - ma * mb);
        let alike = (2.0 * ma * mb + C1) * (2.0 * covariance + C2);
        alike / ((ma * ma + mb * mb + C1) * (va + vb + C2))
    };
    let inner = size.map(|side| side - 2 * RADIUS);
    let centre = |i: usize| (i / inner[0] + RADIUS) * size[0] + i % inner[0] + RADIUS;
    Ok(mean((0..inner[0] * inner[1]).filter(|&i| pair.counts(centre(i))).map(similarity)))
}

/// Returns the weighted means in all windows that lie inside the image, which is smaller by twice the reach.
fn blurred(plane: &[f64], [width, height]: [usize; 2]) -> Vec<f64> {
    let weights = weights();
    let window = |taps: &mut dyn Iterator<Item = f64>| taps.zip(weights).map(|(tap, weight)| tap * weight).sum::<f64>();
    let inner = [width - 2 * RADIUS, height - 2 * RADIUS];
    let rows: Vec<f64> = plane
        .chunks_exact(width)
        .flat_map(|row| row.windows(weights.len()).map(|taps| window(&mut taps.iter().copied())))
        .collect();
    let below = |i: usize| rows[i..].iter().step_by(inner[0]).copied();
    (0..inner[0] * inner[1]).map(|i| window(&mut below(i))).collect()
}

/// One direction of the Gaussian, with a sum of 1.
fn weights() -> [f64; 2 * RADIUS + 1] {
    let bell: [f64; 2 * RADIUS + 1] =
        std::array::from_fn(|i| (-(i as f64 - RADIUS as f64).powi(2) / (2.0 * SIGMA * SIGMA)).exp());
    let sum: f64 = bell.iter().sum();
    bell.map(|weight| weight / sum)
}
