//! What is wrong with a scene or its file.

/// Something in a file that could not be honoured; the rest was loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The element, as the file names it: `images[3]`, `materials[0] "glass"`, `extension KHR_draco…`.
    pub element: String,
    /// What is wrong or unread, and what was done instead.
    pub reason: String,
}

/// Why a scene cannot be used.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{file}: {element}: {reason}")]
pub struct SceneError {
    /// The file (or `scene`, for one that was made in code).
    pub file: String,
    /// The element that is wrong, as the file names it.
    pub element: String,
    /// What is wrong with it and, where that helps, what would be right.
    pub reason: String,
}

impl SceneError {
    /// An error in a scene that was made in code, or that was valid as a file.
    pub(crate) fn of_scene(element: impl Into<String>, reason: String) -> Self {
        Self { file: "scene".into(), element: element.into(), reason }
    }
}
