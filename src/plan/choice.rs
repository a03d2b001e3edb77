//! Which features a frame's settings and traits ask for.

#[cfg(feature = "path-tracer")]
use super::Traits;
use super::{Feature, Features, HostTraits};
use crate::settings::{self, Blend, FilterSettings, Kernel, Mode, Settings, Stops, Variance};

#[cfg(feature = "path-tracer")]
pub(super) fn traced(traits: &Traits, settings: &Settings) -> Features {
    use crate::settings::Sampling;
    use Feature::*;
    let sampling = settings.tracer.sampling;
    let lights = traits.emitters || traits.punctual_lights || traits.environment;
    let scene = [
        (Instanced, traits.instanced),
        (Objects, traits.instanced),
        (Textures, traits.textures),
        (ShadingNormals, traits.shading_normals),
        (Specular, traits.specular),
        (AlphaMask, traits.alpha_mask),
        (FewTriangles, traits.few_triangles),
        (Lights, lights),
        (Emitters, traits.emitters),
        (PunctualLights, traits.punctual_lights),
        (EnvironmentLight, traits.environment),
        (Albedo, true),
        (DirectEmission, traits.emitters || traits.environment || traits.unlit),
        (LightSamplesOnly, sampling == Sampling::Lights),
        (ScatteredRaysOnly, sampling == Sampling::Scattered),
        (Unfiltered, settings.mode != Mode::Denoise),
        (Accumulate, settings.mode == Mode::Reference),
    ];
    with_filter(&scene, settings)
}

pub(super) fn hosted(traits: &HostTraits, settings: &Settings) -> Features {
    use Feature::*;
    let denoise = settings.mode == Mode::Denoise;
    let pairs = denoise && settings.filter.gradient == settings::Gradient::Pairs;
    let lambda = denoise && settings.filter.gradient == settings::Gradient::Lambda;
    let host = [
        (OctahedralNormals, traits.octahedral_normals),
        (MappedNormals, traits.mapped_normals),
        (PackedNormals, traits.packed_normals),
        (PreviousDepth, traits.previous_depth),
        (Objects, traits.instances),
        (FloatObjects, traits.instances && traits.float_instances),
        (Albedo, traits.albedo),
        (DirectEmission, traits.emission),
        (Modulated, !traits.demodulated && (traits.albedo || traits.emission)),
        (Background, denoise),
        (LuminancePairs, pairs && traits.luminance_pairs),
        (StratumPairs, pairs && traits.stratum_pairs),
        (InPlace, pairs && traits.pairs_in_place),
        (Confidence, lambda && traits.confidence),
        (Diagnostics, traits.diagnostics),
        (Unfiltered, !denoise),
        (Accumulate, settings.mode == Mode::Reference),
    ];
    with_filter(&host, settings)
}

/// What is on in a list, and what the filter's settings ask for where there is a filter.
fn with_filter(list: &[(Feature, bool)], settings: &Settings) -> Features {
    let chosen = list.iter().filter(|(_, on)| *on).map(|(f, _)| *f);
    match settings.mode {
        Mode::Denoise => chosen.chain(filter_features(&settings.filter).iter()).collect(),
        Mode::Noisy | Mode::Reference => chosen.collect(),
    }
}

fn filter_features(filter: &FilterSettings) -> Features {
    use Feature::*;
    let source = filter.gradient;
    let reshade = source == settings::Gradient::Reshade;
    let pairs = source == settings::Gradient::Pairs;
    let strata = reshade || pairs || source == settings::Gradient::BlinnPhong;
    let spatial = filter.iterations > 0;
    [
        (Gradient, strata),
        (Reshade, reshade),
        (InPlace, reshade),
        (BlinnPhong, source == settings::Gradient::BlinnPhong),
        (Pairs, pairs),
        (SignedGradient, strata && filter.gradient_signed),
        (AcrossSurfaces, strata && filter.gradient_across_surfaces),
        (ExternalLambda, source == settings::Gradient::Lambda),
        // An analytic pair is blind to what blocks a light: its ratio would rescale shadows too.
        (HistoryRatio, (reshade || pairs) && filter.history_ratio),
        (BlendByLambda, filter.blend == Blend::Lambda),
        (TemporalOnly, !spatial),
        (Feedback, spatial && filter.feedback),
        (VarianceOfMean, filter.variance == Variance::OfMean),
        (ClassicStops, filter.stops == Stops::Classic),
        (FullKernel, filter.kernel == Kernel::Full),
        (LocalLinearFit, filter.local_linear_fit),
    ]
    .into_iter()
    .filter(|(_, on)| *on)
    .map(|(f, _)| f)
    .collect()
}
