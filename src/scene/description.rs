//! The scene as plain data: what an importer produces, what a host may fill in by hand, and what
//! [`GpuScene`](crate::scene::GpuScene) uploads.
//!
//! Conventions are those of glTF 2.0: right-handed, +Y up, metres, counter-clockwise front faces, matrices as four
//! columns, quaternions as `[x, y, z, w]`, linear Rec. 709 colour unless a field says otherwise.

/// A column-major 4×4 matrix: `m[column][row]`, multiplying column vectors from the left.
pub type Matrix = [[f32; 4]; 4];

/// The same in double precision. Thousands of kilometres from the origin it still places to a micrometre.
pub type WorldMatrix = [[f64; 4]; 4];

/// The identity [`Matrix`].
pub const IDENTITY: Matrix = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// Everything that the path tracer draws: geometry stored once per [`Mesh`], placed by [`Node`]s.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Triangle lists, each with one material.
    pub meshes: Vec<Mesh>,
    /// Surfaces that meshes refer to by index.
    pub materials: Vec<Material>,
    /// Images that materials refer to by index.
    pub images: Vec<Image>,
    /// The hierarchy that places meshes, lights and cameras. A parent comes before its children.
    pub nodes: Vec<Node>,
    /// Lights without area.
    pub lights: Vec<Light>,
    /// Perspective cameras.
    pub cameras: Vec<Perspective>,
    /// Light from infinitely far away; also what a primary ray sees that hits nothing. `None` is black.
    pub environment: Option<Environment>,
    /// Motions, one of which may be played with [`Scene::pose`].
    pub animations: Vec<Animation>,
}

/// Triangles that share a material. Indices address all the vertex arrays alike.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Name for messages and debugging; may be empty.
    pub name: String,
    /// Vertex positions in object space.
    pub positions: Vec<[f32; 3]>,
    /// Shading normals, one per vertex, or empty: then the geometric normal of each triangle is used.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, one per vertex, or empty: set 0 and set 1.
    pub uvs: [Vec<[f32; 2]>; 2],
    /// Linear colour and opacity, each 0…1, one per vertex, or empty: then white. They multiply the base colour.
    pub colors: Vec<[f32; 4]>,
    /// Vertex indices, three per triangle, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// Index into [`Scene::materials`].
    pub material: usize,
}

/// A surface: Lambert + GGX in the metallic-roughness model of glTF 2.0, and light that it emits.
#[derive(Clone, Debug)]
pub struct Material {
    /// Name for messages and debugging; may be empty.
    pub name: String,
    /// Linear base colour and opacity, each 0…1; multiplies the texture.
    pub base_color: [f32; 4],
    /// Base colour (sRGB) and opacity.
    pub base_color_texture: Option<Texture>,
    /// 0 = dielectric, 1 = metal; multiplies the blue channel of the texture.
    pub metallic: f32,
    /// Perceptual roughness 0…1 (GGX α is its square); multiplies the green channel of the texture.
    pub roughness: f32,
    /// Green = roughness, blue = metallic (linear).
    pub metallic_roughness_texture: Option<Texture>,
    /// Radiance that the front face emits (every face, where `double_sided`), ≥ 0; multiplies the texture.
    pub emissive: [f32; 3],
    /// Emitted colour (sRGB).
    pub emissive_texture: Option<Texture>,
    /// How opacity is used.
    pub alpha: Alpha,
    /// Whether the back face emits too. Reflection is always two-sided.
    pub double_sided: bool,
    /// The base colour is shown as it is, without any light (KHR_materials_unlit); it lights nothing.
    pub unlit: bool,
    /// Normal-incidence reflectance (F₀) of the dielectric part, each 0…1: 0.04 for an index of refraction of 1.5, 0 for a
    /// purely Lambertian surface.
    pub specular: [f32; 3],
    /// Reflectance of the dielectric part at grazing incidence (F₉₀), 0…1.
    pub specular_edge: f32,
    /// Alpha multiplies `specular` and `specular_edge` (KHR_materials_specular).
    pub specular_texture: Option<Texture>,
    /// Colour (sRGB) multiplies `specular` (KHR_materials_specular).
    pub specular_color_texture: Option<Texture>,
    /// Back faces do not exist, neither for the camera nor for light, as rasterizers draw them: for outlines made of hulls.
    pub culled: bool,
}

