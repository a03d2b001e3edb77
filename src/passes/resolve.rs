//! The picture put together, see shaders/resolve.wgsl.

use super::{Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

const FEATURES: &[Feature] = &[
    Feature::Unfiltered,
    Feature::TemporalOnly,
    Feature::Background,
    Feature::Albedo,
    Feature::DirectEmission,
    Feature::Accumulate,
    Feature::TargetF16,
];

/// `color` is where the filtered colour is, if anything was filtered.
pub(crate) fn step(features: Features, color: Option<Image>) -> Step {
    let features = features.and(Features::of(FEATURES));
    let mut bindings = bindings(
        features,
        [
            ("radiance", Slot::Now(Image::Radiance), &[Feature::Background]),
            ("guide", Slot::Now(Image::Guide), &[Feature::Background]),
            ("albedo", Slot::Now(Image::Albedo), &[Feature::Albedo]),
            ("emission", Slot::Now(Image::Emission), &[Feature::DirectEmission]),
            ("sum_previous", Slot::Before(Image::Sum), &[Feature::Accumulate]),
            ("sum_out", Slot::Now(Image::Sum), &[Feature::Accumulate]),
            ("target_out", Slot::Target, &[]),
        ],
    );
    bindings.push(match color {
        Some(image) => ("color", Slot::Now(image)),
        None => ("radiance", Slot::Now(Image::Radiance)),
    });
    Step { pass: Pass::Resolve, features, grid: Grid::Pixels, iteration: 0, bindings }
}
