//! One iteration of the gradient's filter, see shaders/gradient_filter.wgsl.

use super::Pass;
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

pub(crate) fn step(features: Features, iteration: u32) -> Step {
    let from = (iteration % 2) as u8;
    Step {
        pass: Pass::GradientFilter,
        features: features.and(Features::of(&[Feature::AcrossSurfaces])),
        grid: Grid::Strata,
        iteration,
        bindings: vec![
            ("samples", Slot::Now(Image::Samples)),
            ("gradient", Slot::Now(Image::Gradient(from))),
            ("gradient_out", Slot::Now(Image::Gradient(1 - from))),
        ],
    }
}
