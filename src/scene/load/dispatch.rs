//! The choice of an importer by the extension of a file.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

#[cfg(feature = "gltf")]
use super::gltf;
#[cfg(feature = "obj")]
use super::obj;
use crate::scene::description::SceneError;
use crate::scene::load::common::files::Files;
use crate::scene::load::common::report::Loaded;

/// Reads a scene file. The extension of its name, in upper or lower case, decides the format: `gltf` and `glb` are glTF 2.0 (with the
/// feature `gltf`), `obj` is Wavefront OBJ + MTL (with the feature `obj`).
///
/// A scene file may refer to buffers, images and material libraries. They are only read if they lie in the folder of the scene file or
/// below; network addresses are never followed. A path of another machine (absolute, with backslashes, out of the folder, in the wrong
/// case) stands for the file in that folder whose path ends in the same way, with a [`Warning`](crate::scene::Warning).
///
/// # OBJ and MTL
///
/// - Polygons are triangulated in their own plane. Quads are split along the shorter of the diagonals that lie inside.
/// - Faces of a smoothing group without normals get the mean normal of the faces around each vertex, weighted by angle. Faces that
///   meet at 80° or more have an edge between them. Faces without a group and without normals are flat.
/// - Colours of vertices are sRGB. They multiply the colour of the material; without a material they are the colour.
/// - `Pr`, `Pm` and their maps are metallic-roughness.
/// - `map_d` is a mask, cut off at one half.
/// - A surface covers as much as its opacity says (`d`, which takes precedence over `Tr`).
/// - Glass (`illum` 4, 6, 7, 9) is a thin pane that neither refracts nor tints.
///
/// # Errors
///
/// Names the file, the element and the reason: an unknown extension, a file that cannot be read, or a file of which nothing can be
/// drawn because positions, indices or bytes are missing. Any other broken or unknown element is left out or replaced on its own, with
/// a [`Warning`](crate::scene::Warning).
pub fn load(path: impl AsRef<Path>) -> Result<Loaded, SceneError> {
    read(Files::Disk, path.as_ref())
}

/// Reads a scene as [`load`] does, but from files in memory, for example from an archive or dropped on a web page. `path` is the one of
/// `files` that holds the scene. Files that the scene refers to are found by their paths in its folder, or by their mere names beside
/// it, because browsers do not tell the folder of a dropped file.
///
/// # Errors
///
/// The same as those of [`load`].
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

/// The extensions that this build can read.
fn known() -> Vec<&'static str> {
    let gltf: &[&str] = if cfg!(feature = "gltf") { &[".gltf", ".glb"] } else { &[] };
    let obj: &[&str] = if cfg!(feature = "obj") { &[".obj"] } else { &[] };
    [gltf, obj].concat()
}
