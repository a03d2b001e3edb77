//! Means of new samples and of their histories, see shaders/gradient_means.wgsl.

use super::prelude::*;

pub(crate) static PASS: Pass = Pass {
    name: "gradient_means",
    source: include_str!("../../shaders/gradient_means.wgsl"),
    grid: Strata,
    features: &[
        shared::HOST_INPUT,
        &[
            knows(Objects),
            knows(Feedback),
            knows(MissingSamples),
            knows(Outliers),
            knows(Gloss).with(Outliers),
            knows(SpecularSignal),
        ],
    ],
    bindings: &[
        shared::SAMPLE_AND_HISTORY,
        shared::SAME_SURFACE,
        shared::AGREEMENT,
        &[
            now("limit", Image::OutlierLimit).with(Outliers),
            out("samples_out", Image::Samples),
            out("now_out", Image::MeansNow(0)),
            out("before_out", Image::MeansBefore(0)),
        ],
    ],
    traces: false,
};
