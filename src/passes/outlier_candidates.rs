//! Candidates: the samples that may be outliers, see shaders/outlier_candidates.wgsl.

use super::prelude::*;

pub(crate) static PASS: Pass = Pass {
    name: "outlier_candidates",
    source: include_str!("../../shaders/outlier_candidates.wgsl"),
    grid: Strata,
    features: &[
        shared::HOST_INPUT,
        &[knows(Still), knows(InPlace), knows(MissingSamples), knows(Steady), knows(Gloss), knows(SpecularSignal)],
    ],
    bindings: &[
        shared::SAMPLE_AND_HISTORY,
        &[
            now("motion", Image::Motion).or_host(HostMotion, HostView::Motion).unless(Still).unless(SpecularSignal),
            host("previous_depth", HostView::PreviousDepth).with(PreviousDepth).unless(Still).unless(SpecularSignal),
            now("samples", Image::Samples).with(InPlace),
            before("memory_previous", Image::OutlierMemory),
            out("candidates_out", Image::Candidates),
        ],
    ],
    traces: false,
};
