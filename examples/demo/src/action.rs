//! What the user asks for once, beside what is chosen and stays.

use crate::dropped::Files;
use std::path::PathBuf;

/// Something to do before the next frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// One frame, while time stands still.
    Step,
    /// Forget all history.
    Reset,
    /// Show another scene: a built-in one or a file.
    Open(String),
    /// Show what these files in memory are: a scene with what it refers to, or what was saved.
    Receive(Files),
    /// A quarter of the way around the scene, from one frame to the next.
    Cut,
    /// The scene's own camera again.
    Home,
    /// Walk: right, up, forward, in parts of the distance to what is looked at.
    Walk([f32; 3]),
    /// Everything as at the start.
    Restore,
    /// Write what was chosen to a file.
    Save(PathBuf),
    /// Read it.
    Load(PathBuf),
    /// Write the picture to a file: its name says whether as a picture (PNG) or as numbers (EXR).
    Picture(PathBuf),
}
