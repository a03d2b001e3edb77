//! Flicker: apparent motion of still surfaces.

use super::{MetricError, Pair, mean};

/// Frame-to-frame change of the error along the motion, mean |(aₜ − aₜ₋₁) − (bₜ − bₜ₋₁)| / mean bₜ, over the pixels that
/// count now and have an origin (see [`origins`](super::origins)) that counted then. Leave out the origins of surfaces whose
/// light changed, because the error *should* change there.
///
/// # Errors
/// Fails for frames or origins of different lengths, or an origin that does not exist.
pub fn flicker(now: &Pair<'_>, before: &Pair<'_>, origins: &[Option<usize>]) -> Result<f64, MetricError> {
    MetricError::length("origins", origins.len(), now.image().len())?;
    MetricError::origins(origins, before.image().len())?;
    let steady = || {
        let known = origins.iter().enumerate().filter_map(|(pixel, &origin)| Some((pixel, origin?)));
        known.filter(|&(pixel, origin)| now.counts(pixel) && before.counts(origin))
    };
    let error = |pair: &Pair<'_>, pixel: usize| {
        let (a, b) = (pair.image()[pixel], pair.reference()[pixel]);
        [0, 1, 2].map(|channel| f64::from(a[channel]) - f64::from(b[channel]))
    };
    let change = steady().flat_map(|(pixel, origin)| {
        let (now, before) = (error(now, pixel), error(before, origin));
        [0, 1, 2].map(|channel| (now[channel] - before[channel]).abs())
    });
    let level = steady().flat_map(|(pixel, _)| now.reference()[pixel].map(f64::from));
    Ok(mean(change) / mean(level))
}
