//! Images in every format that textures may have.

use std::io::Cursor;

use asvgf::scene::Loaded;
use image::{DynamicImage, ImageFormat, Rgba, RgbaImage};
use serde_json::json;

use crate::common::*;

/// Loads a triangle whose emission is an image file.
fn textured(name: &str, bytes: &[u8]) -> Loaded {
    let folder = Folder::new();
    folder.write(name, bytes);
    let mut gltf = Gltf::textured_triangle();
    gltf.push("images", json!({"uri": name}));
    gltf.push("textures", json!({"source": 0}));
    gltf.push("materials", json!({"emissiveTexture": {"index": 0}}));
    gltf.load_in(&folder).unwrap()
}

#[test]
fn texels_are_those_of_the_file() {
    let mut picture = RgbaImage::new(3, 2);
    for (x, y, texel) in picture.enumerate_pixels_mut() {
        *texel = Rgba([10 * x as u8, 100 * y as u8, 200, 255]);
    }
    for (format, name) in [
        (ImageFormat::Png, "a.png"),
        (ImageFormat::Bmp, "a.bmp"),
        (ImageFormat::Tga, "a.tga"),
        (ImageFormat::Tiff, "a.tiff"),
        (ImageFormat::WebP, "a.webp"),
        // The first bytes decide the format, whatever the name says.
        (ImageFormat::Tga, "a.png"),
        (ImageFormat::Png, "a.jpg"),
    ] {
        let mut bytes = Cursor::new(Vec::new());
        DynamicImage::ImageRgba8(picture.clone()).write_to(&mut bytes, format).unwrap();
        let loaded = textured(name, bytes.get_ref());
        assert_warnings(&loaded, &[]);
        let image = &loaded.scene.images[0];
        assert_eq!(
            (image.width, image.height, image.texels.as_flattened()),
            (3, 2, &picture.as_raw()[..]),
            "{format:?}"
        );
    }
}

/// A KTX2 file of one level (KTX 2.0 specification, section 3).
fn ktx2(format: u32, size: [u32; 2], supercompression: u32, data: &[u8]) -> Vec<u8> {
    const DATA: u32 = 80 + 24 + 4;
    let mut bytes = b"\xABKTX 20\xBB\r\n\x1A\n".to_vec();
    // The header: format, size of a type, width, height, depth, layers, faces, levels, supercompression.
    for word in [format, 1, size[0], size[1], 0, 0, 1, 1, supercompression] {
        bytes.extend(word.to_le_bytes());
    }
    // The index: data format descriptor, keys, global data.
    for word in [104_u32, 4, 0, 0, 0, 0, 0, 0] {
        bytes.extend(word.to_le_bytes());
    }
    for number in [u64::from(DATA), data.len() as u64, data.len() as u64] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(4_u32.to_le_bytes());
    bytes.extend(data);
    bytes
}

#[test]
fn ktx2_files_without_compression() {
    for (format, data, texels) in [
        (37_u32, &[1, 2, 3, 4, 5, 6, 7, 8][..], [[1, 2, 3, 4], [5, 6, 7, 8]]), // R8G8B8A8_UNORM
        (43, &[1, 2, 3, 4, 5, 6, 7, 8], [[1, 2, 3, 4], [5, 6, 7, 8]]),         // R8G8B8A8_SRGB
        (44, &[1, 2, 3, 4, 5, 6, 7, 8], [[3, 2, 1, 4], [7, 6, 5, 8]]),         // B8G8R8A8_UNORM
        (29, &[1, 2, 3, 4, 5, 6], [[1, 2, 3, 255], [4, 5, 6, 255]]),           // R8G8B8_SRGB
        (9, &[1, 2], [[1, 0, 0, 255], [2, 0, 0, 255]]),                        // R8_UNORM
    ] {
        let loaded = textured("a.ktx2", &ktx2(format, [2, 1], 0, data));
        assert_warnings(&loaded, &[]);
        assert_eq!(loaded.scene.images[0].texels, texels, "format {format}");
    }
}

#[test]
fn files_that_are_not_read_are_named() {
    let rgba = [0; 8];
    for (name, bytes, reason) in [
        ("a.ktx2", ktx2(43, [2, 1], 2, &rgba), "Zstandard"),
        ("a.ktx2", ktx2(0, [2, 1], 1, &rgba), "BasisLZ"),
        ("a.ktx2", ktx2(0, [2, 1], 0, &rgba), "Basis Universal"),
        ("a.ktx2", ktx2(145, [2, 1], 0, &rgba), "BC7"),
        ("a.ktx2", ktx2(43, [2, 2], 0, &rgba), "with data for 2"),
        ("a.ktx2", ktx2(43, [70_000, 1], 0, &rgba), "16384"),
        ("a.ktx", b"\xABKTX 11\xBB\r\n\x1A\n".to_vec(), "KTX 1"),
        ("a.dds", b"DDS ".to_vec(), "dds file"),
        ("a.gif", b"GIF89a".to_vec(), "gif file"),
        ("a.png", b"not an image".to_vec(), "not an image in a known format"),
    ] {
        assert_warnings(&textured(name, &bytes), &[("images[0]", reason)]);
    }
}
