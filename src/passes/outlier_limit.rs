//! The limit that separates samples from outliers, as a ratio to their level, see shaders/outlier_limit.wgsl.

use super::prelude::*;

pub(crate) static PASS: Pass = Pass {
    name: "outlier_limit",
    source: include_str!("../../shaders/outlier_limit.wgsl"),
    grid: Strata,
    features: &[],
    bindings: &[&[
        now("candidates", Image::Candidates),
        now("candidate_counts", Image::CandidateCounts),
        now("sums", Image::CandidateSums),
        out("limit_out", Image::OutlierLimit),
        out("memory_out", Image::OutlierMemory),
    ]],
    traces: false,
};
