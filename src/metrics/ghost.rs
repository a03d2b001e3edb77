//! Ghosts: remains of an image that is gone.

use super::pixelwise::relative_squares;
use super::{MetricError, Pair, luminance, mean};

/// Returns for each pixel how many frames ago its surface was last disoccluded or relit: 0 is in this frame, `u32::MAX`
/// never.
///
/// A surface is disoccluded if it has no origin. It is relit if the reference's luminance differs from that of its origin by
/// more than `threshold` of the larger of the two; choose one well above the noise of the references. `before` are the last
/// frame's ages; without them, nothing ever changed.
///
/// # Errors
/// Fails for arguments of different lengths, or an origin that does not exist.
pub fn ages(
    now: &[[f32; 3]],
    before: &[[f32; 3]],
    origins: &[Option<usize>],
    threshold: f64,
    ages: Option<&[u32]>,
) -> Result<Vec<u32>, MetricError> {
    MetricError::length("origins", origins.len(), now.len())?;
    MetricError::origins(origins, before.len())?;
    if let Some(ages) = ages {
        MetricError::length("ages", ages.len(), before.len())?;
    }
    let age = |(&color, &origin): (&[f32; 3], &Option<usize>)| {
        let Some(origin) = origin else { return 0 };
        let (level, was) = (luminance(color), luminance(before[origin]));
        let relit = (level - was).abs() > threshold * level.max(was);
        if relit { 0 } else { ages.map_or(u32::MAX, |ages| ages[origin].saturating_add(1)) }
    };
    Ok(now.iter().zip(origins).map(age).collect())
}

/// Relative mean square error, as in [`relative_mse`](super::relative_mse), over the pixels whose surface was disoccluded or
/// relit less than `frames` ago (see [`ages`]): there stale history shows as a ghost. NaN if nothing changed.
///
/// # Errors
/// Fails if the ages are for another number of pixels than the image has.
pub fn ghost_energy(pair: &Pair<'_>, ages: &[u32], frames: u32) -> Result<f64, MetricError> {
    MetricError::length("ages", ages.len(), pair.image().len())?;
    Ok(mean(relative_squares(pair, |pixel| ages[pixel] < frames)))
}
