//! What a frame has to offer, as far as shaders depend on it.

/// What a scene has. Everything that is absent is left out of the shaders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Traits {
    /// Meshes move or repeat: two levels of trees.
    pub instanced: bool,
    /// Materials have textures.
    pub textures: bool,
    /// Images together are larger than a storage binding.
    pub folded_images: bool,
    /// Meshes have interpolated normals.
    pub shading_normals: bool,
    /// Meshes have colours at their vertices.
    pub vertex_colors: bool,
    /// Some surface is not purely Lambertian.
    pub specular: bool,
    /// Some material is cut out by its opacity, or has no back faces.
    pub alpha_mask: bool,
    /// Some material covers as much as its opacity.
    pub alpha_blend: bool,
    /// Triangles emit light.
    pub emitters: bool,
    /// There are lights without area.
    pub punctual_lights: bool,
    /// There is an environment that is not black.
    pub environment: bool,
    /// Texels of it that a light sample chooses among at the end, one by one.
    pub environment_run: u32,
    /// Some material is shown unlit.
    pub unlit: bool,
    /// So few triangles, on an adapter that is the CPU, that testing each is faster than a tree.
    pub few_triangles: bool,
    /// Levels of its trees: the more there are, the fewer paths a dispatch traces.
    pub levels: u32,
    /// What a frame leaves is to be shown, see [`DenoiserDescriptor::views`](crate::DenoiserDescriptor::views).
    pub views: bool,
}

impl Traits {
    /// All that the materials and lights of a scene with this layout in memory can have.
    #[must_use]
    pub fn everything(self) -> Self {
        Self {
            textures: true,
            specular: true,
            alpha_mask: true,
            alpha_blend: true,
            emitters: true,
            punctual_lights: true,
            unlit: true,
            // A tree suits any scene.
            few_triangles: false,
            ..self
        }
    }
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
    /// There are pairs for the gradient.
    pub pairs: bool,
    /// There is λ.
    pub lambda: bool,
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
    /// What a frame leaves is to be shown, see [`DenoiserDescriptor::views`](crate::DenoiserDescriptor::views).
    pub views: bool,
    /// Some of the light comes in the target's own texture.
    pub in_target: bool,
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
    /// By testing each, see [`Feature::FewTriangles`](super::Feature::FewTriangles).
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
