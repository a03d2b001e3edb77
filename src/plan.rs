//! What to run and why, as plain data: a pure function of the settings and of what a scene, or a host's views, have.
//!
//! The plan lists the passes in order, each with the features that are compiled into its shader and the images that it reads
//! and writes. [`Denoiser`](crate::Denoiser) only carries it out.

use crate::passes::{self, Pass};
use crate::settings::{self, Blend, FilterSettings, Kernel, Mode, Settings, Stops, Variance};
use std::collections::BTreeSet;
use std::fmt;
use wgpu::TextureFormat;

/// What a scene has. Everything that is absent is left out of the shaders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Traits {
    /// Meshes move or repeat: two levels of trees.
    pub instanced: bool,
    /// Materials have textures.
    pub textures: bool,
    /// Meshes have interpolated normals.
    pub shading_normals: bool,
    /// Some surface is not purely Lambertian.
    pub specular: bool,
    /// Some material is cut out by its opacity.
    pub alpha_mask: bool,
    /// Triangles emit light.
    pub emitters: bool,
    /// There are lights without area.
    pub punctual_lights: bool,
    /// There is an environment that is not black.
    pub environment: bool,
    /// Some material is shown unlit.
    pub unlit: bool,
    /// So few triangles, on an adapter that is the CPU, that testing each is faster than a tree.
    pub few_triangles: bool,
}

/// What a host's views have. Everything that is absent is left out of the shaders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct HostTraits {
    /// Normals are points of the unfolded octahedron.
    pub octahedral_normals: bool,
    /// Normals come as 0…1 instead of −1…1.
    pub mapped_normals: bool,
    /// Normals are two 16-bit numbers in one word.
    pub packed_normals: bool,
    /// The depth that each point had is given.
    pub previous_depth: bool,
    /// Objects are numbered.
    pub instances: bool,
    /// … by floats.
    pub float_instances: bool,
    /// There is an albedo.
    pub albedo: bool,
    /// Emission is given apart.
    pub emission: bool,
    /// The radiance was divided by the albedo and has no emission.
    pub demodulated: bool,
    /// The gradient's pairs are luminances.
    pub luminance_pairs: bool,
    /// There is one pair per stratum instead of an image with mostly none.
    pub stratum_pairs: bool,
    /// The pairs' paths stand in the radiance in the place of their pixels' own.
    pub pairs_in_place: bool,
    /// The λ image is a confidence, 1 − λ.
    pub confidence: bool,
    /// Input that has to be cleaned is counted.
    pub diagnostics: bool,
}

/// Something that is compiled into a shader or not. The names in WGSL are the same in capitals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
#[non_exhaustive]
pub enum Feature {
    /// Two levels of trees; placements of this and the last frame.
    Instanced,
    /// Image look-ups.
    Textures,
    /// Interpolated normals.
    ShadingNormals,
    /// GGX lobe.
    Specular,
    /// Opacity test during traversal.
    AlphaMask,
    /// Every triangle is tested instead of a tree.
    FewTriangles,
    /// Any light to sample.
    Lights,
    /// Emitting triangles.
    Emitters,
    /// Lights without area.
    PunctualLights,
    /// Light from infinity.
    EnvironmentLight,
    /// Emission towards the camera beside the filtered radiance.
    DirectEmission,
    /// Light samples without scattered rays.
    LightSamplesOnly,
    /// Scattered rays without light samples.
    ScatteredRaysOnly,
    /// Objects are told apart when reprojecting.
    Objects,
    /// The history is shortened by a gradient.
    Gradient,
    /// The gradient comes from repeated paths.
    Reshade,
    /// The gradient comes from analytic shading.
    BlinnPhong,
    /// The history is rescaled.
    HistoryRatio,
    /// α' = (1 − λ)·α + λ.
    BlendByLambda,
    /// The history's colour comes from the first spatial iteration.
    Feedback,
    /// The variance is that of the mean.
    VarianceOfMean,
    /// The first of the spatial iterations.
    FirstIteration,
    /// The published edge stops.
    ClassicStops,
    /// 25 taps instead of 13.
    FullKernel,
    /// Plane instead of mean.
    LocalLinearFit,
    /// The target shows the samples as they are.
    Unfiltered,
    /// The target shows the mean over frames.
    Accumulate,
    /// What is read at many taps is bound as storage: on an adapter that is the CPU, half the cost of a texture fetch.
    StorageReads,
    /// The target is rgba16float instead of rgba32float.
    TargetF16,
    /// The target is rgba8unorm and shows a tone-mapped picture.
    TargetPicture,
    /// What is filtered was divided by an albedo.
    Albedo,
    /// Where nothing was hit the samples are shown as they are.
    Background,
    /// Normals are points of the unfolded octahedron.
    OctahedralNormals,
    /// Normals come as 0…1.
    MappedNormals,
    /// Normals come as two 16-bit numbers in one word.
    PackedNormals,
    /// The host knows the depth that each point had.
    PreviousDepth,
    /// The host's objects have floats for numbers.
    FloatObjects,
    /// The host's radiance is still multiplied by the albedo and has the emission in it.
    Modulated,
    /// The gradient comes from pairs that the host made.
    Pairs,
    /// Those pairs are luminances.
    LuminancePairs,
    /// Those pairs come one per stratum.
    StratumPairs,
    /// The gradient's paths stand in the radiance in the place of their pixels' own.
    InPlace,
    /// Differences of the gradient keep their sign.
    SignedGradient,
    /// λ is at least what the paths around saw on any surface.
    AcrossSurfaces,
    /// λ is the host's.
    ExternalLambda,
    /// The host gives 1 − λ.
    Confidence,
    /// Input that has to be cleaned is counted.
    Diagnostics,
}

