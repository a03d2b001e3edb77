//! A host's pairs taken in for the gradient, see shaders/ingest_pairs.wgsl.

use super::prelude::*;

/// The albedo is read only if pairs are divided by it.
pub(crate) static PASS: Pass = Pass {
    name: "ingest_pairs",
    source: include_str!("../../shaders/ingest_pairs.wgsl"),
    grid: Strata,
    features: &[&[
        knows(LuminancePairs),
        knows(StratumPairs),
        knows(Albedo),
        knows(Modulated),
        knows(HostLight).with(Albedo).with(Modulated),
        knows(Diagnostics),
    ]],
    bindings: &[&[
        now("guide", Image::Guide).of_surfaces(),
        host("current", HostView::PairNow),
        host("previous", HostView::PairBefore),
        now("albedo", Image::Albedo).or_host(HostLight, HostView::Albedo).with(Albedo).with(Modulated),
        out("samples_out", Image::Samples),
        out("pair_now_out", Image::HostPairNow),
        out("pair_before_out", Image::HostPairBefore),
    ]],
    traces: false,
};
