//! What a host needs to repeat paths, see shaders/reshade.wgsl.

use super::Pass;
use crate::plan::{Features, Grid, Image, Slot, Step};

pub(crate) fn step(_: Features) -> Step {
    Step {
        pass: Pass::Reshade,
        features: Features::default(),
        grid: Grid::Strata,
        iteration: 0,
        bindings: vec![
            ("samples", Slot::Now(Image::Samples)),
            ("guide_previous", Slot::Before(Image::Guide)),
            ("motion", Slot::Now(Image::Motion)),
            ("repeats_out", Slot::Now(Image::Repeats)),
        ],
    }
}
