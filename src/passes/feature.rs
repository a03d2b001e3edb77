//! The parts of a shader that may be compiled in or left out.

use std::fmt;

/// Declares the enum and the list of all its members.
macro_rules! features {
    ($($(#[$doc:meta])* $name:ident,)+) => {
        /// A part of a shader that is compiled in or left out. Its name in WGSL is the same in capitals.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u8)]
        #[non_exhaustive]
        pub enum Feature {
            $($(#[$doc])* $name,)+
        }

        impl Feature {
            /// Every feature, in order.
            pub const ALL: &[Self] = &[$(Self::$name),+];
        }
    };
}

features! {
    /// Two levels of trees, with placements of this and the last frame.
    Instanced,
    /// Meshes that change their shape, with the corners of the last frame.
    Deforming,
    /// Image look-ups.
    Textures,
    /// Images are fetched from a texture, because they are larger than a storage binding.
    FoldedImages,
    /// Interpolated normals.
    ShadingNormals,
    /// Normals from images.
    NormalMaps,
    /// Colours at the vertices.
    VertexColors,
    /// GGX lobe.
    Specular,
    /// Light goes through surfaces, refracted or straight.
    Transmission,
    /// A second GGX lobe above the others.
    Clearcoat,
    /// The filter follows the surfaces behind clear glass.
    SeeThrough,
    /// Test of the opacity and of the facing during traversal.
    AlphaMask,
    /// Rays meet a surface with the probability of its opacity.
    AlphaBlend,
    /// Rays test every triangle instead of a tree.
    FewTriangles,
    /// Light samples, because there is light.
    Lights,
    /// Emitting triangles.
    Emitters,
    /// Emitting triangles with an uneven image are divided into pieces.
    EmitterPieces,
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
    /// Nothing changed since the last frame: the history needs no reprojection.
    Still,
    /// Nothing changed in the scene: the gradient is 0.
    Unchanged,
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
    /// Nothing is filtered in space: the history's colour is the picture's.
    TemporalOnly,
    /// The first of the spatial iterations.
    FirstIteration,
    /// The published edge stops.
    ClassicStops,
    /// The kernel has 25 taps instead of 13.
    FullKernel,
    /// A plane is fitted to the taps instead of a mean.
    LocalLinearFit,
    /// The plane's ridge follows the noise of its slope.
    RidgeByNoise,
    /// The kernel has the nine nearest taps alone.
    SmallKernel,
    /// The last output is blended into this one.
    Steady,
    /// A sample that is far brighter than its surroundings loses weight.
    Outliers,
    /// The target shows the samples unfiltered.
    Unfiltered,
    /// The target shows the mean over frames.
    Accumulate,
    /// Images that are read at many taps are bound as storage, because on an adapter that is the CPU a read costs half as much as a
    /// texture fetch.
    StorageReads,
    /// The target is rgba16float instead of rgba32float.
    TargetF16,
    /// The target is rgba8unorm and shows a tone-mapped picture.
    TargetPicture,
    /// The filtered radiance was divided by an albedo.
    Albedo,
    /// Samples are shown unfiltered where nothing was hit.
    Background,
    /// Normals are points of the unfolded octahedron.
    OctahedralNormals,
    /// Normals come as 0…1.
    MappedNormals,
    /// Normals come as two 16-bit numbers in one word.
    PackedNormals,
    /// The host gives the depth that each point had in the last frame.
    PreviousDepth,
    /// The host's motion is read in place instead of a copy.
    HostMotion,
    /// The host's radiance, albedo and emission are read in place instead of copies.
    HostLight,
    /// The host numbers its objects with floats.
    FloatObjects,
    /// The host's radiance is multiplied by the albedo and contains the emission.
    Modulated,
    /// The gradient comes from pairs that the host made.
    Pairs,
    /// The gradient comes from means of new samples and of their histories.
    Statistics,
    /// The pairs are luminances.
    LuminancePairs,
    /// There is one pair per stratum.
    StratumPairs,
    /// The gradient's paths stand in the radiance in place of their pixels' own paths.
    InPlace,
    /// Differences of the gradient keep their sign.
    SignedGradient,
    /// λ is at least the λ of nearby paths on any surface.
    AcrossSurfaces,
    /// λ is the host's.
    ExternalLambda,
    /// The host gives 1 − λ.
    Confidence,
    /// Pixels whose input has to be cleaned are counted.
    Diagnostics,
    /// Pixels may have no sample: their history goes on, or their neighbours fill them.
    MissingSamples,
    /// Noise may be the same in every frame: neighbours show it if the history does not.
    RepeatedNoise,
    /// α and λ are kept for views.
    KeepWeights,
    /// Specular light is a signal of its own: history, gradient, filter.
    Gloss,
    /// The step is one of the specular signal.
    SpecularSignal,
    /// One radiance holds diffuse and specular light: the histories of glossy surfaces are short where reflections slide over them.
    MixedGloss,
    /// The host gives the roughness.
    Roughness,
    /// The roughness is the fourth channel of its image.
    RoughnessInAlpha,
    /// The host gives the distance from a surface to what it reflects.
    HitDistance,
    /// The motion of reflections is given.
    ReflectionMotion,
    /// The reflectance of the specular lobe is given.
    Reflectance,
    /// Mixed light is divided by the sum of the albedo and of the specular reflectance.
    SummedAlbedo,
    /// What the spatial filter takes in is at most a multiple of what is around.
    Clamp,
    /// The sum of earlier dispatches' paths is added to this one's.
    EarlierPaths,
    /// Later dispatches trace the other paths.
    LaterPaths,
}

impl Feature {
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
pub struct Features(u128);

/// Asserts that each feature has a bit, because a shift beyond the last bit would make two features one.
const _: () = assert!(Feature::ALL.len() <= u128::BITS as usize, "a set has a bit for each feature");

impl Features {
    /// The features of a list.
    pub const fn of(features: &[Feature]) -> Self {
        let (mut set, mut i) = (Self(0), 0);
        while i < features.len() {
            set = set.with(features[i]);
            i += 1;
        }
        set
    }

    /// True if the set has this feature.
    pub const fn has(self, feature: Feature) -> bool {
        self.0 >> feature as u8 & 1 == 1
    }

    /// True if the set has all features of the other.
    pub const fn has_all(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// True if the set has one of the features of the other.
    pub const fn has_any(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// True if the set is empty.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The set with this feature.
    #[must_use]
    pub const fn with(self, feature: Feature) -> Self {
        Self(self.0 | 1 << feature as u8)
    }

    /// The set without this feature.
    #[must_use]
    pub const fn without(self, feature: Feature) -> Self {
        Self(self.0 & !(1 << feature as u8))
    }

    /// The features of both sets.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// The features of either set.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The features in the set.
    pub fn iter(self) -> impl Iterator<Item = Feature> {
        Feature::ALL.iter().copied().filter(move |&f| self.has(f))
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
