//! Reads an OBJ file. Behind the first zero byte follows its material library `scene.mtl`.
#![no_main]

use asvgf::scene;
use asvgf_fuzz::{files, split};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    let (geometry, materials) = split(input);
    let files = files([("scene.obj", geometry), ("scene.mtl", materials)]);
    if let Ok(loaded) = scene::load_from_memory(&files, "scene.obj") {
        loaded.scene.validate().expect("what was loaded keeps the rules");
    }
});
