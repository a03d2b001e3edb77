//! Environment maps.

use std::fs::File;

use exr::meta::attribute::Chromaticities;

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
fn exr_files_are_cleaned_channel_by_channel() {
    let folder = Folder::new();
    let path = folder.0.join("sky.exr");
    const INFINITY: f32 = f32::INFINITY;
    let texels = [
        [1.0, 2.0, 3.0],
        [f32::NAN, 0.5, 0.0],
        [0.0, -1.0, 5.0],
        [INFINITY, 1.0, -INFINITY],
        [0.0, 0.0, 9e9],
        [0.0; 3],
    ];
    image_io::write_exr_rgb(&path, 3, 2, &texels).unwrap();
    let (environment, warnings) = Environment::load(&path).unwrap();
    let said: Vec<&str> = warnings.iter().map(|warning| warning.reason.as_str()).collect();
    let expected =
        ["1 channels of texels are no number", "2 channels of texels are negative", "1 channels of texels are inf"];
    assert!(said.iter().zip(expected).all(|(said, part)| said.starts_with(part)) && said.len() == 3, "{said:?}");
    let cleaned = [texels[0], [0.0, 0.5, 0.0], [0.0, 0.0, 5.0], [65504.0, 1.0, 0.0], texels[4], [0.0; 3]];
    assert_eq!(environment.radiance, cleaned);
}

#[test]
fn luminance_and_chroma_are_colours() {
    let path = Folder::new().0.join("yc.exr");
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    // Y = 0.2126 R + 0.7152 G + 0.0722 B, RY = (R − Y)/Y, BY = (B − Y)/Y.
    let color = [4.0_f32, 0.5, 0.25];
    let y = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
    let channels =
        [("BY", (color[2] - y) / y), ("RY", (color[0] - y) / y), ("Y", y)].map(|(name, x)| (name.into(), vec![x]));
    let image = image_io::Channels { width: 1, height: 1, channels: channels.into() };
    image_io::write_exr(&path, &image).unwrap();
    assert_close(&Environment::load(&path).unwrap().0.radiance[0], &color, 1e-3);
}

/// Writes rows 2 and 3 of a picture of four rows, in these primaries.
fn write_exr_with(path: &std::path::Path, color: [f32; 3], chromaticities: Option<Chromaticities>) {
    use exr::prelude::*;
    let attributes = LayerAttributes { layer_position: Vec2(0, 2), ..LayerAttributes::default() };
    let channels = SpecificChannels::rgb(|_: Vec2<usize>| (color[0], color[1], color[2]));
    let mut image = Image::from_layer(Layer::new((2, 2), attributes, Encoding::UNCOMPRESSED, channels));
    image.attributes.display_window = IntegerBounds::from_dimensions((2, 4));
    image.attributes.chromaticities = chromaticities;
    image.write().to_file(path).unwrap();
}

#[test]
fn a_data_window_is_placed_in_the_display_window() {
    let folder = Folder::new();
    let path = folder.0.join("window.exr");
    write_exr_with(&path, [1.0, 2.0, 3.0], None);
    let (environment, warnings) = Environment::load(&path).unwrap();
    assert!(warnings.is_empty());
    assert_eq!((environment.width, environment.height), (2, 4));
    assert_eq!(environment.radiance, [[[0.0; 3]; 4], [[1.0, 2.0, 3.0]; 4]].concat());
}

#[test]
fn chromaticities_are_converted() {
    use exr::prelude::Vec2;
    let folder = Folder::new();
    let path = folder.0.join("p3.exr");
    // Display P3 has the white of Rec. 709; its red is beyond that of Rec. 709 (SMPTE EG 432-1).
    let p3 = Chromaticities {
        red: Vec2(0.68, 0.32),
        green: Vec2(0.265, 0.69),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.3290),
    };
    write_exr_with(&path, [0.5, 0.5, 0.5], Some(p3));
    assert_close(&Environment::load(&path).unwrap().0.radiance[4], &[0.5; 3], 1e-5);
    write_exr_with(&path, [0.0, 0.5, 0.0], Some(p3));
    // P3 green in Rec. 709 is (−0.2249, 1.0421, −0.0786) per unit; negative values become 0.
    assert_close(&Environment::load(&path).unwrap().0.radiance[4], &[0.0, 0.52103, 0.0], 1e-3);
}

#[test]
fn a_layer_with_colours_is_found_and_named() {
    let folder = Folder::new();
    let path = folder.0.join("layers.exr");
    let channels = ["Combined.B", "Combined.G", "Combined.R", "Z"];
    let channels = channels.iter().enumerate().map(|(index, &name)| (name.to_owned(), vec![index as f32])).collect();
    image_io::write_exr(&path, &image_io::Channels { width: 1, height: 1, channels }).unwrap();
    let (environment, warnings) = Environment::load(&path).unwrap();
    assert_eq!(environment.radiance, [[2.0, 1.0, 0.0]]);
    assert!(warnings[0].reason.contains("Combined.R"), "{warnings:?}");
}

