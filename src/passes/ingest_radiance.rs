//! A host's radiance taken in and demodulated, see shaders/ingest_radiance.wgsl.

use super::prelude::*;

/// The albedo of a repeated path matters only if radiance is divided by it.
pub(crate) static PASS: Pass = Pass {
    name: "ingest_radiance",
    source: include_str!("../../shaders/ingest_radiance.wgsl"),
    grid: Pixels,
    features: &[&[
        knows(Albedo),
        knows(DirectEmission),
        knows(Modulated),
        knows(Diagnostics),
        knows(Reshade),
        knows(MissingSamples),
        knows(SummedAlbedo),
        knows(SpecularSignal),
    ]],
    bindings: &[&[
        host("radiance", HostView::Radiance),
        host("albedo", HostView::Albedo).with(Albedo),
        host("reflectance", HostView::Reflectance).with(SummedAlbedo),
        host("emission", HostView::Emission).with(DirectEmission),
        now("guide", Image::Guide).of_surfaces().with(Albedo).with(Modulated),
        now("samples", Image::Samples).with(Reshade),
        before("albedo_previous", Image::Albedo).with(Reshade).with(Albedo).with(Modulated),
        out("radiance_out", Image::Radiance),
        out("albedo_out", Image::Albedo).with(Albedo),
        out("emission_out", Image::Emission).with(DirectEmission),
    ]],
    traces: false,
};
