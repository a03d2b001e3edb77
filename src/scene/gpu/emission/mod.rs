//! The light of emitting triangles whose material has an image: its mean, and its distribution over the triangle.

pub(crate) mod division;
mod grid;
pub(crate) mod luminance;
pub(crate) mod maps;
mod pyramid;
