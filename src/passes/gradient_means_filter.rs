//! One level of the means' pyramid, see shaders/gradient_means_filter.wgsl.

use super::Pass;
use crate::plan::{Features, Grid, Image, Slot, Step};

/// From this level to the next.
pub(crate) fn step(_: Features, level: u8) -> Step {
    Step {
        pass: Pass::GradientMeansFilter,
        features: Features::default(),
        grid: Grid::Strata,
        iteration: level.into(),
        bindings: vec![
            ("samples", Slot::Now(Image::Samples)),
            ("now", Slot::Now(Image::MeansNow(level))),
            ("before", Slot::Now(Image::MeansBefore(level))),
            ("now_out", Slot::Now(Image::MeansNow(level + 1))),
            ("before_out", Slot::Now(Image::MeansBefore(level + 1))),
        ],
    }
}
