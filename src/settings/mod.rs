//! What can be set, with what a higher and a lower value cost.
//!
//! A setting is one block in `filter.rs` or `tracer.rs`. Its range, presets, documentation and place in lists follow from it.

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

/// The most iterations that any filter with steps of 1, 2, 4 … can be set to.
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

/// Everything that can be set. All of it may change between two frames; what changes the compiled shaders says so.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// What the target shows. Changing it compiles.
    pub mode: Mode,
    /// How the noise is filtered.
    pub filter: FilterSettings,
    /// How paths are traced.
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

    /// The same filter with a constant α: no temporal gradient, a history that fades as `(1 − α)ⁿ` whatever happens. An α below
    /// 1/32768 acts as that: no history is longer. With 0, the history is as long as [`FilterSettings::max_history`] allows.
    pub fn constant(self, alpha: f32) -> Self {
        // As many samples as such an average is worth, (2 − α)/α.
        let worth = if alpha > 0.0 { (2.0 / alpha - 1.0).min(LONGEST_HISTORY) } else { 0.0 };
        let max_history = self.filter.max_history.max(worth);
        // Nobody says where the light has changed: the last output would stay there, too.
        let filter = FilterSettings { gradient: Gradient::Off, alpha, max_history, steadiness: 0.0, ..self.filter };
        Self { filter, ..self }
    }

    /// Checks every setting's range.
    ///
    /// # Errors
    /// [`Error::Setting`] for the first that is outside.
    pub fn check(&self) -> Result<(), Error> {
        Setting::all().try_for_each(|setting| setting.check(self))
    }
}

/// What the target shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Mode {
    /// The filtered image.
    #[default]
    Denoise,
    /// The path tracer's samples as they are.
    Noisy,
    /// The mean of all frames since the last restart or change of scene, camera or `TracerSettings`, in f32: converges to the
    /// truth. Samples that are missing do not count.
    Reference,
}
