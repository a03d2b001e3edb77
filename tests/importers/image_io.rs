//! EXR and PNG files.

use asvgf::image_io::{Channels, read_exr, read_png, write_exr, write_exr_rgb, write_png};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage as _, f16,
};

use crate::common::*;

fn files(folder: &Folder) -> Vec<String> {
    let mut files: Vec<_> = std::fs::read_dir(&folder.0).unwrap().map(|entry| name(&entry.unwrap().path())).collect();
    files.sort();
    files
}

#[test]
fn named_channels_survive_unchanged() {
    let folder = Folder::new();
    let path = folder.0.join("frame.exr");
    let samples = vec![0.0, -1.5, f32::INFINITY, 1e-40, 3.25, 1e30];
    let channels = ["B", "G", "R", "Z", "albedo.R", "motion.x"].map(|name| (name.to_owned(), samples.clone())).to_vec();
    let image = Channels { width: 3, height: 2, channels };
    write_exr(&path, &image).unwrap();
    let read = read_exr(&path).unwrap();
    assert_eq!(read, image);
    assert_eq!(read.get("albedo.R"), Some(samples.as_slice()));
    assert_eq!(read.get("albedo.G"), None);
    // Written again in its place, and nothing else left behind.
    write_exr_rgb(&path, 1, 1, &[[1.0, 2.0, 3.0]]).unwrap();
    assert_eq!(read_exr(&path).unwrap().get("G"), Some([2.0].as_slice()));
    assert_eq!(files(&folder), ["frame.exr"]);
}

#[test]
fn half_floats_integers_and_parts() {
    let folder = Folder::new();
    let path = folder.0.join("parts.exr");
    let layer = |name: &str, channels: Vec<AnyChannel<FlatSamples>>| {
        Layer::new((2, 1), LayerAttributes::named(name), Encoding::FAST_LOSSLESS, AnyChannels::sort(channels.into()))
    };
    let half = |name: &str| AnyChannel::new(name, FlatSamples::F16(vec![f16::from_f32(0.5), f16::from_f32(2.0)]));
    let id = AnyChannel::new("id", FlatSamples::U32(vec![7, 9]));
    let image =
        Image::empty(exr::meta::header::ImageAttributes::new(exr::prelude::IntegerBounds::from_dimensions((2, 1))))
            .with_layer(layer("beauty", vec![half("R"), id]))
            .with_layer(layer("albedo", vec![half("R"), half("albedo.G")]));
    image.write().to_file(&path).unwrap();
    let read = read_exr(&path).unwrap();
    let mut names: Vec<_> = read.channels.iter().map(|(name, _)| name.as_str()).collect();
    names.sort_unstable();
    assert_eq!(names, ["R", "albedo.G", "albedo.R", "id"]);
    assert_eq!(read.get("R"), Some([0.5, 2.0].as_slice()));
    assert_eq!(read.get("id"), Some([7.0, 9.0].as_slice()));
}

#[test]
fn png_files_survive_unchanged() {
    let folder = Folder::new();
    let path = folder.0.join("picture.png");
    let pixels = [[1, 2, 3, 4], [255, 0, 0, 255]];
    write_png(&path, 2, 1, &pixels).unwrap();
    assert_eq!(read_png(&path).unwrap(), (2, 1, pixels.to_vec()));
    assert_eq!(files(&folder), ["picture.png"]);
}

#[test]
fn nothing_is_written_that_could_not_be_read() {
    let folder = Folder::new();
    let path = folder.0.join("bad.exr");
    let image = |width, height, channels: &[(&str, usize)]| Channels {
        width,
        height,
        channels: channels.iter().map(|&(name, length)| (name.to_owned(), vec![0.0; length])).collect(),
    };
    for (image, reason) in [
        (image(0, 1, &[("R", 0)]), "0 pixels a side"),
        (image(20_000, 1, &[("R", 20_000)]), "20000 pixels a side"),
        (image(1, 1, &[]), "no channels"),
        (image(2, 1, &[("R", 1)]), "channel R has 1 samples, where 2 belong"),
        (image(1, 1, &[("R", 1), ("R", 1)]), "\"R\" is used twice"),
        (image(1, 1, &[("", 1)]), "cannot be the name"),
        (image(1, 1, &[("日本", 1)]), "cannot be the name"),
    ] {
        let error = write_exr(&path, &image).unwrap_err();
        assert!(error.file.ends_with("bad.exr") && error.reason.contains(reason), "{error}");
    }
    assert!(write_png(&path, 2, 2, &[[0; 4]; 3]).unwrap_err().reason.contains("3 pixels, where 4 belong"));
    assert!(write_png(folder.0.join("no/such/folder.png"), 1, 1, &[[0; 4]]).unwrap_err().reason.contains("written"));
    assert!(files(&folder).is_empty());
}

#[test]
fn broken_files_are_errors() {
    let folder = Folder::new();
    let path = folder.0.join("whole.exr");
    write_exr_rgb(&path, 4, 4, &[[0.5; 3]; 16]).unwrap();
    let whole = std::fs::read(&path).unwrap();
    for length in (0..whole.len()).step_by(7) {
        assert!(read_exr(folder.write("cut.exr", &whole[..length])).is_err(), "{length} of {} bytes", whole.len());
    }
    for at in 0..whole.len() {
        let mut changed = whole.clone();
        changed[at] ^= 0x55;
        let path = folder.write("changed.exr", changed);
        assert!(std::panic::catch_unwind(|| read_exr(path).is_ok()).is_ok(), "panic with byte {at} changed");
    }
    assert!(read_exr(folder.0.join("absent.exr")).unwrap_err().reason.contains("cannot be read"));
    assert!(read_png(folder.write("no.png", "no")).unwrap_err().reason.contains("cannot be decoded"));
}
