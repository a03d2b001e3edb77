//! Warnings and errors about a scene or its file.

/// An element of a file that could not be honoured. The rest was loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Warning {
    /// The element, as the file names it: `images[3]`, `materials[0] "glass"`, `extension KHR_draco…`.
    pub element: String,
    /// The defect or the unread part, and its replacement.
    pub reason: String,
}

/// The reason why a scene cannot be used.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{file}: {element}: {reason}")]
#[non_exhaustive]
pub struct SceneError {
    /// The file (or `scene`, for one that was made in code).
    pub file: String,
    /// The faulty element, as the file names it.
    pub element: String,
    /// The defect and, where that helps, a remedy.
    pub reason: String,
}

impl SceneError {
    /// An error in a scene itself, whatever file it came from.
    pub(crate) fn of_scene(element: impl Into<String>, reason: String) -> Self {
        Self { file: "scene".into(), element: element.into(), reason }
    }
}
