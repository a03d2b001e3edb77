//! A glTF file, as JSON or as GLB; what it refers to must be within it.
#![no_main]

use asvgf::scene;
use asvgf_fuzz::Folder;
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

static FOLDER: LazyLock<Folder> = LazyLock::new(|| Folder::new("gltf"));

fuzz_target!(|input: &[u8]| {
    if let Ok(loaded) = scene::load(FOLDER.write("scene.gltf", input)) {
        loaded.scene.validate().expect("what was loaded keeps the rules");
        let pose = loaded.scene.pose(Some(0), 0.4);
        assert_eq!(pose.world.len(), loaded.scene.nodes.len());
    }
});
