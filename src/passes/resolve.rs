//! The final picture, written to the host's target, see shaders/resolve.wgsl.

use super::prelude::*;

/// The plan names the image that holds the filtered colour, if the mode filters.
pub(crate) static PASS: Pass = Pass {
    name: "resolve",
    source: include_str!("../../shaders/resolve.wgsl"),
    grid: Pixels,
    features: &[&[
        knows(Unfiltered),
        knows(TemporalOnly),
        knows(Steady),
        knows(Background),
        knows(Albedo),
        knows(DirectEmission),
        knows(Accumulate),
        knows(TargetF16),
        knows(HostLight),
        knows(Modulated).with(HostLight),
        knows(MissingSamples).with(HostLight),
        knows(Gloss),
        knows(Reflectance).with(Gloss),
    ]],
    bindings: &[&[
        chosen("color").unless(Unfiltered),
        now("radiance", Image::Radiance).or_host(HostLight, HostView::Radiance).with_any(&[Unfiltered, Background]),
        now("albedo", Image::Albedo).or_host(HostLight, HostView::Albedo).with(Albedo),
        now("emission", Image::Emission).or_host(HostLight, HostView::Emission).with(DirectEmission),
        chosen("specular_color").of_specular().with(Gloss).unless(Unfiltered),
        now("specular_radiance", Image::Radiance)
            .or_host(HostLight, HostView::Radiance)
            .of_specular()
            .with(Gloss)
            .with(Unfiltered),
        now("specular_albedo", Image::Albedo)
            .or_host(HostLight, HostView::Albedo)
            .of_specular()
            .with(Gloss)
            .with(Reflectance),
        now("guide", Image::Guide).with_any(&[HostLight, Background]),
        before("sum_previous", Image::Sum).with(Accumulate),
        out("sum_out", Image::Sum).with(Accumulate),
        target("target_out"),
    ]],
    traces: false,
};
