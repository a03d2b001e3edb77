//! Lists of features and bindings that several passes share, because their shaders import the same module of shaders/shared/.

use super::prelude::*;

/// The features of shaders that follow rays through the scene, or read what the rays have hit.
#[cfg(feature = "path-tracer")]
pub(super) const GEOMETRY: &[Known] = &[
    knows(Instanced),
    knows(Deforming),
    knows(Textures),
    knows(FoldedImages),
    knows(ShadingNormals),
    knows(NormalMaps),
    knows(VertexColors),
    knows(AlphaMask),
    knows(AlphaBlend),
    knows(FewTriangles),
];

/// The features of shaders that read a host's motion and light directly, or their copies: host_motion.wgsl, host_light.wgsl.
pub(super) const HOST_INPUT: &[Known] = &[
    knows(HostMotion).unless(Still),
    knows(PreviousDepth).with(HostMotion).unless(Still),
    knows(HostLight),
    knows(Modulated).with(HostLight),
    knows(Albedo).with(HostLight).with(Modulated),
    knows(DirectEmission).with(HostLight).with(Modulated),
];

/// A pixel's sample, and the images of the last frame: sample.wgsl, history_taps.wgsl.
pub(super) const SAMPLE_AND_HISTORY: &[Binding] = &[
    now("guide", Image::Guide).of_surfaces(),
    now("radiance", Image::Radiance).or_host(HostLight, HostView::Radiance),
    host("albedo", HostView::Albedo).with(Albedo),
    host("emission", HostView::Emission).with(DirectEmission),
    before("history_previous", Image::History).at_many_taps(),
    before("feedback_previous", Image::Feedback).with(Feedback),
    before("output_previous", Image::Output).with(Steady),
    now("reflection", Image::Reflection).with(SpecularSignal),
];

/// The evidence for the reflection's former place: specular_history.wgsl.
pub(super) const AGREEMENT: &[Binding] = &[now("agreement", Image::Agreement).with(SpecularSignal).unless(Still)];

/// The images that lead to the surface in the last frame, and tell whether it shows the same surface there: reproject.wgsl.
pub(super) const SAME_SURFACE: &[Binding] = &[
    now("motion", Image::Motion).or_host(HostMotion, HostView::Motion).unless(Still),
    host("previous_depth", HostView::PreviousDepth).with(PreviousDepth).unless(Still),
    before("guide_previous", Image::Guide).at_many_taps().unless(Still),
    now("object", Image::Object).with(Objects).unless(Still),
    before("object_previous", Image::Object).with(Objects).unless(Still),
];

/// The two radiances of a stratum's path, in the images of two frames or in those of the host's pairs, and the limits of outliers:
/// pair_taps.wgsl. Analytic shading has no paths.
pub(super) const PAIR_TAPS: &[Binding] = &[
    now("samples", Image::Samples),
    now("radiance", Image::Radiance).unless(Pairs).unless(BlinnPhong),
    now("radiance", Image::HostPairNow).with(Pairs).unless(BlinnPhong),
    before("radiance_previous", Image::Radiance).unless(Pairs).unless(BlinnPhong),
    now("radiance_previous", Image::HostPairBefore).with(Pairs).unless(BlinnPhong),
    now("limit", Image::OutlierLimit).with(Outliers),
    before("history_previous", Image::History).with(Outliers),
];
