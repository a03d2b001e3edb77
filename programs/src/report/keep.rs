//! What was measured, kept in files until what decides it changes.

use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::Path;

/// Reads what was kept; `None` where it is not there or cannot be used.
pub fn load<T: DeserializeOwned>(path: &Path) -> Option<T> {
    serde_json::from_slice(&std::fs::read(path).ok()?).ok()
}

/// Written elsewhere first, so that an interruption leaves no half of it.
pub fn save<T: Serialize>(thing: &T, path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let unfinished = path.with_extension("tmp");
    std::fs::write(&unfinished, serde_json::to_vec(thing)?)?;
    Ok(std::fs::rename(unfinished, path)?)
}
