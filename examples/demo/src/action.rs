//! Actions that the user asks for once, in contrast to the choices that stay.

use crate::dropped::Files;
use std::path::PathBuf;

/// An action to do before the next frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Render one frame while time stands still.
    Step,
    /// Forget all history.
    Reset,
    /// Show another scene: a built-in one or a file.
    Open(String),
    /// Open files in memory: a scene with the files that it refers to, or a saved state.
    Receive(Files),
    /// Turn a quarter of the way around the scene, from one frame to the next.
    Cut,
    /// Return to the scene's own camera.
    Home,
    /// Walk to the right, up and forward, by fractions of the distance to the target.
    Walk([f32; 3]),
    /// Return everything to its initial state.
    Restore,
    /// Write the state to a file.
    Save(PathBuf),
    /// Read the state from a file.
    Load(PathBuf),
    /// Write the picture to a file. The name's ending selects a picture (PNG) or numbers (EXR).
    Picture(PathBuf),
}
