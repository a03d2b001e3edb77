//! The last output blended in, see shaders/steady.wgsl.

use super::Pass;
use crate::plan::{Features, Grid, Image, Slot, Step};

/// `color` is where the filtered colour is.
pub(crate) fn step(_: Features, color: Image) -> Step {
    Step {
        pass: Pass::Steady,
        features: Features::default(),
        grid: Grid::Pixels,
        iteration: 0,
        bindings: vec![
            ("guide", Slot::Now(Image::Guide)),
            ("color", Slot::Now(color)),
            ("reprojected", Slot::Now(Image::Reprojected)),
            ("output_out", Slot::Now(Image::Output)),
        ],
    }
}
