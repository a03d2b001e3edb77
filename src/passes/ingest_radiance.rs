//! A host's radiance, demodulated, see shaders/ingest_radiance.wgsl.

use super::{Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

const FEATURES: &[Feature] = &[
    Feature::Albedo,
    Feature::DirectEmission,
    Feature::Modulated,
    Feature::Diagnostics,
    Feature::Reshade,
    Feature::MissingSamples,
];

pub(crate) fn step(features: Features) -> Step {
    use Feature::{Albedo, DirectEmission, Modulated, Reshade};
    let features = features.and(Features::of(FEATURES));
    Step {
        pass: Pass::IngestRadiance,
        features,
        grid: Grid::Pixels,
        iteration: 0,
        bindings: bindings(
            features,
            [
                ("radiance", Slot::Host, &[]),
                ("albedo", Slot::Host, &[Albedo]),
                ("emission", Slot::Host, &[DirectEmission]),
                ("guide", Slot::Now(Image::Guide), &[Albedo, Modulated]),
                ("samples", Slot::Now(Image::Samples), &[Reshade]),
                // Which albedo a repeated path has matters only where it is divided by.
                ("albedo_previous", Slot::Before(Image::Albedo), &[Reshade, Albedo, Modulated]),
                ("radiance_out", Slot::Now(Image::Radiance), &[]),
                ("albedo_out", Slot::Now(Image::Albedo), &[Albedo]),
                ("emission_out", Slot::Now(Image::Emission), &[DirectEmission]),
            ],
        ),
    }
}
