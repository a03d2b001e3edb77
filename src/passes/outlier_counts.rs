//! Counts of the candidates in each row of strata, see shaders/outlier_counts.wgsl.

use super::prelude::*;

pub(crate) static PASS: Pass = Pass {
    name: "outlier_counts",
    source: include_str!("../../shaders/outlier_counts.wgsl"),
    grid: Strata,
    features: &[],
    bindings: &[&[
        now("candidates", Image::Candidates),
        out("counts_out", Image::CandidateCounts),
        out("sums_out", Image::CandidateSums),
    ]],
    traces: false,
};
