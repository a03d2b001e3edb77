//! An EXR file, and the layers that the example `denoise` finds in it.
#![no_main]

#[allow(dead_code, reason = "shared with the example, which uses the rest")]
#[path = "../../examples/support/layers.rs"]
mod layers;

use asvgf::image_io;
use asvgf_fuzz::Folder;
use layers::{Layer, Names};
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

static FOLDER: LazyLock<Folder> = LazyLock::new(|| Folder::new("exr"));

fuzz_target!(|input: &[u8]| {
    let Ok(image) = image_io::read_exr(FOLDER.write("frame.exr", input)) else { return };
    let area = image.width as usize * image.height as usize;
    assert!(area > 0 && image.channels.iter().all(|(_, samples)| samples.len() == area));
    for layer in Layer::ALL {
        if let Ok(Some(place)) = layers::find(layer, &Names::new(), &image) {
            assert_eq!(place.channels.len(), layer.components().len());
        }
    }
});