impl Feature {
    const ALL: [Self; 47] = {
        use Feature::*;
        [
            Instanced,
            Textures,
            ShadingNormals,
            Specular,
            AlphaMask,
            FewTriangles,
            Lights,
            Emitters,
            PunctualLights,
            EnvironmentLight,
            DirectEmission,
            LightSamplesOnly,
            ScatteredRaysOnly,
            Objects,
            Gradient,
            Reshade,
            BlinnPhong,
            HistoryRatio,
            BlendByLambda,
            Feedback,
            VarianceOfMean,
            FirstIteration,
            ClassicStops,
            FullKernel,
            LocalLinearFit,
            Unfiltered,
            Accumulate,
            StorageReads,
            TargetF16,
            TargetPicture,
            Albedo,
            Background,
            OctahedralNormals,
            MappedNormals,
            PackedNormals,
            PreviousDepth,
            FloatObjects,
            Modulated,
            Pairs,
            LuminancePairs,
            StratumPairs,
            InPlace,
            SignedGradient,
            AcrossSurfaces,
            ExternalLambda,
            Confidence,
            Diagnostics,
        ]
    };

    /// The name in WGSL: `LocalLinearFit` is `LOCAL_LINEAR_FIT`.
    pub(crate) fn define(self) -> String {
        let mut name = String::new();
        for c in format!("{self:?}").chars() {
            if c.is_uppercase() && !name.is_empty() {
                name.push('_');
            }
            name.push(c.to_ascii_uppercase());
        }
        name
    }
}

/// A set of [`Feature`]s.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Features(u64);

impl Features {
    /// The features of a list.
    pub fn of(features: &[Feature]) -> Self {
        features.iter().copied().collect()
    }

    /// Whether a feature is in the set.
    pub fn has(self, feature: Feature) -> bool {
        self.0 >> feature as u8 & 1 == 1
    }

    /// The set with a feature.
    #[must_use]
    pub fn with(self, feature: Feature) -> Self {
        Self(self.0 | 1 << feature as u8)
    }

    /// The set without a feature.
    #[must_use]
    pub fn without(self, feature: Feature) -> Self {
        Self(self.0 & !(1 << feature as u8))
    }

    /// What is in both sets.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// The features in the set.
    pub fn iter(self) -> impl Iterator<Item = Feature> {
        Feature::ALL.into_iter().filter(move |&f| self.has(f))
    }
}

impl FromIterator<Feature> for Features {
    fn from_iter<I: IntoIterator<Item = Feature>>(iter: I) -> Self {
        iter.into_iter().fold(Self::default(), Self::with)
    }
}

impl fmt::Debug for Features {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.iter()).finish()
    }
}

/// How rays find triangles: numbers that the shaders which follow rays are compiled with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Traversal {
    /// Down the trees.
    Tree {
        /// Slots of the traversal's stack.
        stack: u32,
    },
    /// By testing each, see [`Feature::FewTriangles`].
    Every {
        /// How many there are, a multiple of 8.
        triangles: u32,
    },
}

