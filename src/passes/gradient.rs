//! Gradient and history ratio of each stratum, see shaders/gradient.wgsl.

use super::{Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

const FEATURES: &[Feature] = &[Feature::BlinnPhong, Feature::Pairs, Feature::HistoryRatio, Feature::SignedGradient];

/// What Blinn–Phong shading reads of the scene.
const SURFACE: &[Feature] = &[Feature::Instanced, Feature::Textures, Feature::ShadingNormals, Feature::Specular];

/// `pairs` is which of the pair images the pairs' filter left its result in.
pub(crate) fn step(features: Features, pairs: u8) -> Step {
    let surface = if features.has(Feature::BlinnPhong) { SURFACE } else { &[] };
    let features = features.and(FEATURES.iter().chain(surface).copied().collect());
    let mut bindings = bindings(
        features,
        [
            ("samples", Slot::Now(Image::Samples), &[]),
            ("visibility_previous", Slot::Before(Image::Visibility), &[Feature::BlinnPhong]),
            ("now_filtered", Slot::Now(Image::PairsNow(pairs)), &[Feature::HistoryRatio]),
            ("before_filtered", Slot::Now(Image::PairsBefore(pairs)), &[Feature::HistoryRatio]),
            ("ratio_out", Slot::Now(Image::Ratio), &[Feature::HistoryRatio]),
            ("gradient_out", Slot::Now(Image::Gradient(0)), &[]),
        ],
    );
    if !features.has(Feature::BlinnPhong) {
        let [now, before] = super::gradient_pairs::sources(features);
        bindings.push(("radiance", now));
        bindings.push(("radiance_previous", before));
    }
    Step { pass: Pass::Gradient, features, grid: Grid::Strata, iteration: 0, bindings }
}
