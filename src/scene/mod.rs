//! What the path tracer draws: a plain description, importers, built-in scenes, and its upload to the GPU.
//!
//! Data go one way: [`load`](mod@load) and [`builtin`] fill in a [`description`], [`gpu`] uploads it.

mod description;
mod gpu;
#[cfg(feature = "image")]
mod load;

pub use description::*;
pub use gpu::GpuScene;
pub(crate) use gpu::Snapshot;
#[cfg(test)]
pub(crate) use gpu::{pack, unpack};
#[cfg(any(feature = "gltf", feature = "obj"))]
pub use load::{Loaded, load, load_from_memory};
