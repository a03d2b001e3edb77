//! Errors in a sequence are found and named before anything is written.

use crate::folder::{Folder, add, wall};
use asvgf_programs::sequence::layers::Layer;
use std::fs;

#[track_caller]
fn assert_refused(folder: &Folder, file: &str, reason: &str) {
    let error = folder.open().map(|s| s.layers).expect_err(reason).to_string();
    assert!(error.contains(file) && error.contains(reason), "«{error}» is not about {file}: {reason}");
}

#[test]
fn a_whole_sequence_is_accepted() {
    let sequence = Folder::with_frames().open().unwrap();
    assert_eq!((sequence.frames(), sequence.files[2].number, sequence.size), (3, 2, [6, 4]));
    assert_eq!(sequence.layers, [Layer::Color, Layer::Normal, Layer::Depth]);
}

#[test]
fn no_folder_and_no_frames() {
    let folder = Folder::new();
    assert_refused(&folder, &folder.0.display().to_string(), "there are no frames");
    fs::remove_dir(&folder.0).unwrap();
    assert_refused(&folder, &folder.0.display().to_string(), "cannot be read");
}

#[test]
fn mixed_sizes() {
    let folder = Folder::with_frames();
    folder.write(2, &wall([4, 6]));
    assert_refused(&folder, "frame_0002.exr", "is 4×6 pixels, and frame_0000.exr is 6×4");
}

#[test]
fn absent_channels() {
    let folder = Folder::with_frames();
    let mut image = wall([6, 4]);
    image.channels.retain(|(name, _)| !["R", "G", "B"].contains(&name.as_str()));
    folder.write(0, &image);
    assert_refused(&folder, "frame_0000.exr", "there is no channel R, G, B");
    assert_refused(&folder, "frame_0000.exr", "say --map color=NAME");
    let folder = Folder::with_frames();
    let mut image = wall([6, 4]);
    add(&mut image, Layer::Albedo, &[0.5; 3]);
    image.channels.retain(|(name, _)| name != "albedo.G");
    folder.write(0, &image);
    assert_refused(&folder, "frame_0000.exr", "there is no channel albedo.G beside albedo.R");
}

#[test]
fn layers_that_only_some_frames_have() {
    let folder = Folder::with_frames();
    let mut image = wall([6, 4]);
    add(&mut image, Layer::Albedo, &[0.5; 3]);
    folder.write(1, &image);
    assert_refused(&folder, "frame_0001.exr", "has albedo.R, albedo.G, albedo.B, which frame_0000.exr has not");
    folder.write(0, &image);
    assert_refused(
        &folder,
        "frame_0002.exr",
        "there is no channel albedo.R, albedo.G, albedo.B, which frame_0000.exr has",
    );
}

#[test]
fn half_a_gradient() {
    let folder = Folder::with_frames();
    let mut image = wall([6, 4]);
    add(&mut image, Layer::GradientCurrent, &[0.5; 3]);
    folder.write(0, &image);
    assert_refused(&folder, "frame_0000.exr", "only mean something together");
}

#[test]
fn truncated_files() {
    let folder = Folder::with_frames();
    let path = folder.0.join("frame_0002.exr");
    let whole = fs::read(&path).unwrap();
    for length in [0, 10, whole.len() / 2, whole.len() - 1] {
        fs::write(&path, &whole[..length]).unwrap();
        assert_refused(&folder, "frame_0002.exr", "is no EXR file, or is damaged or cut short");
    }
}

#[test]
fn a_manifest_that_does_not_fit() {
    let folder = Folder::with_frames();
    let refused = |text: &str, reason: &str| {
        fs::write(folder.0.join("manifest.json"), text).unwrap();
        assert_refused(&folder, "manifest.json", reason);
    };
    refused("{", "EOF");
    refused(r#"{"cameras": []}"#, "has 0 cameras for 3 frames");
    refused(r#"{"cameras": [{}, {}, {}]}"#, "camera 0: th must be a number above 0");
    refused(r#"{"cameras": [{"th": 1, "o": [0, 1]}, {}, {}]}"#, "camera 0: o must be three numbers");
}
