//! Scenes for the path tracer: a plain description, importers, built-in scenes, and the upload to the GPU.
//!
//! Data flow one way: the importers in `load/` and [`builtin`] fill in a description (`description/`), and `gpu/` lays it out and
//! uploads it.

mod description;
mod gpu;
#[cfg(feature = "image")]
mod load;

pub use description::*;
pub use gpu::GpuScene;
pub(crate) use gpu::{Snapshot, Visible};
#[cfg(test)]
pub(crate) use gpu::{pack, unpack};
#[cfg(any(feature = "gltf", feature = "obj"))]
pub use load::{Loaded, load, load_from_memory};
