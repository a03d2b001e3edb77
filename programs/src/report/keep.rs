//! Results kept in files, until the code or the data that decides them changes.

use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::Path;

/// Reads a kept result; `None` if it does not exist or is unusable.
pub fn load<T: DeserializeOwned>(path: &Path) -> Option<T> {
    serde_json::from_slice(&std::fs::read(path).ok()?).ok()
}

/// Saves a result. Writes it under another name first, so that an interruption leaves no partial file.
pub fn save<T: Serialize>(thing: &T, path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let unfinished = path.with_extension("tmp");
    std::fs::write(&unfinished, serde_json::to_vec(thing)?)?;
    Ok(std::fs::rename(unfinished, path)?)
}
