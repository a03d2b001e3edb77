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

pub(crate) fn step(features: Features) -> Step {
    let features = features.and(GEOMETRY.iter().chain(FEATURES).copied().collect());
    Step {
        pass: Pass::Trace,
        features,
        grid: Grid::Pixels,
        iteration: 0,
        bindings: bindings(
            features,
            [
                ("visibility", Slot::Now(Image::Visibility), &[]),
                ("visibility_previous", Slot::Before(Image::Visibility), &[Feature::Reshade]),
                ("samples", Slot::Now(Image::Samples), &[Feature::Reshade]),
                ("radiance_out", Slot::Now(Image::Radiance), &[]),
                ("albedo_out", Slot::Now(Image::Albedo), &[]),
                ("emission_out", Slot::Now(Image::Emission), &[Feature::DirectEmission]),
            ],
        ),
    }
}
