//! What a host needs to repeat paths, see shaders/reshade.wgsl.

use super::{Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

pub(crate) fn step(features: Features) -> Step {
    let features = features.and(Features::of(&[Feature::PreviousDepth]));
    Step {
        pass: Pass::Reshade,
        features,
        grid: Grid::Strata,
        iteration: 0,
        bindings: bindings(
            features,
            [
                ("samples", Slot::Now(Image::Samples), &[]),
                ("guide_previous", Slot::Before(Image::Guide), &[]),
                ("motion", Slot::Host, &[]),
                ("previous_depth", Slot::Host, &[Feature::PreviousDepth]),
                ("repeats_out", Slot::Now(Image::Repeats), &[]),
                ("shifts_out", Slot::Now(Image::Shifts), &[]),
            ],
        ),
    }
}
