//! Reads an EXR file, finds the layers of the program `denoise` in it, and writes the file again.
#![no_main]

#[allow(dead_code, reason = "shared with the programs, which use the rest")]
#[path = "../../programs/src/sequence/layers.rs"]
mod layers;

use asvgf::image_io::ExrFile;
use layers::{Layer, Names};
use libfuzzer_sys::fuzz_target;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// File of this process alone, in memory if there is a file system for that.
static FILE: LazyLock<PathBuf> = LazyLock::new(|| {
    let root = if Path::new("/dev/shm").is_dir() { PathBuf::from("/dev/shm") } else { std::env::temp_dir() };
    root.join(format!("asvgf-fuzz-{}.exr", std::process::id()))
});

fuzz_target!(|input: &[u8]| {
    fs::write(&*FILE, input).expect("a file to write");
    let Ok(mut file) = ExrFile::read(&*FILE) else { return };
    let (image, window) = (file.channels(), file.data_window());
    assert_eq!([image.width, image.height], window.size);
    let area = image.width as usize * image.height as usize;
    assert!(area > 0 && image.channels.iter().all(|(_, samples)| samples.len() == area));
    for name in ["worldToCamera", "worldToNDC", "screenWindowWidth", "Camera"] {
        let _ = file.attribute(name);
    }
    let Ok(places) = layers::find(&Names::new(), None, &image) else { return };
    for (layer, place) in Layer::ALL.into_iter().zip(&places.of) {
        assert!(place.as_ref().is_none_or(|place| place.channels.len() == layer.components().len()));
    }
    // Writing as `denoise` does it, with and without the other channels, either works or returns a reason.
    let first = &image.channels[0];
    let _ = file.with_channels(&first.0, &[("R".to_owned(), first.1.clone())]).write(&*FILE);
    file.replace(&image.channels[..1]);
    let _ = file.write(&*FILE);
});
