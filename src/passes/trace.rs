//! Paths from the visible surfaces, see shaders/trace.wgsl.

use super::{GEOMETRY, Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

const FEATURES: &[Feature] = &[
    Feature::Specular,
    Feature::Lights,
    Feature::Emitters,
    Feature::PunctualLights,
    Feature::EnvironmentLight,
    Feature::DirectEmission,
    Feature::LightSamplesOnly,
    Feature::ScatteredRaysOnly,
    Feature::Reshade,
];

/// One of several dispatches that share the paths.
pub(crate) fn step(features: Features, batch: u32, batches: u32) -> Step {
    use Feature::{DirectEmission, EarlierPaths, LaterPaths, Reshade};
    let mut features = features.and(GEOMETRY.iter().chain(FEATURES).copied().collect());
    if batch > 0 {
        features = features.with(EarlierPaths);
    }
    let last = batch + 1 == batches;
    if !last {
        features = features.with(LaterPaths);
    }
    let turn = (batch % 2) as u8;
    let mut bindings = bindings(
        features,
        [
            ("visibility", Slot::Now(Image::Visibility), &[]),
            ("visibility_previous", Slot::Before(Image::Visibility), &[Reshade]),
            ("samples", Slot::Now(Image::Samples), &[Reshade]),
            ("paths_before", Slot::Now(Image::Paths(1 - turn)), &[EarlierPaths]),
            ("paths_out", Slot::Now(Image::Paths(turn)), &[LaterPaths]),
        ],
    );
    if last {
        bindings.push(("radiance_out", Slot::Now(Image::Radiance)));
        bindings.push(("albedo_out", Slot::Now(Image::Albedo)));
        bindings.extend(features.has(DirectEmission).then_some(("emission_out", Slot::Now(Image::Emission))));
    }
    Step { pass: Pass::Trace, features, grid: Grid::Pixels, iteration: batch, bindings }
}
