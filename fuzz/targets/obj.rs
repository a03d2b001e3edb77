//! An OBJ file and, behind the first zero byte, its material library `scene.mtl`.
#![no_main]

use asvgf::scene;
use asvgf_fuzz::{Folder, split};
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

static FOLDER: LazyLock<Folder> = LazyLock::new(|| Folder::new("obj"));

fuzz_target!(|input: &[u8]| {
    let (geometry, materials) = split(input);
    FOLDER.write("scene.mtl", materials);
    if let Ok(loaded) = scene::load(FOLDER.write("scene.obj", geometry)) {
        loaded.scene.validate().expect("what was loaded keeps the rules");
    }
});
