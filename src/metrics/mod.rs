//! Measures of an image's distance from the truth, and of a sequence's behaviour when the truth changes.
//!
//! A single frame has [`rmse`], [`relative_mse`], [`psnr`], [`bias`], [`ssim`], and with the feature `flip` ꟻLIP. A sequence
//! has [`flicker`], [`lag`], [`ghost_energy`]. Images are slices of linear colours, first row first. A [`Pair`] holds an
//! image `a`, its reference `b`, and the mask of the pixels that count; all of its sizes are checked once, when it is made.
//!
//! Sums are taken in `f64`. A mean over no pixels is NaN, and so is any mean over a NaN.

mod display;
mod error;
mod flicker;
#[cfg(feature = "flip")]
mod flip;
mod ghost;
mod lag;
mod motion;
mod pair;
mod pixelwise;
mod ssim;

pub use display::encode;
pub use error::MetricError;
pub use flicker::flicker;
#[cfg(feature = "flip")]
pub use flip::{Flip, PIXELS_PER_DEGREE, flip};
pub use ghost::{ages, ghost_energy};
pub use lag::{Lag, lag};
pub use motion::origins;
pub use pair::Pair;
pub use pixelwise::{EPSILON, bias, psnr, relative_mse, rmse};
pub use ssim::ssim;

/// Relative luminance of linear Rec. 709 colour (ITU-R BT.709-6).
fn luminance(color: [f32; 3]) -> f64 {
    let [r, g, b] = color.map(f64::from);
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// Mean; NaN of nothing.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_u64), |(sum, count), value| (sum + value, count + 1));
    sum / count as f64
}
