//! The warnings and errors of an importer about one file.

use std::collections::HashSet;
use std::path::Path;

use crate::scene::description::{Scene, SceneError, Warning};

/// A scene, and warnings about the parts of its file that could not be honoured.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Loaded {
    /// The scene; it passes [`Scene::validate`].
    pub scene: Scene,
    /// Everything that was left out or replaced, in the order of reading. A reason that many elements share is given once, for the first
    /// of them.
    pub warnings: Vec<Warning>,
    /// A warning for each element, 65 536 at most, for listings that show them beside the elements of the file.
    pub details: Vec<Warning>,
}

impl From<Scene> for Loaded {
    /// A scene that was made in code: all of it is honoured.
    fn from(scene: Scene) -> Self {
        Self { scene, warnings: Vec::new(), details: Vec::new() }
    }
}

/// A defect of an element. [`Report::error`] adds the file.
#[derive(Clone, Debug)]
pub(crate) struct Fault {
    pub element: String,
    pub reason: String,
}

impl Fault {
    pub fn new(element: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { element: element.into(), reason: reason.into() }
    }
}

/// Maximum number of warnings that are kept in detail, because every element of a file may have a fault.
const DETAILS: usize = 1 << 16;

/// Collects the warnings about a file and completes its errors.
///
/// A file is refused only if nothing of it can be drawn. A broken element is lost alone, with one warning that names the element and its
/// replacement.
pub(crate) struct Report {
    file: String,
    warnings: Vec<Warning>,
    /// Every warning, including those with a reason that another one has too.
    details: Vec<Warning>,
    said: HashSet<String>,
    removed: HashSet<String>,
    /// The first part of the model that was lost. It is the reason to refuse a file of which nothing else can be drawn.
    lost: Option<Fault>,
}

impl Report {
    pub fn new(file: &Path) -> Self {
        Self {
            file: file.display().to_string(),
            warnings: Vec::new(),
            details: Vec::new(),
            said: HashSet::new(),
            removed: HashSet::new(),
            lost: None,
        }
    }

    /// Warns, unless the element was removed or has the same warning already, because an element may be read in several shapes.
    pub fn warn(&mut self, element: impl Into<String>, reason: impl Into<String>) {
        let warning = Warning { element: element.into(), reason: reason.into() };
        let new = self.said.insert(format!("{}: {}", warning.element, warning.reason));
        if new && !self.is_removed(&warning.element) {
            self.detail(warning.clone());
            self.warnings.push(warning);
        }
    }

    fn detail(&mut self, warning: Warning) {
        if self.details.len() < DETAILS {
            self.details.push(warning);
        }
    }

    /// Warns, unless the same reason was given before. Of a defect in many places, the first place is named.
    pub fn warn_once(&mut self, element: impl Into<String>, reason: impl Into<String>) {
        let reason = reason.into();
        if self.said.insert(reason.clone()) {
            self.warn(element, reason);
        } else {
            self.detail(Warning { element: element.into(), reason });
        }
    }

    /// Warns that an element is read as if it were absent. Its absence needs no warning of its own.
    #[cfg(feature = "gltf")]
    pub fn remove(&mut self, element: &str, reason: &str) {
        self.warn(element, format!("{reason}; it is read as if it were not there"));
        self.removed.insert(element.to_owned());
    }

    /// True if an element, or one that holds it, was removed.
    pub fn is_removed(&self, element: &str) -> bool {
        let ends = element.match_indices(['.', '[']).map(|(end, _)| end).chain([element.len()]);
        !self.removed.is_empty() && ends.into_iter().any(|end| self.removed.contains(&element[..end]))
    }

    /// Takes the last warning back, because a later one says more about the same element.
    #[cfg(feature = "gltf")]
    pub fn withdraw(&mut self) {
        self.warnings.pop();
        self.details.pop();
    }

    /// Warns that a broken element is replaced. A fault that several elements share is named once.
    #[cfg(feature = "gltf")]
    pub fn replace(&mut self, fault: Fault, instead: &str) {
        if self.said.insert(format!("{} {}", fault.element, fault.reason)) {
            self.warn(fault.element, format!("{}; {instead}", fault.reason));
        }
    }

    /// Warns that a part of the model is not drawn.
    #[cfg(feature = "gltf")]
    pub fn lose(&mut self, fault: Fault) {
        self.lost.get_or_insert_with(|| fault.clone());
        self.replace(fault, "it is not drawn");
    }

    /// Clamps `value` to 0…1, with a warning if that changes it visibly.
    pub fn clamp_unit(&mut self, value: f32, element: impl FnOnce() -> String) -> f32 {
        let clamped = if value.is_nan() { 0.0 } else { value.clamp(0.0, 1.0) };
        // Exporters that convert between colour spaces overshoot by rounding errors.
        let visible = value.is_nan() || (value - clamped).abs() > 1e-4;
        if visible {
            self.warn(element(), format!("{value} is outside 0…1; {clamped} is used"));
        }
        clamped
    }

    /// Clamps `value` to finite numbers of at least 0, with a warning if that changes it.
    pub fn clamp_radiance(&mut self, value: [f32; 3], element: impl FnOnce() -> String) -> [f32; 3] {
        let clamped = value.map(|x| if x.is_nan() { 0.0 } else { x.clamp(0.0, f32::MAX) });
        if clamped != value {
            self.warn(element(), format!("{value:?} is not finite and ≥ 0; {clamped:?} is used"));
        }
        clamped
    }

    pub fn error(&self, fault: Fault) -> SceneError {
        SceneError { file: self.file.clone(), element: fault.element, reason: fault.reason }
    }

    /// Returns the scene if it keeps all rules of [`Scene::validate`].
    pub fn finish(mut self, scene: Scene) -> Result<Loaded, SceneError> {
        scene.validate().map_err(|error| self.error(Fault::new(error.element, error.reason)))?;
        if scene.triangle_count() == 0 {
            if let Some(lost) = self.lost.take() {
                return Err(self.error(lost));
            }
            self.warn("file", "nothing in it can be drawn: it places no triangles");
        }
        Ok(Loaded { scene, warnings: self.warnings, details: self.details })
    }
}
