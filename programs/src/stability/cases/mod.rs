//! The cases, by group. The program `stability` and the test of that name share them.

pub mod dynamics;
pub mod events;
pub mod furnace;
pub mod geometry;
pub mod hostile;
pub mod limits;
pub mod outliers;
pub mod painted;
pub mod radiance;
pub mod samples;
pub mod shapes;

use crate::stability::common::statistics::Rgb;

/// One row of the table.
pub struct Case {
    pub name: &'static str,
    /// What is varied, over which range.
    pub varied: &'static str,
    /// What is measured.
    pub quantity: &'static str,
    /// What it may be at most.
    pub bound: f64,
    /// Where the bound comes from.
    pub origin: &'static str,
    pub measure: fn() -> Worst,
    pub breaks: Breaks,
}

/// Where a bound no longer holds.
pub enum Breaks {
    /// Nowhere in the range that is accepted, for this reason.
    Never(&'static str),
    /// Outside of the range above, for this reason.
    Known(&'static str),
    /// Where a search finds it.
    Found(fn() -> String),
}

/// Something and what to call it.
pub type Named<T> = (&'static str, T);

/// The worst of several measurements.
#[derive(Clone, Debug, Default)]
pub struct Worst {
    pub value: f64,
    /// What was put in there.
    pub at: String,
    /// How many there were.
    pub inputs: u32,
}

impl Worst {
    /// Takes a measurement; what is not a number is worse than any.
    pub fn add(&mut self, value: f64, at: impl FnOnce() -> String) {
        let value = if value.is_nan() { f64::INFINITY } else { value };
        if self.inputs == 0 || value > self.value {
            (self.value, self.at) = (value, at());
        }
        self.inputs += 1;
    }
}

/// Pixels that cannot be shown.
pub fn unusable(image: &[Rgb]) -> usize {
    image.iter().filter(|c| c.iter().any(|x| !x.is_finite() || *x < 0.0)).count()
}

/// The largest difference of two images.
pub fn difference(a: &[Rgb], b: &[Rgb]) -> f64 {
    assert_eq!(a.len(), b.len());
    let each = a.iter().flatten().zip(b.iter().flatten()).map(|(x, y)| f64::from((x - y).abs()));
    each.fold(0.0, |worst, d| if d.is_nan() { f64::INFINITY } else { worst.max(d) })
}