impl Default for Traversal {
    fn default() -> Self {
        Self::Tree { stack: 4 }
    }
}

/// An image that passes hand to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Image {
    /// Triangle number, u32.
    Visibility,
    /// Packed normal, depth.
    Guide,
    /// Motion and previous depth.
    Motion,
    /// Instance number.
    Object,
    /// This frame's demodulated radiance.
    Radiance,
    /// What it was divided by.
    Albedo,
    /// Emission towards the camera.
    Emission,
    /// Accumulated colour, variance, history length, λ.
    History,
    /// The history's colour, where it comes from the spatial filter.
    Feedback,
    /// Colour, variance, normal and depth between spatial iterations; two take turns.
    Color(u8),
    /// Records of the strata.
    Samples,
    /// Of each stratum what the host needs to repeat its path: two texels.
    Repeats,
    /// Demodulated radiance now of the pair that the host made for the stratum.
    PairNow,
    /// The radiance before of that pair.
    PairBefore,
    /// Radiances now of the gradient's pairs; two take turns while they are filtered.
    PairsNow(u8),
    /// Radiances before.
    PairsBefore(u8),
    /// Products of both.
    PairsProduct(u8),
    /// Numerator and denominator of λ on the stratum's surface, and on any; two take turns.
    Gradient(u8),
    /// What the history is multiplied with.
    Ratio,
    /// Sum over frames and their number.
    Sum,
}

/// How many texels an image has, or invocations a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Grid {
    /// One per pixel.
    Pixels,
    /// One per stratum of 3×3 pixels.
    Strata,
}

impl Image {
    /// Format of the texture.
    pub fn format(self) -> TextureFormat {
        match self {
            Self::Visibility | Self::Object => TextureFormat::R32Uint,
            Self::Guide | Self::Radiance | Self::Emission | Self::Feedback | Self::PairNow | Self::PairBefore => {
                TextureFormat::Rg32Uint
            }
            Self::History | Self::Samples | Self::Repeats | Self::Color(_) => TextureFormat::Rgba32Uint,
            Self::Albedo => TextureFormat::Rgba16Float,
            Self::PairsProduct(_) => TextureFormat::R32Float,
            Self::Gradient(_) => TextureFormat::Rgba32Float,
            Self::Motion | Self::PairsNow(_) | Self::PairsBefore(_) | Self::Ratio | Self::Sum => {
                TextureFormat::Rgba32Float
            }
        }
    }

    /// Its size.
    pub fn grid(self) -> Grid {
        match self {
            Self::Samples
            | Self::Repeats
            | Self::PairNow
            | Self::PairBefore
            | Self::PairsNow(_)
            | Self::PairsBefore(_)
            | Self::PairsProduct(_)
            | Self::Gradient(_)
            | Self::Ratio => Grid::Strata,
            _ => Grid::Pixels,
        }
    }

    /// Texels side by side for each pixel or stratum.
    pub fn texels(self) -> u32 {
        if self == Self::Repeats { 2 } else { 1 }
    }
}

/// What a binding of a pass is bound to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Slot {
    /// This frame's image.
    Now(Image),
    /// The previous frame's image.
    Before(Image),
    /// The host's target.
    Target,
    /// The host's view of the binding's name.
    Host,
}

/// One dispatch.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The shader.
    pub pass: Pass,
    /// What is compiled into it.
    pub features: Features,
    /// Its invocations.
    pub grid: Grid,
    /// Which iteration of a filter, from 0: taps are 2ⁱ apart.
    pub iteration: u32,
    /// The images behind its bindings, by name.
    pub bindings: Vec<(&'static str, Slot)>,
}

impl Step {
    /// The same step for an adapter that is the CPU, see [`Feature::StorageReads`].
    pub(crate) fn on_cpu(mut self) -> Self {
        let reads = match self.pass {
            Pass::GradientPairsFilter | Pass::GradientFilter | Pass::Temporal | Pass::Atrous => true,
            #[cfg(feature = "path-tracer")]
            Pass::Trace => true,
            // With instances it writes as many storage textures as there may be.
            #[cfg(feature = "path-tracer")]
            Pass::Visibility => !self.features.has(Feature::Instanced),
            _ => false,
        };
        if reads {
            self.features = self.features.with(Feature::StorageReads);
        }
        self
    }
}

