//! Cameras, and their way to the shaders: a host's [`Camera`] or [`Matrices`] becomes a [`Viewpoint`], for an image's size that
//! becomes a [`PlacedCamera`], and in a frame that becomes the [`CameraUniform`].

mod look_at;
mod matrices;
mod placed;
#[cfg(test)]
mod tests;
mod vector;
mod viewpoint;

pub use look_at::Camera;
pub use matrices::Matrices;
pub(crate) use placed::{CameraUniform, PlacedCamera};
pub use viewpoint::Viewpoint;
