//! Radiances of the gradient's paths, now and before, see shaders/gradient_pairs.wgsl.

use super::prelude::*;

pub(crate) static PASS: Pass = Pass {
    name: "gradient_pairs",
    source: include_str!("../../shaders/gradient_pairs.wgsl"),
    grid: Strata,
    features: &[&[knows(Pairs), knows(Outliers), knows(Gloss).with(Outliers)]],
    bindings: &[
        shared::PAIR_TAPS,
        &[out("now_out", Image::PairMomentsNow(0)), out("before_out", Image::PairMomentsBefore(0))],
    ],
    traces: false,
};
