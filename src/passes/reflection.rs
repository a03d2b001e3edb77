//! Former places of reflections, see shaders/reflection.wgsl.

use super::prelude::*;

pub(crate) static PASS: Pass = Pass {
    name: "reflection",
    source: include_str!("../../shaders/reflection.wgsl"),
    grid: Pixels,
    features: &[&[
        knows(HostMotion).unless(Still),
        knows(PreviousDepth).with(HostMotion).unless(Still),
        knows(Objects).unless(Still),
        knows(Still),
        knows(Instanced).unless(Still),
        knows(ReflectionMotion).unless(Still),
    ]],
    bindings: &[&[
        now("guide", Image::Guide).of_first().at_many_taps(),
        now("gloss", Image::Gloss).at_many_taps(),
        now("motion", Image::Motion).of_first().or_host(HostMotion, HostView::Motion).unless(Still),
        host("previous_depth", HostView::PreviousDepth).with(PreviousDepth).unless(Still),
        now("specular_radiance", Image::Radiance).of_specular().with(Instanced),
        host("reflection_motion", HostView::ReflectionMotion).with(ReflectionMotion).unless(Still),
        before("guide_previous", Image::Guide).of_first().at_many_taps().unless(Still),
        before("object_previous", Image::Object).of_first().with(Objects).unless(Still),
        out("reflection_out", Image::Reflection),
    ]],
    traces: false,
};