impl Default for Material {
    /// The default material of glTF 2.0, but purely diffuse: white, not metallic, rough, without a dielectric coat.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [1.0; 4],
            base_color_texture: None,
            metallic: 0.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            emissive: [0.0; 3],
            emissive_texture: None,
            alpha: Alpha::Opaque,
            double_sided: false,
            unlit: false,
            specular: [0.0; 3],
            specular_edge: 1.0,
            specular_texture: None,
            specular_color_texture: None,
            culled: false,
        }
    }
}

impl Material {
    /// All textures that there are, each with the name of its field.
    pub(crate) fn textures(&self) -> impl Iterator<Item = (&'static str, Texture)> {
        [
            ("base_color_texture", self.base_color_texture),
            ("metallic_roughness_texture", self.metallic_roughness_texture),
            ("emissive_texture", self.emissive_texture),
            ("specular_texture", self.specular_texture),
            ("specular_color_texture", self.specular_color_texture),
        ]
        .into_iter()
        .filter_map(|(name, texture)| Some((name, texture?)))
    }
}

/// How a material's opacity is used.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Alpha {
    /// Opacity is ignored.
    #[default]
    Opaque,
    /// Points whose opacity is below the cutoff do not exist.
    Mask(f32),
    /// The surface covers as much of what lies behind as its opacity: a ray meets it with that probability. Noise is higher
    /// there, because a path begins on one of the surfaces that a pixel sees. The denoiser keeps the depth, normal and motion
    /// of the nearest one with an opacity of at least ½, and the albedo of all.
    Blend,
}

/// A use of an [`Image`] by a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texture {
    /// Index into [`Scene::images`].
    pub image: usize,
    /// Which of [`Mesh::uvs`]: 0 or 1.
    pub uv_set: usize,
    /// What lies outside 0…1 in u and in v.
    pub wrap: [Wrap; 2],
    /// Nearest texel instead of bilinear interpolation.
    pub nearest: bool,
    /// Affine map of (u, v, 1), as two rows (KHR_texture_transform).
    pub transform: [[f32; 3]; 2],
}

impl Texture {
    /// The image as it is: set 0, repeated, bilinear, not transformed.
    pub fn new(image: usize) -> Self {
        Self {
            image,
            uv_set: 0,
            wrap: [Wrap::Repeat; 2],
            nearest: false,
            transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        }
    }
}

/// What a texture shows outside 0…1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// The image mirrored, again and again.
    Mirror,
    /// The texels of the border.
    Clamp,
}

/// Decoded texels, 8 bits per channel, exactly as the file encodes them (colour is not linearised here).
#[derive(Clone, Debug, Default)]
pub struct Image {
    /// Name for messages and debugging; may be empty.
    pub name: String,
    /// Texels per row, ≥ 1.
    pub width: u32,
    /// Rows, ≥ 1.
    pub height: u32,
    /// `width · height` texels, first row first; (u, v) = (0, 0) is the corner of the first texel.
    pub texels: Vec<[u8; 4]>,
}

/// One element of the hierarchy.
#[derive(Clone, Debug, Default)]
pub struct Node {
    /// Name for messages and debugging; may be empty.
    pub name: String,
    /// Index of the parent node, smaller than this node's own; `None` for a root.
    pub parent: Option<usize>,
    /// Placement relative to the parent.
    pub transform: Transform,
    /// Meshes placed here (indices into [`Scene::meshes`]).
    pub meshes: Vec<usize>,
    /// Light placed here, shining along −Z (index into [`Scene::lights`]).
    pub light: Option<usize>,
    /// Camera placed here, looking along −Z with +Y up (index into [`Scene::cameras`]).
    pub camera: Option<usize>,
    /// The host will move this node although no animation does: keep it out of the static geometry.
    pub movable: bool,
}

/// Placement of a node relative to its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transform {
    /// `translation · rotation · scale`; only these can be animated.
    Trs {
        /// Offset.
        translation: [f32; 3],
        /// Unit quaternion `[x, y, z, w]`.
        rotation: [f32; 4],
        /// Scale along the node's own axes; may be negative.
        scale: [f32; 3],
    },
    /// Any affine matrix, shear included.
    Matrix(Matrix),
}

impl Default for Transform {
    fn default() -> Self {
        Self::Trs { translation: [0.0; 3], rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] }
    }
}

