//! Gradient and history ratio of each stratum, see shaders/gradient.wgsl.

use super::prelude::*;

/// The turn is the one of the pairs' filter after its last iteration. Analytic shading reads the scene instead of pairs.
pub(crate) static PASS: Pass = Pass {
    name: "gradient",
    source: include_str!("../../shaders/gradient.wgsl"),
    grid: Strata,
    features: &[&[
        knows(BlinnPhong),
        knows(Pairs),
        knows(HistoryRatio),
        knows(SignedGradient),
        knows(Outliers).unless(BlinnPhong),
        knows(Gloss).with(Outliers).unless(BlinnPhong),
        knows(Instanced).with(BlinnPhong),
        knows(Deforming).with(BlinnPhong),
        knows(Textures).with(BlinnPhong),
        knows(FoldedImages).with(BlinnPhong),
        knows(ShadingNormals).with(BlinnPhong),
        knows(NormalMaps).with(BlinnPhong),
        knows(VertexColors).with(BlinnPhong),
        knows(Specular).with(BlinnPhong),
    ]],
    bindings: &[
        shared::PAIR_TAPS,
        &[
            before("visibility_previous", Image::Visibility).with(BlinnPhong),
            turn("now_filtered", Image::PairMomentsNow).with(HistoryRatio),
            turn("before_filtered", Image::PairMomentsBefore).with(HistoryRatio),
            out("ratio_out", Image::Ratio).with(HistoryRatio),
            out("gradient_out", Image::Gradient(0)),
        ],
    ],
    traces: false,
};