/// What to run in a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The dispatches in order.
    pub steps: Vec<Step>,
    /// Everything that was decided to be in.
    pub features: Features,
    /// Where the filtered colour ends up, if anything is filtered.
    pub color: Option<Image>,
    /// Where the gradient ends up, if there is one.
    pub gradient: Option<Image>,
}

impl Plan {
    /// The passes that a path-traced frame needs.
    #[cfg(feature = "path-tracer")]
    pub fn path_traced(traits: &Traits, settings: &Settings, target: TextureFormat) -> Self {
        let features = traced_features(traits, settings);
        let features = if target == TextureFormat::Rgba16Float { features.with(Feature::TargetF16) } else { features };
        let mut plan = Self { steps: vec![passes::visibility::step(features)], features, color: None, gradient: None };
        let denoise = settings.mode == Mode::Denoise;
        if denoise && features.has(Feature::Gradient) {
            plan.steps.push(passes::gradient_sample::step(features));
        }
        plan.steps.push(passes::trace::step(features));
        if denoise {
            plan.filter(&settings.filter);
        }
        plan.steps.push(passes::resolve::step(features, plan.color));
        plan
    }

    /// The passes that a frame of the host's own renderer needs.
    pub fn hosted(traits: &HostTraits, settings: &Settings, target: TextureFormat) -> Self {
        let features = hosted_features(traits, settings);
        let features = if target == TextureFormat::Rgba16Float { features.with(Feature::TargetF16) } else { features };
        let mut plan =
            Self { steps: vec![passes::ingest_surface::step(features)], features, color: None, gradient: None };
        if features.has(Feature::Reshade) {
            plan.steps.push(passes::gradient_sample::step(features));
            plan.steps.push(passes::reshade::step(features));
        }
        plan.steps.push(passes::ingest_radiance::step(features));
        if features.has(Feature::Pairs) {
            plan.steps.push(passes::ingest_pairs::step(features));
        }
        if settings.mode == Mode::Denoise {
            plan.filter(&settings.filter);
        }
        plan.steps.push(passes::resolve::step(features, plan.color));
        plan
    }

    /// How many of the steps need no radiance: those that [`Denoiser::begin_frame`](crate::Denoiser::begin_frame) records.
    pub fn surface_steps(&self) -> usize {
        self.steps.iter().take_while(|step| step.pass != Pass::IngestRadiance).count()
    }

    /// The passes from noisy radiance to filtered colour.
    fn filter(&mut self, filter: &FilterSettings) {
        let features = self.features;
        if features.has(Feature::Gradient) {
            if features.has(Feature::HistoryRatio) {
                self.steps.push(passes::gradient_pairs::step(features));
                let filters = (0..filter.ratio_iterations).map(|i| passes::gradient_pairs_filter::step(features, i));
                self.steps.extend(filters);
            }
            self.steps.push(passes::gradient::step(features, (filter.ratio_iterations % 2) as u8));
            let iterations = filter.gradient_iterations;
            self.steps.extend((0..iterations).map(|i| passes::gradient_filter::step(features, i)));
            self.gradient = Some(Image::Gradient((iterations % 2) as u8));
        }
        self.steps.push(passes::temporal::step(features, self.gradient));
        if filter.iterations > 0 {
            self.steps.push(passes::variance::step(features));
        }
        self.steps.extend((0..filter.iterations).map(|i| passes::atrous::step(features, i)));
        self.color = Some(Image::Color((filter.iterations % 2) as u8));
    }

    /// The same plan for an adapter that is the CPU.
    pub(crate) fn on_cpu(self) -> Self {
        Self { steps: self.steps.into_iter().map(Step::on_cpu).collect(), ..self }
    }

    /// The images that the steps use, each once, and whether the previous frame's is used too.
    pub fn images(&self) -> Vec<(Image, bool)> {
        let slots = || self.steps.iter().flat_map(|s| &s.bindings).map(|(_, slot)| *slot);
        let before: BTreeSet<Image> =
            slots().filter_map(|s| if let Slot::Before(i) = s { Some(i) } else { None }).collect();
        let all: BTreeSet<Image> =
            slots().filter_map(|s| if let Slot::Now(i) | Slot::Before(i) = s { Some(i) } else { None }).collect();
        all.into_iter().map(|i| (i, before.contains(&i))).collect()
    }
}

#[cfg(feature = "path-tracer")]
fn traced_features(traits: &Traits, settings: &Settings) -> Features {
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

fn hosted_features(traits: &HostTraits, settings: &Settings) -> Features {
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
