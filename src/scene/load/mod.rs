//! Importers, from files to descriptions. `dispatch` chooses the format of a scene file, `gltf` and `obj` read one format each,
//! `environment` reads pictures of the surroundings, and [`common`] is the vocabulary of all.

mod common;
#[cfg(any(feature = "gltf", feature = "obj"))]
mod dispatch;
mod environment;
#[cfg(feature = "gltf")]
mod gltf;
#[cfg(feature = "obj")]
mod obj;

#[cfg(any(feature = "gltf", feature = "obj"))]
pub use common::report::Loaded;
#[cfg(any(feature = "gltf", feature = "obj"))]
pub use dispatch::{load, load_from_memory};
