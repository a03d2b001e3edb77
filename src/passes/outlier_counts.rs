//! Strata with candidates in a row, see shaders/outlier_counts.wgsl.

use super::Pass;
use crate::plan::{Features, Grid, Image, Slot, Step};

pub(crate) fn step() -> Step {
    Step {
        pass: Pass::OutlierCounts,
        features: Features::default(),
        grid: Grid::Strata,
        iteration: 0,
        bindings: vec![
            ("candidates", Slot::Now(Image::Candidates)),
            ("counts_out", Slot::Now(Image::CandidateCounts)),
            ("sums_out", Slot::Now(Image::CandidateSums)),
        ],
    }
}
