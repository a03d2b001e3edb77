//! Reading scene files.

pub(crate) mod decode;
pub(crate) mod folder;
pub(crate) mod report;

use std::path::Path;

use crate::scene::description::{Scene, SceneError, Warning};

/// A scene and what could not be honoured of its file.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene; it passes [`Scene::validate`].
    pub scene: Scene,
    /// Everything that was left out or replaced, in the order in which it was met.
    pub warnings: Vec<Warning>,
}

/// Reads a scene file. The extension of its name decides how: `gltf` and `glb` (glTF 2.0, with the feature `gltf`),
/// `obj` (Wavefront OBJ + MTL, with the feature `obj`), in upper or lower case.
///
/// Files that it refers to (buffers, images, material libraries) are only read where they lie in the folder of the
/// scene file or below; network addresses are never followed.
///
/// # Errors
///
/// An unknown extension, a file that cannot be read, or one that breaks its format so that it cannot be drawn: the
/// error names the file, the element and the reason. What can be left out is left out, with a [`Warning`].
pub fn load(path: impl AsRef<Path>) -> Result<Loaded, SceneError> {
    let path = path.as_ref();
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        #[cfg(feature = "gltf")]
        Some("gltf" | "glb") => crate::scene::gltf::load(path),
        #[cfg(feature = "obj")]
        Some("obj") => crate::scene::obj::load(path),
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
