//! Files that are dropped into the window: scenes and saved states.

use crate::action::Action;
use eframe::egui::Ui;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Files that were dropped together, by name.
pub type Files = BTreeMap<PathBuf, Vec<u8>>;

/// Dropped files that still wait to be opened.
#[derive(Default)]
pub struct Dropped {
    #[cfg(target_arch = "wasm32")]
    arrived: std::sync::Arc<std::sync::Mutex<Vec<Action>>>,
}

impl Dropped {
    /// Takes the actions for dropped files. A desktop program finds a scene's other files by its path.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn take(&self, ui: &Ui) -> Vec<Action> {
        let paths: Vec<PathBuf> =
            ui.input(|input| input.raw.dropped_files.iter().map(|f| f.path().to_owned()).collect());
        let action = |path: PathBuf| match is_saved(&path) {
            true => Action::Load(path),
            false => Action::Open(path.display().to_string()),
        };
        paths.into_iter().map(action).collect()
    }

    /// Takes the actions for files that have arrived. A page gets their bytes, and only after a while.
    #[cfg(target_arch = "wasm32")]
    pub fn take(&self, ui: &Ui) -> Vec<Action> {
        let handles = ui.input(|input| input.raw.dropped_files.clone());
        if !handles.is_empty() {
            let (arrived, context) = (self.arrived.clone(), ui.ctx().clone());
            wasm_bindgen_futures::spawn_local(async move {
                let mut files = Files::new();
                for handle in handles {
                    // The scene that names an unreadable file reports it as missing.
                    if let Ok(bytes) = handle.bytes_async().await {
                        files.insert(handle.path().to_owned(), bytes);
                    }
                }
                if let Ok(mut arrived) = arrived.lock() {
                    arrived.push(Action::Receive(files));
                }
                context.request_repaint();
            });
        }
        self.arrived.lock().map(|mut arrived| std::mem::take(&mut *arrived)).unwrap_or_default()
    }
}

/// The main file among files that were dropped together: a scene, or else a saved state.
pub fn chief(files: &Files) -> Option<&Path> {
    let is_scene = |path: &Path| ["gltf", "glb", "obj"].iter().any(|known| has_extension(path, known));
    let paths = || files.keys().map(PathBuf::as_path);
    paths().find(|path| is_scene(path)).or_else(|| paths().find(|path| is_saved(path)))
}

/// Returns true if a file is a saved state.
pub fn is_saved(path: &Path) -> bool {
    has_extension(path, "json")
}

fn has_extension(path: &Path, known: &str) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(known))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scene_is_found_among_its_files() {
        let chief = |names: &[&str]| {
            let files: Files = names.iter().map(|name| (name.into(), Vec::new())).collect();
            chief(&files).map(|path| path.display().to_string())
        };
        assert_eq!(chief(&["a.bin", "b.png", "room.GLTF"]).as_deref(), Some("room.GLTF"));
        assert_eq!(chief(&["demo.json", "room.obj"]).as_deref(), Some("room.obj"));
        assert_eq!(chief(&["demo.json"]).as_deref(), Some("demo.json"));
        assert_eq!(chief(&["a.png"]), None);
    }
}
