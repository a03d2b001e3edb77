//! The cases, by group. The program `stability` and the test of that name share them.

pub mod deformation;
pub mod dynamics;
pub mod events;
pub mod furnace;
pub mod geometry;
pub mod glass;
pub mod gloss;
pub mod hostile;
pub mod limits;
pub mod mirrors;
pub mod outliers;
pub mod painted;
pub mod radiance;
pub mod samples;
pub mod shapes;

use crate::stability::common::statistics::Rgb;

/// One row of the table.
pub struct Case {
    pub name: &'static str,
    /// The varied quantity, and its range.
    pub varied: &'static str,
    /// The measured quantity.
    pub quantity: &'static str,
    /// Largest allowed value.
    pub bound: f64,
    /// Derivation of the bound.
    pub origin: &'static str,
    pub measure: fn() -> Worst,
    pub breaks: Breaks,
}

/// Point from which on a bound no longer holds.
pub enum Breaks {
    /// Nowhere in the accepted range, for this reason.
    Never(&'static str),
    /// Outside of the range above, for this reason.
    Known(&'static str),
    /// A search finds it.
    Found(fn() -> String),
}

/// A value and its name.
pub type Named<T> = (&'static str, T);

/// The worst of several measurements.
#[derive(Clone, Debug, Default)]
pub struct Worst {
    pub value: f64,
    /// Input of the worst measurement.
    pub at: String,
    /// Number of measurements.
    pub inputs: u32,
}

impl Worst {
    /// Takes a measurement; NaN is worse than any number.
    pub fn add(&mut self, value: f64, at: impl FnOnce() -> String) {
        let value = if value.is_nan() { f64::INFINITY } else { value };
        if self.inputs == 0 || value > self.value {
            (self.value, self.at) = (value, at());
        }
        self.inputs += 1;
    }
}

/// Counts the pixels that cannot be shown.
pub fn unusable(image: &[Rgb]) -> usize {
    image.iter().filter(|c| c.iter().any(|x| !x.is_finite() || *x < 0.0)).count()
}

/// Returns the largest difference of two images.
pub fn difference(a: &[Rgb], b: &[Rgb]) -> f64 {
    assert_eq!(a.len(), b.len());
    let each = a.iter().flatten().zip(b.iter().flatten()).map(|(x, y)| f64::from((x - y).abs()));
    each.fold(0.0, |worst, d| if d.is_nan() { f64::INFINITY } else { worst.max(d) })
}
