//! The contents of scenes and of hosts' views, as far as shaders depend on them.

/// The contents of a scene. Everything that is absent is left out of the shaders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SceneContents {
    /// Meshes move or repeat: two levels of trees.
    pub instanced: bool,
    /// Meshes change their shape: skins and morph targets.
    pub deforming: bool,
    /// Materials have textures.
    pub textures: bool,
    /// Images together are larger than a storage binding.
    pub folded_images: bool,
    /// Meshes have interpolated normals.
    pub shading_normals: bool,
    /// Materials have normal maps, on meshes with tangents for them.
    pub normal_maps: bool,
    /// Meshes have colours at their vertices.
    pub vertex_colors: bool,
    /// Some surface is not purely Lambertian.
    pub specular: bool,
    /// Light goes through some surface, refracted or straight.
    pub transmission: bool,
    /// Some surface has a clear coat.
    pub clearcoat: bool,
    /// Some of the surfaces that light goes through are smooth, so that they show what lies behind them.
    pub clear_glass: bool,
    /// No surface is glossy, although shaders could show one, see [`SceneContents::everything`]: light is one signal.
    pub matte: bool,
    /// Some material has holes where its opacity is low, or no back faces.
    pub alpha_mask: bool,
    /// Some material is partly transparent, by its opacity.
    pub alpha_blend: bool,
    /// Triangles emit light.
    pub emitters: bool,
    /// The emissive image of such a triangle is uneven, so that light samples choose among its pieces.
    pub emitter_pieces: bool,
    /// There are lights without area.
    pub punctual_lights: bool,
    /// There is an environment that is not black.
    pub environment: bool,
    /// Number of texels of the environment that the last step of a light sample chooses from, one by one.
    pub environment_run: u32,
    /// Some material is shown unlit.
    pub unlit: bool,
    /// A test of each triangle is faster than a tree, because there are few and the adapter is the CPU.
    pub few_triangles: bool,
    /// Levels of the trees: the more there are, the fewer paths a dispatch traces.
    pub levels: u32,
    /// The images of a frame are kept for views, see [`DenoiserDescriptor::views`](crate::DenoiserDescriptor::views).
    pub views: bool,
}

impl SceneContents {
    /// Returns everything that the materials and lights of a scene with this layout in memory can have.
    #[must_use]
    pub fn everything(self) -> Self {
        Self {
            textures: true,
            specular: true,
            // A second signal would change the picture of a scene in which nothing shines.
            matte: self.matte || !self.specular,
            alpha_mask: true,
            alpha_blend: true,
            emitters: true,
            emitter_pieces: true,
            punctual_lights: true,
            unlit: true,
            // A tree suits any scene.
            few_triangles: false,
            ..self
        }
    }
}

/// The contents of a host's views. Everything that is absent is left out of the shaders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct HostInputs {
    /// Normals are points of the unfolded octahedron.
    pub octahedral_normals: bool,
    /// Normals come as 0…1 instead of −1…1.
    pub mapped_normals: bool,
    /// Normals are two 16-bit numbers in one word.
    pub packed_normals: bool,
    /// The previous depth of each point is given.
    pub previous_depth: bool,
    /// Objects are numbered.
    pub instances: bool,
    /// The objects' numbers are floats.
    pub float_instances: bool,
    /// There is an albedo.
    pub albedo: bool,
    /// Emission is given separately.
    pub emission: bool,
    /// The radiance was divided by the albedo and has no emission.
    pub demodulated: bool,
    /// The pairs for the gradient.
    pub pairs: Option<PairInputs>,
    /// There is λ.
    pub lambda: bool,
    /// The λ image is a confidence, 1 − λ.
    pub confidence: bool,
    /// Input that has to be cleaned is counted.
    pub diagnostics: bool,
    /// The images of a frame are kept for views, see [`DenoiserDescriptor::views`](crate::DenoiserDescriptor::views).
    pub views: bool,
    /// A view of the light shares the target's texture.
    pub in_target: bool,
    /// Specular light comes apart from diffuse light.
    pub specular: bool,
    /// The reflectance of the specular lobe is given.
    pub reflectance: bool,
    /// The roughness is given.
    pub roughness: bool,
    /// The roughness is the fourth channel of its view.
    pub roughness_in_alpha: bool,
    /// The distance from each surface to what it reflects is given.
    pub hit_distance: bool,
    /// The motion of reflections is given.
    pub reflection_motion: bool,
    /// The pairs of the specular light.
    pub specular_pairs: Option<PairInputs>,
}

/// The contents of a host's pairs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct PairInputs {
    /// The pairs are luminances.
    pub luminance: bool,
    /// There is one pair per stratum, instead of an image with no pair in most pixels.
    pub per_stratum: bool,
    /// The pairs' paths stand in the radiance in place of their pixels' own paths.
    pub in_place: bool,
}

impl HostInputs {
    /// The views of the specular signal, under the names of the diffuse one's.
    pub(crate) fn of_specular(&self) -> Self {
        Self { albedo: self.reflectance, emission: false, pairs: self.specular_pairs, ..*self }
    }
}
