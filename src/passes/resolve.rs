//! The picture put together, see shaders/resolve.wgsl.

use super::{Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

const FEATURES: &[Feature] = &[
    Feature::Unfiltered,
    Feature::TemporalOnly,
    Feature::Steady,
    Feature::Background,
    Feature::Albedo,
    Feature::DirectEmission,
    Feature::Accumulate,
    Feature::TargetF16,
    Feature::HostLight,
];

/// `color` is where the filtered colour is, if anything was filtered.
pub(crate) fn step(features: Features, color: Option<Image>) -> Step {
    let mut known = Features::of(FEATURES);
    if features.has(Feature::HostLight) {
        known = known.with(Feature::Modulated).with(Feature::MissingSamples);
    }
    let features = features.and(known);
    // A host's own image, or its copy.
    let source = |image| if features.has(Feature::HostLight) { Slot::Host } else { Slot::Now(image) };
    let mut bindings = bindings(
        features,
        [
            ("albedo", source(Image::Albedo), &[Feature::Albedo]),
            ("emission", source(Image::Emission), &[Feature::DirectEmission]),
            ("sum_previous", Slot::Before(Image::Sum), &[Feature::Accumulate]),
            ("sum_out", Slot::Now(Image::Sum), &[Feature::Accumulate]),
            ("target_out", Slot::Target, &[]),
        ],
    );
    if features.has(Feature::HostLight) || features.has(Feature::Background) {
        bindings.push(("guide", Slot::Now(Image::Guide)));
    }
    if color.is_none() || features.has(Feature::Background) {
        bindings.push(("radiance", source(Image::Radiance)));
    }
    bindings.extend(color.map(|image| ("color", Slot::Now(image))));
    Step { pass: Pass::Resolve, features, grid: Grid::Pixels, iteration: 0, bindings }
}
