//! Environment maps.

use std::fs::File;

use asvgf::image_io;
use asvgf::scene::Environment;

use crate::common::*;

#[test]
fn hdr_files_hold_linear_radiance() {
    let folder = Folder::new();
    let path = folder.0.join("sky.hdr");
    let texels = [[0.5, 1.0, 64.0], [0.0, 0.25, 2.0]].map(image::Rgb);
    image::codecs::hdr::HdrEncoder::new(File::create(&path).unwrap()).encode(&texels, 2, 1).unwrap();
    let (environment, warnings) = Environment::load(&path).unwrap();
    assert!(warnings.is_empty());
    assert_eq!((environment.width, environment.height), (2, 1));
    assert_close(environment.radiance.as_flattened(), &[0.5, 1.0, 64.0, 0.0, 0.25, 2.0], 0.3);
}

#[test]
fn exr_files_are_cleaned() {
    let folder = Folder::new();
    let path = folder.0.join("sky.exr");
    let texels =
        [[1.0, 2.0, 3.0], [f32::NAN, 0.0, 0.0], [0.0, -1.0, 5.0], [f32::INFINITY, 0.0, 0.0], [0.0, 0.0, 9e9], [0.0; 3]];
    image_io::write_exr_rgb(&path, 3, 2, &texels).unwrap();
    let (environment, warnings) = Environment::load(&path).unwrap();
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].reason.contains("3 texels"), "{warnings:?}");
    assert_eq!(environment.radiance, [texels[0], [0.0; 3], [0.0; 3], [0.0; 3], texels[4], [0.0; 3]]);
}

#[test]
fn png_files_are_srgb() {
    let folder = Folder::new();
    let path = folder.write("sky.png", png(1, 1, [255, 0, 188, 255]));
    let (environment, _) = Environment::load(path).unwrap();
    assert_close(&environment.radiance[0], &[1.0, 0.0, 0.5029], 1e-3);
}

#[test]
fn errors_name_the_file() {
    let folder = Folder::new();
    let exr = folder.0.join("depth.exr");
    let channels = vec![("Z".into(), vec![1.0])];
    image_io::write_exr(&exr, &image_io::Channels { width: 1, height: 1, channels }).unwrap();
    for (path, reason) in [
        (exr, "no channels R, G and B"),
        (folder.write("sky.tif", ""), "unknown extension"),
        (folder.write("sky.hdr", "not an image"), "cannot be decoded"),
        (folder.write("sky.exr", "not an image"), ""),
        (folder.0.join("absent.hdr"), "cannot be read"),
    ] {
        let error = Environment::load(&path).unwrap_err();
        assert!(error.file.ends_with(&name(&path)) && error.reason.contains(reason), "{error}");
    }
}
