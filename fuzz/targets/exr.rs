//! An EXR file, and the layers that the example `denoise` finds in it.
#![no_main]

#[allow(dead_code, reason = "shared with the example, which uses the rest")]
#[path = "../../examples/support/layers.rs"]
mod layers;

use asvgf::image_io;
use layers::{Layer, Names};
use libfuzzer_sys::fuzz_target;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// A file of this process alone, in memory where there is a file system for that.
static FILE: LazyLock<PathBuf> = LazyLock::new(|| {
    let root = if Path::new("/dev/shm").is_dir() { PathBuf::from("/dev/shm") } else { std::env::temp_dir() };
    root.join(format!("asvgf-fuzz-{}.exr", std::process::id()))
});

fuzz_target!(|input: &[u8]| {
    fs::write(&*FILE, input).expect("a file to write");
    let Ok(image) = image_io::read_exr(&*FILE) else { return };
    let area = image.width as usize * image.height as usize;
    assert!(area > 0 && image.channels.iter().all(|(_, samples)| samples.len() == area));
    for layer in Layer::ALL {
        if let Ok(Some(place)) = layers::find(layer, &Names::new(), &image) {
            assert_eq!(place.channels.len(), layer.components().len());
        }
    }
});