/// A light without area (KHR_lights_punctual). Direction is −Z of its node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Shape of the emission.
    pub kind: LightKind,
    /// Linear colour times intensity: W/(m²) for a directional light (radiometric lux), W/sr for the others.
    pub intensity: [f32; 3],
    /// Distance at which the light has faded to nothing, or infinity. Fades as in KHR_lights_punctual.
    pub range: f32,
}

/// Shape of a [`Light`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Parallel light from infinitely far away.
    Directional,
    /// All directions alike.
    Point,
    /// A cone: full intensity inside `inner`, none outside `outer` (half angles, radians).
    Spot {
        /// Half angle of the full cone.
        inner: f32,
        /// Half angle at which the light ends, > `inner`.
        outer: f32,
    },
}

/// A perspective projection. Its place and direction come from the node that holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perspective {
    /// Vertical field of view in radians, 0 < fov < π.
    pub fov_y: f32,
}

/// Light from infinitely far away as an equirectangular image: u grows with the azimuth from −X over +Z, +X and −Z…
/// exactly: direction (x, y, z) is at u = ½ + atan2(z, x)/2π, v = acos(y)/π. The first row is +Y.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    /// Texels per row, ≥ 1.
    pub width: u32,
    /// Rows, ≥ 1.
    pub height: u32,
    /// `width · height` linear radiances, finite and ≥ 0.
    pub radiance: Vec<[f32; 3]>,
}

impl Scene {
    /// Takes the back faces of all materials that are not [`double_sided`](Material::double_sided) away, as rasterizers do: for
    /// models whose outlines are hulls turned inside out, and for rooms that are looked into from outside.
    pub fn cull_back_faces(&mut self) {
        self.materials.iter_mut().for_each(|material| material.culled = !material.double_sided);
    }
}

impl Environment {
    /// The same radiance from everywhere.
    pub fn uniform(radiance: [f32; 3]) -> Self {
        Self { width: 1, height: 1, radiance: vec![radiance] }
    }
}

/// Curves over time that move nodes and dim lights together.
#[derive(Clone, Debug, Default)]
pub struct Animation {
    /// Name by which it is chosen; may be empty.
    pub name: String,
    /// The curves. No two may have the same target.
    pub channels: Vec<Channel>,
}

/// One animated property.
#[derive(Clone, Debug)]
pub struct Channel {
    /// What is animated.
    pub target: Target,
    /// How to go from key to key.
    pub interpolation: Interpolation,
    /// Key times in seconds, increasing, at least one.
    pub times: Vec<f32>,
    /// One value per key: xyz for translation and scale, a quaternion for rotation, x for factors.
    /// [`Interpolation::CubicSpline`] has three per key: in-tangent, value, out-tangent.
    pub values: Vec<[f32; 4]>,
}

/// What a [`Channel`] drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// Translation of a node.
    Translation(usize),
    /// Rotation of a node.
    Rotation(usize),
    /// Scale of a node.
    Scale(usize),
    /// Factor ≥ 0 on a material's emission.
    Emission(usize),
    /// Factor ≥ 0 on a light's intensity.
    Intensity(usize),
}

/// How a [`Channel`] goes from key to key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// The last key's value.
    Step,
    /// Linear; spherical for rotations.
    #[default]
    Linear,
    /// Cubic Hermite with the given tangents.
    CubicSpline,
}

/// The moving parts of a [`Scene`] at one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// World matrix of each node. In double precision: products of large and small offsets keep the small ones.
    pub world: Vec<WorldMatrix>,
    /// Factor on the emission of each material, per colour channel.
    pub emission: Vec<[f32; 3]>,
    /// Factor on the intensity of each light, likewise.
    pub intensity: Vec<[f32; 3]>,
}

/// Something in a file that could not be honoured; the rest was loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The element, as the file names it: `images[3]`, `materials[0] "glass"`, `extension KHR_draco…`.
    pub element: String,
    /// What is wrong or unread, and what was done instead.
    pub reason: String,
}

/// Why a scene cannot be used.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{file}: {element}: {reason}")]
pub struct SceneError {
    /// The file (or `scene`, for one that was made in code).
    pub file: String,
    /// The element that is wrong, as the file names it.
    pub element: String,
    /// What is wrong with it and, where that helps, what would be right.
    pub reason: String,
}
