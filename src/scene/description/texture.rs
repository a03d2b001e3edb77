//! Images, and their uses by materials.

/// A use of an [`Image`] by a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texture {
    /// Index into [`Scene::images`](super::Scene::images).
    pub image: usize,
    /// Index into [`Mesh::uvs`](super::Mesh::uvs): 0 or 1.
    pub uv_set: usize,
    /// Continuation outside 0…1, in u and in v.
    pub wrap: [Wrap; 2],
    /// True for the nearest texel, false for bilinear interpolation.
    pub nearest: bool,
    /// Affine map of (u, v, 1), as two rows (KHR_texture_transform).
    pub transform: [[f32; 3]; 2],
}

impl Texture {
    /// The plain image: set 0, repeated, bilinear, not transformed.
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

/// The continuation of a texture outside 0…1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Wrap {
    /// The image repeats.
    #[default]
    Repeat,
    /// The image repeats, mirrored every other time.
    Mirror,
    /// The texels of the border continue.
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
