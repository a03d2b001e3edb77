//! The importer of a file, by its extension.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

#[cfg(feature = "gltf")]
use super::gltf;
#[cfg(feature = "obj")]
use super::obj;
use crate::scene::description::SceneError;
use crate::scene::load::common::files::Files;
use crate::scene::load::common::report::Loaded;

/// Reads a scene file. The extension of its name decides how: `gltf` and `glb` (glTF 2.0, with the feature `gltf`),
/// `obj` (Wavefront OBJ + MTL, with the feature `obj`), in upper or lower case.
///
/// Files that it refers to (buffers, images, material libraries) are only read where they lie in the folder of the
/// scene file or below; network addresses are never followed. A path of another machine (absolute, with backslashes, out of
/// the folder, in the wrong case) stands for the file in that folder whose path ends as it does, with a [`Warning`].
///
/// # OBJ and MTL
///
/// - Polygons are triangulated in their own plane, quads along the shorter diagonal of those inside.
/// - Faces of a smoothing group without normals get the mean of the faces around each vertex, weighted by angle; faces that
///   meet at 80° or more have an edge between them. Faces without a group and without normals are flat.
/// - Colours of vertices are taken as sRGB. They multiply the colour of the material, and are seen as they are without one.
/// - `Pr`, `Pm` and their maps are metallic-roughness; `map_d` is a mask, cut off at one half; a surface covers as much as its
///   opacity (`d`, which wins over `Tr`) says; glass (`illum` 4, 6, 7, 9) is a thin pane that neither refracts nor tints.
///
/// # Errors
///
/// An unknown extension, a file that cannot be read, or one of which nothing can be drawn because positions, indices or
/// bytes are missing: the error names the file, the element and the reason. Everything else that is broken or unknown is left
/// out or replaced on its own, with a [`Warning`].
pub fn load(path: impl AsRef<Path>) -> Result<Loaded, SceneError> {
    read(Files::Disk, path.as_ref())
}

/// As [`load`], from files in memory: for what was dropped on a web page, or is in an archive. `path` says which of `files`
/// is the scene; those that it refers to are looked for by their paths in its folder, and by their mere names beside it, as
/// browsers do not tell in which folder a dropped file lay.
///
/// # Errors
///
/// As [`load`].
pub fn load_from_memory(files: &BTreeMap<PathBuf, Vec<u8>>, path: impl AsRef<Path>) -> Result<Loaded, SceneError> {
    read(Files::Memory(files), path.as_ref())
}

fn read(files: Files<'_>, path: &Path) -> Result<Loaded, SceneError> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        #[cfg(feature = "gltf")]
        Some("gltf" | "glb") => gltf::load(files, path),
        #[cfg(feature = "obj")]
        Some("obj") => obj::load(files, path),
        _ => Err(SceneError {
            file: path.display().to_string(),
            element: "file name".into(),
            reason: format!("unknown extension; known are {}", known().join(", ")),
        }),
    }
}

/// Extensions that this build can read.
fn known() -> Vec<&'static str> {
    let gltf: &[&str] = if cfg!(feature = "gltf") { &[".gltf", ".glb"] } else { &[] };
    let obj: &[&str] = if cfg!(feature = "obj") { &[".obj"] } else { &[] };
    [gltf, obj].concat()
}
