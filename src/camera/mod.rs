//! Cameras, and how they reach the shaders: a host's [`Camera`] or [`Matrices`] is a [`Viewpoint`], which gives one
//! [`PlacedCamera`], which gives the uniform.

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