/// A Radiance picture of 3 × 2 texels without run lengths, whose texels have the mantissas of `texel`.
fn hdr(header: &str, texels: &[[u8; 4]]) -> Vec<u8> {
    [header.as_bytes(), texels.as_flattened()].concat()
}

#[test]
fn hdr_pictures_of_all_eight_orientations_are_upright() {
    let folder = Folder::new();
    // Texel (x, y) has the red x + 1 and the green y + 1. The mantissas are multiples of eight, because two ones would begin a run.
    let texel = |x: usize, y: usize| [8 * (x as u8 + 1), 8 * (y as u8 + 1), 0, 133];
    let (width, height) = (3, 2);
    for y_sign in ['-', '+'] {
        for x_sign in ['+', '-'] {
            let x_of = |at: usize| if x_sign == '+' { at } else { width - 1 - at };
            let y_of = |at: usize| if y_sign == '-' { at } else { height - 1 - at };
            let rows: Vec<_> = (0..height).flat_map(|y| (0..width).map(move |x| texel(x_of(x), y_of(y)))).collect();
            let columns: Vec<_> = (0..width).flat_map(|x| (0..height).map(move |y| texel(x_of(x), y_of(y)))).collect();
            for (size, texels) in [
                (format!("{y_sign}Y {height} {x_sign}X {width}"), rows),
                (format!("{x_sign}X {width} {y_sign}Y {height}"), columns),
            ] {
                let path = folder.write("turned.hdr", hdr(&format!("#?RADIANCE\n\n{size}\n"), &texels));
                let (environment, warnings) = Environment::load(path).unwrap();
                assert!(warnings.is_empty());
                assert_eq!((environment.width, environment.height), (3, 2), "{size}");
                for (at, radiance) in environment.radiance.iter().enumerate() {
                    let expected = [(at % 3 + 1) as f32, (at / 3 + 1) as f32, 0.0];
                    assert_close(radiance, &expected, 1e-6);
                }
            }
        }
    }
}

#[test]
fn hdr_headers_of_every_kind() {
    let folder = Folder::new();
    let texel = [[64, 128, 32, 129]]; // 0.5, 1, 0.25
    let read = |header: &str| {
        let path = folder.write("sky.hdr", hdr(&format!("{header}-Y 1 +X 1\n"), &texel));
        Environment::load(path).map(|(environment, _)| environment.radiance[0])
    };
    for (header, expected) in [
        ("#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n", [0.5, 1.0, 0.25]),
        ("FORMAT=32-bit_rle_rgbe\n\n", [0.5, 1.0, 0.25]),
        ("#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n", [0.5, 1.0, 0.25]),
        ("#?RADIANCE\n# a comment\nrpict -vf x.vf\nEXPOSURE=2\nEXPOSURE= 4.0\n\n", [0.0625, 0.125, 0.03125]),
        ("#?RADIANCE\nCOLORCORR= 2 4 1\nEXPOSURE=0.5\n\n", [0.5, 0.5, 0.5]),
        // The primaries of Rec. 709 change nothing.
        ("#?RADIANCE\nPRIMARIES= .64 .33 .3 .6 .15 .06 .3127 .329\n\n", [0.5, 1.0, 0.25]),
    ] {
        assert_close(&read(header).unwrap(), &expected, 1e-5);
    }
    assert!(read("#?RADIANCE\nFORMAT=32-bit_rle_luv\n\n").unwrap_err().reason.contains("32-bit_rle_luv"));

    // X = Y = Z is white, and stays white.
    let path =
        folder.write("xyz.hdr", hdr("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n", &[[128, 128, 128, 129]]));
    assert_close(&Environment::load(path).unwrap().0.radiance[0], &[1.0; 3], 2e-3);
}

#[test]
fn a_newer_compression_is_named() {
    let folder = Folder::new();
    let path = folder.0.join("sky.exr");
    image_io::write_exr_rgb(&path, 1, 1, &[[1.0; 3]]).unwrap();
    let mut bytes = std::fs::read(&path).unwrap();
    let name = b"compression\0compression\0\x01\0\0\0";
    let at = bytes.windows(name.len()).position(|window| window == name).unwrap() + name.len();
    bytes[at] = 10;
    let error = Environment::load(folder.write("new.exr", bytes)).unwrap_err();
    assert!(error.reason.contains("HTJ2K"), "{error}");
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
        (folder.write("sky.tif", ""), "not an image in a known format"),
        (folder.write("sky.hdr", "not an image"), "not an image in a known format"),
        (folder.write("cut.hdr", "#?RADIANCE\n\n-Y 10 +X 10\n1234"), "cannot be decoded"),
        (folder.write("sky.exr", "not an image"), ""),
        (folder.0.join("absent.hdr"), "cannot be read"),
    ] {
        let error = Environment::load(&path).unwrap_err();
        assert!(error.file.ends_with(&name(&path)) && error.reason.contains(reason), "{error}");
    }
}
