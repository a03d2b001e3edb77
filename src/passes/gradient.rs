//! Gradient and history ratio of each stratum, see shaders/gradient.wgsl.

use super::{Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

const FEATURES: &[Feature] =
    &[Feature::BlinnPhong, Feature::Pairs, Feature::HistoryRatio, Feature::SignedGradient, Feature::Outliers];

/// What Blinn–Phong shading reads of the scene.
const SURFACE: &[Feature] = &[
    Feature::Instanced,
    Feature::Textures,
    Feature::FoldedImages,
    Feature::ShadingNormals,
    Feature::VertexColors,
    Feature::Specular,
];

/// `pairs` is which of the pair images the pairs' filter left its result in.
pub(crate) fn step(features: Features, pairs: u8) -> Step {
    let surface = if features.has(Feature::BlinnPhong) { SURFACE } else { &[] };
    let mut features: Features = features.and(FEATURES.iter().chain(surface).copied().collect());
    let mut all = if features.has(Feature::BlinnPhong) {
        features = features.without(Feature::Outliers);
        vec![("samples", Slot::Now(Image::Samples)), ("visibility_previous", Slot::Before(Image::Visibility))]
    } else {
        super::gradient_pairs::taps(features)
    };
    all.extend(bindings(
        features,
        [
            ("now_filtered", Slot::Now(Image::PairsNow(pairs)), &[Feature::HistoryRatio]),
            ("before_filtered", Slot::Now(Image::PairsBefore(pairs)), &[Feature::HistoryRatio]),
            ("ratio_out", Slot::Now(Image::Ratio), &[Feature::HistoryRatio]),
            ("gradient_out", Slot::Now(Image::Gradient(0)), &[]),
        ],
    ));
    Step { pass: Pass::Gradient, features, grid: Grid::Strata, iteration: 0, bindings: all }
}
