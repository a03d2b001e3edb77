//! What can be compiled into a shader.

use std::fmt;

/// Declares the enum and the list of all its members.
macro_rules! features {
    ($($(#[$doc:meta])* $name:ident,)+) => {
        /// Something that is compiled into a shader or not. The names in WGSL are the same in capitals.
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
    /// Two levels of trees; placements of this and the last frame.
    Instanced,
    /// Image look-ups.
    Textures,
    /// Images are fetched from a texture, because they are larger than a storage binding.
    FoldedImages,
    /// Interpolated normals.
    ShadingNormals,
    /// Colours at the vertices.
    VertexColors,
    /// GGX lobe.
    Specular,
    /// Test of the opacity and of the facing during traversal.
    AlphaMask,
    /// Surfaces are met as often as their opacity says.
    AlphaBlend,
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
    /// 25 taps instead of 13.
    FullKernel,
    /// Plane instead of mean.
    LocalLinearFit,
    /// The plane's ridge follows the noise of its slope.
    RidgeByNoise,
    /// The nine nearest taps alone.
    SmallKernel,
    /// The last output is blended into this one.
    Steady,
    /// A sample far brighter than its surroundings is not believed.
    Outliers,
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
    /// The host's motion is read where it is needed, instead of a copy.
    HostMotion,
    /// The host's radiance, albedo and emission are read where they are needed, instead of copies.
    HostLight,
    /// The host's objects have floats for numbers.
    FloatObjects,
    /// The host's radiance is still multiplied by the albedo and has the emission in it.
    Modulated,
    /// The gradient comes from pairs that the host made.
    Pairs,
    /// The gradient comes from means of new samples and of their histories.
    Statistics,
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
    /// Pixels may have no sample: their history goes on, or they are filled from around.
    MissingSamples,
    /// Noise may be the same in every frame: neighbours show it where the history does not.
    RepeatedNoise,
    /// α and λ are kept for views.
    KeepWeights,
    /// Paths of earlier dispatches are added to this one's.
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

    /// What is in either set.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
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
