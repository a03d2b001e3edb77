//! The features of a frame, each with the reason why it is in or out.

#[cfg(feature = "path-tracer")]
use super::{Batches, SceneContents};
use super::{Changes, Decision, Feature, Features, HostInputs};
use crate::settings::{self, Blend, FilterSettings, Kernel, Mode, Settings, Stops, Variance};
use Feature::*;

/// A feature, true if it is included, and the reasons for including it and for leaving it out.
type Row = (Feature, bool, [&'static str; 2]);

#[cfg(feature = "path-tracer")]
const FEW_TRIANGLES: [&str; 2] = ["so few, on a processor, that testing each is faster", "a tree is faster"];
const OBJECTS: [&str; 2] = ["objects are told apart in time", "all surfaces count as one object"];
const UNFILTERED: [&str; 2] = ["the mode shows the samples", "the mode filters"];
const ACCUMULATE: [&str; 2] = ["the mode is the mean over frames", "the mode shows single frames"];

/// The decisions on a path-traced frame.
#[cfg(feature = "path-tracer")]
pub(super) fn traced(contents: &SceneContents, settings: &Settings, changes: Changes) -> Vec<Decision> {
    use crate::settings::Sampling;
    let sampling = settings.tracer.sampling;
    let lights = contents.emitters || contents.punctual_lights || contents.environment;
    let glows = contents.emitters || contents.environment || contents.unlit;
    let divided = Batches::of(contents, &settings.tracer).count() > 1;
    let rows = [
        (
            Instanced,
            contents.instanced,
            ["a mesh moves or repeats", "nothing moves or repeats: one tree, no placements"],
        ),
        (
            Deforming,
            contents.deforming,
            ["a mesh changes its shape", "no mesh changes its shape: the last frame has the same vertices"],
        ),
        (Objects, contents.instanced, OBJECTS),
        (
            Textures,
            contents.textures,
            ["a material has an image", "no material has an image: no coordinates, no look-up"],
        ),
        (
            FoldedImages,
            contents.textures && contents.folded_images,
            ["images are larger than a storage binding: a texture holds them", "a buffer holds the images"],
        ),
        (
            ShadingNormals,
            contents.shading_normals,
            ["a mesh has normals", "no mesh has normals: cross products of edges replace them"],
        ),
        (
            NormalMaps,
            contents.normal_maps,
            ["a material has a normal map", "no material has a normal map: no tangents"],
        ),
        (
            VertexColors,
            contents.vertex_colors,
            ["a mesh has colours at its vertices", "no mesh has colours at its vertices"],
        ),
        (Specular, contents.specular, ["a material is not purely Lambertian", "all are Lambertian: no GGX lobe"]),
        (
            Transmission,
            contents.transmission,
            ["light goes through a material", "no light goes through a material: nothing is refracted"],
        ),
        (
            Clearcoat,
            contents.clearcoat,
            ["a material has a clear coat", "no material has a clear coat: one GGX lobe at most"],
        ),
        (
            SeeThrough,
            contents.clear_glass,
            ["a glass may be clear: the filter follows what lies behind it", "no glass is clear"],
        ),
        (
            AlphaMask,
            contents.alpha_mask,
            ["a material has holes", "no material has holes: any hit will do for a shadow"],
        ),
        (AlphaBlend, contents.alpha_blend, ["a material is blended", "no material is blended"]),
        (FewTriangles, contents.few_triangles, FEW_TRIANGLES),
        (Lights, lights, ["there is light to sample", "nothing emits: no light is sampled"]),
        (Emitters, contents.emitters, ["triangles emit", "no triangle emits"]),
        (
            EmitterPieces,
            contents.emitters && contents.emitter_pieces,
            ["an emissive image is uneven: its bright pieces are sampled more", "no emissive image is uneven"],
        ),
        (PunctualLights, contents.punctual_lights, ["there are lights without area", "there is no light without area"]),
        (EnvironmentLight, contents.environment, ["the environment is not black", "the environment is black"]),
        (Albedo, true, ["light is filtered without the surfaces' textures", ""]),
        (DirectEmission, glows, ["a visible surface or the sky emits", "nothing visible emits"]),
        (LightSamplesOnly, sampling == Sampling::Lights, ["the settings say so", "scattered rays find light too"]),
        (ScatteredRaysOnly, sampling == Sampling::Scattered, ["the settings say so", "lights are sampled too"]),
        (LaterPaths, divided, ["a dispatch of all paths might be ended as hung", "one dispatch traces all paths"]),
        (
            Gloss,
            is_split(contents, settings),
            ["something shines: specular light is a signal of its own", "nothing shines, or all light is one signal"],
        ),
        (Reflectance, is_split(contents, settings), ["specular light is divided by it", "no light is divided by it"]),
        (
            Roughness,
            is_split(contents, settings),
            ["the width of reflections follows from it", "no reflection depends on it"],
        ),
        (
            HitDistance,
            is_split(contents, settings),
            ["the place of reflections follows from it", "no reflection depends on it"],
        ),
        (Unfiltered, settings.mode != Mode::Denoise, UNFILTERED),
        (Accumulate, settings.mode == Mode::Reference, ACCUMULATE),
    ];
    with_filter(&rows, settings.filter.gradient.traced(), [false, contents.views], settings, changes)
}

/// The features of the specular signal's steps in a path-traced frame, if something shines and the settings keep it apart.
#[cfg(feature = "path-tracer")]
pub(super) fn traced_gloss(contents: &SceneContents, settings: &Settings, changes: Changes) -> Option<Features> {
    is_split(contents, settings).then(|| {
        let gradient = match settings.filter.gradient {
            // Blinn–Phong shading has one highlight for all light.
            settings::Gradient::BlinnPhong => settings::Gradient::Statistics,
            asked => asked,
        };
        of_specular(traced(contents, &with_gradient(settings, gradient), changes))
    })
}

/// True if the path tracer splits its light by the lobe of the first surface.
#[cfg(feature = "path-tracer")]
fn is_split(contents: &SceneContents, settings: &Settings) -> bool {
    contents.specular && !contents.matte && settings.filter.gloss && settings.mode == Mode::Denoise
}

/// The decisions on a frame of the host's renderer.
pub(super) fn hosted(inputs: &HostInputs, settings: &Settings, changes: Changes) -> Vec<Decision> {
    let denoise = settings.mode == Mode::Denoise;
    let source = settings.filter.gradient.hosted(inputs.lambda, inputs.pairs.is_some());
    let pairs = inputs.pairs.filter(|_| denoise && source == settings::Gradient::Pairs).unwrap_or_default();
    let lambda = denoise && source == settings::Gradient::Lambda;
    let modulated = !inputs.demodulated && (inputs.albedo || inputs.emission || inputs.specular && inputs.reflectance);
    let reshade = denoise && source == settings::Gradient::Reshade;
    let [copied_motion, copied_light] = why_copies(inputs, reshade, settings.filter.feedback);
    let rows = [
        (
            OctahedralNormals,
            inputs.octahedral_normals,
            ["normals have two components", "normals have three components"],
        ),
        (MappedNormals, inputs.mapped_normals, ["normals are mapped to 0…1", "normals are signed"]),
        (PackedNormals, inputs.packed_normals, ["normals are one word", "normals have channels"]),
        (PreviousDepth, inputs.previous_depth, ["previous depths are given", "no previous depth is given"]),
        (HostMotion, copied_motion.is_none(), ["it is read in place", copied_motion.unwrap_or_default()]),
        (HostLight, copied_light.is_none(), ["it is read in place", copied_light.unwrap_or_default()]),
        (Objects, inputs.instances, OBJECTS),
        (FloatObjects, inputs.instances && inputs.float_instances, ["instances are floats", "no instance is a float"]),
        (Albedo, inputs.albedo, ["an albedo is given", "no albedo is given: textures are filtered with the light"]),
        (DirectEmission, inputs.emission, ["emission is given", "no emission is given"]),
        (Modulated, modulated, ["radiance comes with albedo and emission", "radiance is the light alone"]),
        (Background, denoise, ["misses are shown unfiltered", "everything is shown unfiltered"]),
        (LuminancePairs, pairs.luminance, ["pairs are luminances", "no pair is a luminance"]),
        (StratumPairs, pairs.per_stratum, ["there is one pair per stratum", "pairs stand in their pixels"]),
        (Confidence, lambda && inputs.confidence, ["λ is given as 1 − λ", "no confidence is given"]),
        (MissingSamples, denoise, ["a renderer's pixel may not be a number", "no history is kept"]),
        (RepeatedNoise, denoise, ["a renderer's noise may be the same in every frame", "no history is kept"]),
        (Diagnostics, inputs.diagnostics, ["cleaned input is counted", "no counts are requested"]),
        (
            Gloss,
            inputs.specular,
            ["specular light comes apart: it is a signal of its own", "all light is one radiance"],
        ),
        (
            MixedGloss,
            !inputs.specular && (inputs.roughness || inputs.reflectance),
            ["one radiance holds specular light: reflections shorten its history", "no radiance is known to be mixed"],
        ),
        (
            SummedAlbedo,
            !inputs.specular && inputs.albedo && inputs.reflectance,
            [
                "mixed light is divided by the sum of both reflectances",
                "light is divided by one reflectance, if by any",
            ],
        ),
        (Reflectance, inputs.reflectance, ["a specular reflectance is given", "no specular reflectance is given"]),
        (Roughness, inputs.roughness, ["a roughness is given", "no roughness is given"]),
        (
            RoughnessInAlpha,
            inputs.roughness_in_alpha,
            ["the roughness is a fourth channel", "no roughness is a fourth channel"],
        ),
        (HitDistance, inputs.hit_distance, ["distances to reflected things are given", "no such distance is given"]),
        (
            ReflectionMotion,
            inputs.reflection_motion,
            ["the motion of reflections is given", "no motion of reflections is given"],
        ),
        (Unfiltered, !denoise, UNFILTERED),
        (Accumulate, settings.mode == Mode::Reference, ACCUMULATE),
    ];
    with_filter(&rows, source, [pairs.in_place, inputs.views], settings, changes)
}

/// The features of the specular signal's steps in a host's frame, if it hands in specular light apart.
pub(super) fn hosted_gloss(inputs: &HostInputs, settings: &Settings, changes: Changes) -> Option<Features> {
    let inputs = inputs.specular.then(|| inputs.of_specular())?;
    let asked = settings.filter.gradient;
    let without_pairs = asked == settings::Gradient::Pairs && inputs.pairs.is_none();
    let gradient = if without_pairs { settings::Gradient::Statistics } else { asked };
    Some(of_specular(hosted(&inputs, &with_gradient(settings, gradient), changes)))
}

/// The features of the specular signal's steps that follow from decisions on it.
fn of_specular(decisions: Vec<Decision>) -> Features {
    let features: Features = decisions.iter().filter(|d| d.included).map(|d| d.feature).collect();
    features.without(DirectEmission).with(SpecularSignal)
}

fn with_gradient(settings: &Settings, gradient: settings::Gradient) -> Settings {
    Settings { filter: FilterSettings { gradient, ..settings.filter.clone() }, ..settings.clone() }
}

/// The reasons for copying a host's motion and its light, if they are copied.
fn why_copies(inputs: &HostInputs, reshade: bool, feedback: bool) -> [Option<&'static str>; 2] {
    let reasons = [
        (reshade, "a copy is kept: repeated paths need it, or the last frame's"),
        (inputs.diagnostics, "a copy is kept: cleaned input is counted once"),
        (inputs.views, "a copy is kept for views"),
    ];
    let why = reasons.into_iter().find(|(holds, _)| *holds).map(|(_, why)| why);
    let mixed = !inputs.specular && (inputs.roughness || inputs.reflectance);
    let of_light = [
        (inputs.in_target, "a copy is kept: a shader cannot read what it writes"),
        (mixed, "a copy is kept: with the gloss beside it, a shader would bind more than sixteen textures"),
        (
            inputs.specular && feedback,
            "a copy is kept: with the reflection and the fed-back colour beside it, a shader would bind more than sixteen textures",
        ),
    ];
    [why, why.or(of_light.into_iter().find(|(holds, _)| *holds).map(|(_, why)| why))]
}

/// The rows, with those of the filter if the mode filters. `given` tells if pairs stand in place, and if views are kept.
fn with_filter(
    rows: &[Row],
    source: settings::Gradient,
    given: [bool; 2],
    settings: &Settings,
    changes: Changes,
) -> Vec<Decision> {
    let filter = match settings.mode {
        Mode::Denoise => filter(&settings.filter, source, given, changes),
        Mode::Noisy | Mode::Reference => Vec::new(),
    };
    rows.iter().chain(&filter).map(|&(feature, on, reasons)| Decision::new(feature, on, reasons)).collect()
}

fn filter(
    filter: &FilterSettings,
    source: settings::Gradient,
    [pairs_in_place, views]: [bool; 2],
    changes: Changes,
) -> Vec<Row> {
    use settings::Gradient as Source;
    let strata = !matches!(source, Source::Lambda | Source::Off);
    // In an unchanged scene a repeated path finds the same light: δ is 0, and needs no measurement.
    let gradient = strata && changes.scene;
    let reshade = gradient && source == Source::Reshade;
    let pairs = gradient && source == Source::Pairs;
    let statistics = gradient && source == Source::Statistics;
    let why_not =
        if strata && !changes.scene { "nothing changed in the scene: the gradient is 0" } else { "no gradient is set" };
    let otherwise = if gradient { "the gradient has another source" } else { why_not };
    let spatial = filter.iterations > 0;
    vec![
        (
            Still,
            changes == Changes::NONE,
            ["nothing changed: no reprojection, and α = 1/n has no floor", "something may move"],
        ),
        (Unchanged, strata && !changes.scene, [why_not, "the scene may have changed"]),
        (Gradient, gradient, ["the scene may have changed", why_not]),
        (Reshade, reshade, ["the gradient repeats paths", otherwise]),
        (InPlace, reshade || pairs && pairs_in_place, ["repeated paths take a pixel's own sample's place", otherwise]),
        (BlinnPhong, gradient && source == Source::BlinnPhong, ["the gradient is that of analytic shading", otherwise]),
        (Pairs, pairs, ["the gradient comes from the host's pairs", otherwise]),
        (
            Statistics,
            statistics,
            ["the gradient is the difference of new samples and their histories, less the noise", otherwise],
        ),
        (
            SignedGradient,
            gradient && !statistics && filter.gradient_signed,
            ["differences may cancel", "differences never cancel"],
        ),
        (
            AcrossSurfaces,
            gradient && filter.gradient_across_surfaces,
            ["λ heeds nearby paths", "λ is that of the surface alone, or 0"],
        ),
        (ExternalLambda, source == Source::Lambda, ["λ is the host's", "the host gives no λ"]),
        // An analytic pair is blind to what blocks a light: its ratio would rescale shadows too.
        (
            HistoryRatio,
            (reshade || pairs || statistics) && filter.history_ratio,
            ["the history is rescaled by the paths' ratio", "the history is blended as it is"],
        ),
        (BlendByLambda, filter.blend == Blend::Lambda, ["α' = (1 − λ)·α + λ is set", "α' = 1/n is set"]),
        (
            TemporalOnly,
            !spatial,
            ["no spatial iteration is set: no variance, no taps", "the settings filter in space too"],
        ),
        (
            Feedback,
            spatial && filter.feedback,
            ["the first iteration feeds the history", "the history stays unfiltered"],
        ),
        (
            VarianceOfMean,
            filter.variance == Variance::OfMean,
            ["the mean's variance is set", "a sample's variance is set"],
        ),
        (
            ClassicStops,
            filter.stops == Stops::Classic,
            ["published edge stops are set", "noise-subtracted stops are set"],
        ),
        (FullKernel, filter.kernel == Kernel::Full, ["25 taps are set", "13 taps are set"]),
        (KeepWeights, views, ["α and λ are kept for views", "no views are requested: α and λ are not kept"]),
        (LocalLinearFit, filter.local_linear_fit, ["a plane is fitted to the taps", "taps are averaged"]),
        (
            RidgeByNoise,
            filter.local_linear_fit && filter.ridge_noise > 0.0,
            [
                "the plane follows a slope as far as it exceeds the noise",
                "the plane's ridge is constant, or there is none",
            ],
        ),
        (
            SmallKernel,
            spatial && filter.final_iteration,
            ["a last iteration over the nearest taps is set", "no last iteration is set"],
        ),
        (
            Steady,
            spatial && filter.steadiness > 0.0,
            ["the last output steadies this one", "no steadiness is set, or nothing is filtered in space"],
        ),
        (
            Clamp,
            spatial && filter.gloss_clamp > 0.0,
            ["lone spots of specular light are clamped before the spatial filter", "no clamp is set"],
        ),
        (
            Outliers,
            filter.outlier_limit > 0.0,
            ["a sample far above its surroundings loses weight", "no limit of outliers is set"],
        ),
    ]
}
