//! Reprojection of the history and its blending with the new sample, see shaders/temporal.wgsl.

use super::prelude::*;

/// The plan names the image that holds the filtered gradient.
pub(crate) static PASS: Pass = Pass {
    name: "temporal",
    source: include_str!("../../shaders/temporal.wgsl"),
    grid: Pixels,
    features: &[
        shared::HOST_INPUT,
        &[
            knows(Objects).unless(Still),
            knows(Still),
            knows(Gradient),
            knows(AcrossSurfaces),
            knows(InPlace),
            knows(HistoryRatio),
            knows(ExternalLambda),
            knows(Confidence),
            knows(BlendByLambda),
            knows(Feedback),
            knows(MissingSamples),
            knows(Steady),
            knows(Outliers),
            knows(Gloss).with(Outliers),
            knows(Diagnostics).with(Outliers),
            knows(KeepWeights),
            knows(SpecularSignal),
            knows(MixedGloss).unless(Still),
        ],
    ],
    bindings: &[
        shared::SAMPLE_AND_HISTORY,
        shared::SAME_SURFACE,
        shared::AGREEMENT,
        &[
            now("samples", Image::Samples).with(Gradient),
            chosen("gradient").with(Gradient),
            now("ratio", Image::Ratio).with(HistoryRatio),
            host("external_lambda", HostView::Lambda).with(ExternalLambda),
            now("gloss", Image::Gloss).with(MixedGloss),
            now("limit", Image::OutlierLimit).with(Outliers),
            out("feedback_out", Image::Feedback).with(Feedback),
            out("reprojected_out", Image::Reprojected).with(Steady),
            out("history_out", Image::History),
            out("weights_out", Image::Weights).with(KeepWeights),
        ],
    ],
    traces: false,
};
