//! The vocabulary of all importers: files, their texts and images, and the report of what was found. It knows no scene format.

#[cfg(any(feature = "gltf", feature = "obj"))]
pub(super) mod decode;
#[cfg(any(feature = "gltf", feature = "obj"))]
pub(super) mod encoding;
#[cfg(any(feature = "gltf", feature = "obj"))]
pub(super) mod files;
#[cfg(any(feature = "gltf", feature = "obj"))]
pub(super) mod folder;
#[cfg(any(feature = "gltf", feature = "obj"))]
mod ktx2;
#[cfg(any(feature = "gltf", feature = "obj"))]
#[cfg(any(feature = "gltf", feature = "obj"))]
pub(super) mod recognise;
#[cfg(any(feature = "gltf", feature = "obj"))]
pub(super) mod report;
