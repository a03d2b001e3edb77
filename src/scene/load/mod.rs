//! Importers: files to descriptions. [`dispatch`] chooses the format, `gltf`, `obj` and `environment` read one each, and
//! [`common`] holds what they share.

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
