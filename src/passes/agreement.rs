//! The better place of the history, the reflection's or the surface's, see shaders/agreement.wgsl.

use super::prelude::*;

/// Only the specular signal has this pass.
pub(crate) static PASS: Pass = Pass {
    name: "agreement",
    source: include_str!("../../shaders/agreement.wgsl"),
    grid: Strata,
    features: &[shared::HOST_INPUT, &[knows(Objects), knows(Feedback), knows(MissingSamples), knows(SpecularSignal)]],
    bindings: &[shared::SAMPLE_AND_HISTORY, shared::SAME_SURFACE, &[out("agreement_out", Image::Agreement)]],
    traces: false,
};
