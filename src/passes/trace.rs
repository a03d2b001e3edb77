//! Paths from the visible surfaces: demodulated radiance, albedo and emission, see shaders/trace.wgsl.

use super::prelude::*;

/// Dispatches that share a frame's paths hand their sums on; the last one writes the images.
pub(crate) static PASS: Pass = Pass {
    name: "trace",
    source: include_str!("../../shaders/trace.wgsl"),
    grid: Pixels,
    features: &[
        shared::GEOMETRY,
        &[
            knows(Specular),
            knows(Transmission),
            knows(Clearcoat),
            knows(SeeThrough),
            knows(Lights),
            knows(Emitters),
            knows(EmitterPieces),
            knows(PunctualLights),
            knows(EnvironmentLight),
            knows(DirectEmission),
            knows(LightSamplesOnly),
            knows(ScatteredRaysOnly),
            knows(Reshade),
            knows(EarlierPaths),
            knows(LaterPaths),
            knows(Gloss),
        ],
    ],
    bindings: &[&[
        now("visibility", Image::Visibility),
        before("visibility_previous", Image::Visibility).with(Reshade),
        now("samples", Image::Samples).with(Reshade),
        now("seen", Image::Seen).with(SeeThrough),
        before("seen_previous", Image::Seen).with(SeeThrough).with(Reshade),
        other_turn("paths_before", Image::Paths).with(EarlierPaths),
        turn_out("paths_out", Image::Paths).with(LaterPaths),
        other_turn("specular_paths_before", Image::SpecularPaths).with(EarlierPaths).with(Gloss),
        turn_out("specular_paths_out", Image::SpecularPaths).with(LaterPaths).with(Gloss),
        out("specular_radiance_out", Image::Radiance).of_specular().with(Gloss).unless(LaterPaths),
        out("radiance_out", Image::Radiance).unless(LaterPaths),
        out("albedo_out", Image::Albedo).unless(LaterPaths),
        out("emission_out", Image::Emission).with(DirectEmission).unless(LaterPaths),
    ]],
    traces: true,
};
