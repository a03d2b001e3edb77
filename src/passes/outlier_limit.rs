//! How far above its level a sample is believed, see shaders/outlier_limit.wgsl.

use super::Pass;
use crate::plan::{Features, Grid, Image, Slot, Step};

pub(crate) fn step() -> Step {
    Step {
        pass: Pass::OutlierLimit,
        features: Features::default(),
        grid: Grid::Strata,
        iteration: 0,
        bindings: vec![
            ("candidates", Slot::Now(Image::Candidates)),
            ("candidate_counts", Slot::Now(Image::CandidateCounts)),
            ("sums", Slot::Now(Image::CandidateSums)),
            ("limit_out", Slot::Now(Image::OutlierLimit)),
        ],
    }
}
