//! Scene files of this repository that open by name. They are part of the program, because a page in a browser cannot read `assets/`.

use asvgf::scene::{Loaded, SceneError, load_from_memory};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Names of the scenes.
pub const NAMES: [&str; 2] = ["textured", "still-life"];

/// A scene by name with all its animations, or `None` if there is no such name.
pub fn load(name: &str) -> Option<Result<Loaded, SceneError>> {
    let file: &[u8] = match name {
        "textured" => include_bytes!("../../../assets/textured/room.glb"),
        "still-life" => include_bytes!("../../../assets/still_life/still_life.glb"),
        _ => return None,
    };
    let path = PathBuf::from(format!("{name}.glb"));
    Some(load_from_memory(&BTreeMap::from([(path.clone(), file.to_vec())]), path))
}
