//! Settings: each documents the costs of a higher and of a lower value.
//!
//! A setting is one block in `filter.rs` or `tracer.rs`. Its range, its presets, its documentation and its place in lists
//! follow from that block.

mod declare;
mod filter;
mod setting;
#[cfg(test)]
mod tests;
#[cfg(feature = "path-tracer")]
mod tracer;

pub(crate) use filter::LONGEST_HISTORY;
pub use filter::{Blend, FilterSettings, Gradient, Kernel, Stops, Variance};
pub use setting::{Choice, Compiles, Field, Setting, SettingKind};
#[cfg(feature = "path-tracer")]
pub use tracer::{Sampling, TracerSettings};

use crate::Error;

/// The highest number of iterations that any filter with steps of 1, 2, 4 … can be set to.
pub(crate) const MOST_ITERATIONS: u32 = {
    let [mut most, gradient, ratio] =
        [filter::MOST_SPATIAL_ITERATIONS, filter::MOST_GRADIENT_ITERATIONS, filter::MOST_RATIO_ITERATIONS];
    if gradient > most {
        most = gradient;
    }
    if ratio > most {
        most = ratio;
    }
    most
};

/// A struct with the values of the published method.
trait Published {
    fn published() -> Self;
}

/// All settings. Each may change between two frames; a setting says so if its change compiles shaders.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The image that the target receives. Changing it compiles.
    pub mode: Mode,
    /// Settings of the filter.
    pub filter: FilterSettings,
    /// Settings of the path tracer.
    #[cfg(feature = "path-tracer")]
    pub tracer: TracerSettings,
}

impl Default for Settings {
    /// [`Settings::adaptive`].
    fn default() -> Self {
        Self::adaptive()
    }
}

impl Settings {
    /// The crate's own filter with an adaptive α: the default.
    pub fn adaptive() -> Self {
        Self {
            mode: Mode::Denoise,
            filter: FilterSettings::default(),
            #[cfg(feature = "path-tracer")]
            tracer: TracerSettings::default(),
        }
    }

    /// The formulas of A-SVGF as published (Schied et al. 2017 and 2018), for comparison.
    pub fn classic() -> Self {
        Self { filter: FilterSettings::classic(), ..Self::adaptive() }
    }

    /// The same filter with a constant α: no temporal gradient, and a history that fades as `(1 − α)ⁿ` whatever happens. An α below
    /// 1/32768 acts as 1/32768, because no history is longer. With 0, the history is as long as [`FilterSettings::max_history`] allows.
    pub fn constant(self, alpha: f32) -> Self {
        // Such an average is worth (2 − α)/α samples.
        let worth = if alpha > 0.0 { (2.0 / alpha - 1.0).min(LONGEST_HISTORY) } else { 0.0 };
        let max_history = self.filter.max_history.max(worth);
        // Without a gradient nothing shows where the light has changed, and the last output would stay there: no steadiness.
        let filter = FilterSettings { gradient: Gradient::Off, alpha, max_history, steadiness: 0.0, ..self.filter };
        Self { filter, ..self }
    }

    /// Checks every setting's range.
    ///
    /// # Errors
    /// [`Error::Setting`] for the first setting that is outside its range.
    pub fn check(&self) -> Result<(), Error> {
        Setting::all().try_for_each(|setting| setting.check(self))
    }
}

/// The image that the target receives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Mode {
    /// The filtered image.
    #[default]
    Denoise,
    /// The path tracer's samples, unfiltered.
    Noisy,
    /// The mean of all frames since the last restart or change of scene, camera or `TracerSettings`, in f32. It converges to the
    /// truth. Missing samples do not count.
    Reference,
}
