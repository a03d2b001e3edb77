//! Reads a glTF file, as JSON or as GLB. Behind the first zero byte of JSON follows its file `scene.bin` or
//! `scene.png`.
#![no_main]

use asvgf::scene;
use asvgf_fuzz::{files, split};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    let (description, data) = split(input);
    let files = files([("scene.gltf", description), ("scene.bin", data), ("scene.png", data)]);
    if let Ok(loaded) = scene::load_from_memory(&files, "scene.gltf") {
        loaded.scene.validate().expect("what was loaded keeps the rules");
        let pose = loaded.scene.pose(Some(0), 0.4);
        assert_eq!(pose.world.len(), loaded.scene.nodes.len());
    }
});
