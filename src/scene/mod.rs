//! What the path tracer draws: a plain description, importers, built-in scenes, and its upload to the GPU.

mod alias;
mod buffers;
mod bvh;
mod centre;
mod description;
mod facets;
mod folded;
mod geometry;
mod instances;
mod lights;
mod materials;
mod measure;
mod pose;
mod sky;
mod snapshot;
mod texels;
mod textures;
mod upload;
mod validate;

pub mod builtin;
#[cfg(feature = "image")]
mod environment;
#[cfg(feature = "gltf")]
mod gltf;
#[cfg(any(feature = "gltf", feature = "obj"))]
mod load;
#[cfg(feature = "obj")]
mod obj;

pub use description::*;
#[cfg(any(feature = "gltf", feature = "obj"))]
pub use load::{Loaded, load, load_from_memory};
pub use pose::CameraView;
#[cfg(test)]
pub(crate) use sky::{pack, unpack};
pub(crate) use snapshot::Snapshot;
pub use upload::GpuScene;
