//! The time that a change of light takes to arrive.

use super::{MetricError, luminance};

/// Settling times of pixels, in frames, as a distribution.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lag {
    /// Frames of the pixels that arrived, in ascending order; 0 is at once.
    pub frames: Vec<u32>,
    /// Number of pixels that had not arrived by the last frame.
    pub never: usize,
}

impl Lag {
    /// Returns the frames within which a share of the pixels, 0…1, arrived; `None` if fewer ever did, or if there were no
    /// pixels.
    pub fn quantile(&self, share: f64) -> Option<u32> {
        let count = self.frames.len() + self.never;
        let rank = (share.clamp(0.0, 1.0) * count as f64).ceil() as usize;
        self.frames.get(rank.max(1) - 1).copied()
    }

    /// Returns the share of the pixels that arrived at all; NaN if there were none.
    pub fn arrived(&self) -> f64 {
        self.frames.len() as f64 / (self.frames.len() + self.never) as f64
    }
}

/// Returns the settling time of each pixel after a step of its light: the first frame from which on the luminance stays
/// within `band` of the step around its new level, |l − l_new| ≤ band·|l_new − l_old|. This is the definition of control
/// engineering; customary bands are 0.1 and 0.02. `frames[0]` is the first image after the step, `old` and `new` are
/// references before and after it.
///
/// Only pixels whose step is more than `least` of the larger level count. Noise counts as well: an image that is noisier than
/// the band never settles.
///
/// # Errors
/// Fails for images of different lengths.
pub fn lag(
    old: &[[f32; 3]],
    new: &[[f32; 3]],
    frames: &[impl AsRef<[[f32; 3]]>],
    band: f64,
    least: f64,
) -> Result<Lag, MetricError> {
    MetricError::length("old", old.len(), new.len())?;
    for frame in frames {
        MetricError::length("frames", frame.as_ref().len(), new.len())?;
    }
    let mut lag = Lag::default();
    for (pixel, (&old, &new)) in old.iter().zip(new).enumerate() {
        let (old, new) = (luminance(old), luminance(new));
        let step = (new - old).abs();
        if step <= least * old.max(new) {
            continue;
        }
        let within = |frame: &[[f32; 3]]| (luminance(frame[pixel]) - new).abs() <= band * step;
        let settled = frames.iter().rev().take_while(|frame| within(frame.as_ref())).count();
        match settled {
            0 => lag.never += 1,
            _ => lag.frames.push((frames.len() - settled) as u32),
        }
    }
    lag.frames.sort_unstable();
    Ok(lag)
}
