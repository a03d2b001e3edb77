//! Gradient and history ratio from means, see shaders/gradient_of_means.wgsl.

use super::{Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

/// The coarsest level that is looked at: a mean over as many samples as 2100 strata have.
pub(crate) const COARSEST: u8 = 5;

pub(crate) fn step(features: Features) -> Step {
    let features = features.and(Features::of(&[Feature::HistoryRatio]));
    Step {
        pass: Pass::GradientOfMeans,
        features,
        grid: Grid::Strata,
        iteration: 0,
        bindings: bindings(
            features,
            [
                ("samples", Slot::Now(Image::Samples), &[]),
                ("now_coarse", Slot::Now(Image::MeansNow(COARSEST)), &[]),
                ("before_coarse", Slot::Now(Image::MeansBefore(COARSEST)), &[]),
                ("now_middle", Slot::Now(Image::MeansNow(COARSEST - 1)), &[]),
                ("before_middle", Slot::Now(Image::MeansBefore(COARSEST - 1)), &[]),
                ("now_fine", Slot::Now(Image::MeansNow(COARSEST - 2)), &[]),
                ("before_fine", Slot::Now(Image::MeansBefore(COARSEST - 2)), &[]),
                ("ratio_out", Slot::Now(Image::Ratio), &[Feature::HistoryRatio]),
                ("gradient_out", Slot::Now(Image::Gradient(0)), &[]),
            ],
        ),
    }
}
