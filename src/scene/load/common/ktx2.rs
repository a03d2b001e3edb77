//! KTX2 textures without compression.

use ktx2::{Format, Reader, SupercompressionScheme};

use crate::image_io::MAX_SIDE;
use crate::scene::description::Image;

/// Decodes the largest level of a two-dimensional texture. The error is a reason.
pub(super) fn decode(name: &str, bytes: &[u8]) -> Result<Image, String> {
    const ONLY: &str = "only uncompressed formats of 8 bits a channel are read";
    let reader = Reader::new(bytes).map_err(|error| format!("is not a sound KTX2 file: {error:?}"))?;
    let header = reader.header();
    if let Some(scheme) = header.supercompression_scheme {
        return Err(format!("is a KTX2 file with the supercompression {}; {ONLY}", scheme_name(scheme)));
    }
    let order = header.format.and_then(channels).ok_or_else(|| match header.format {
        Some(format) => format!("is a KTX2 file of the format {format:?}; {ONLY}"),
        None => format!("is a KTX2 file of a format without a number (Basis Universal?); {ONLY}"),
    })?;
    let (width, height) = (header.pixel_width, header.pixel_height);
    let side = 1..=MAX_SIDE as u32;
    if height == 0 || header.pixel_depth > 0 || header.layer_count > 1 || header.face_count != 1 {
        return Err("is a KTX2 file of another shape than one flat picture".into());
    }
    if !side.contains(&width) || !side.contains(&height) {
        return Err(format!("is {width} × {height} texels large; 1 to {MAX_SIDE} a side are read"));
    }
    let level = reader.levels().next().map(|level| level.data).unwrap_or_default();
    let texels: Vec<[u8; 4]> = level.chunks_exact(order.len()).map(|texel| rgba(texel, order)).collect();
    let count = width as usize * height as usize;
    if texels.len() < count {
        return Err(format!("is a KTX2 file of {width} × {height} texels with data for {}", texels.len()));
    }
    let mut texels: Vec<[u8; 4]> = texels.into_iter().take(count).collect();
    for (key, value) in reader.key_value_data() {
        match key {
            "KTXswizzle" => swizzle(&mut texels, value),
            "KTXorientation" => turn(&mut texels, width as usize, value),
            _ => {}
        }
    }
    Ok(Image { name: name.into(), width, height, texels })
}

/// Reorders channels as the file says: `rgba`, `rrr1`.
fn swizzle(texels: &mut [[u8; 4]], places: &[u8]) {
    let Some(places) = places.first_chunk::<4>() else { return };
    for texel in texels {
        *texel = places.map(|place| match place {
            b'g' => texel[1],
            b'b' => texel[2],
            b'a' => texel[3],
            b'0' => 0,
            b'1' => 255,
            _ => texel[0],
        });
    }
}

/// Reverses rows that go up (`ru`) and columns that go left (`ld`).
fn turn(texels: &mut [[u8; 4]], width: usize, orientation: &[u8]) {
    if orientation.first() == Some(&b'l') {
        texels.chunks_exact_mut(width).for_each(<[_]>::reverse);
    }
    if orientation.get(1) == Some(&b'u') {
        let height = texels.len() / width;
        for row in 0..height / 2 {
            let (above, below) = texels.split_at_mut((height - 1 - row) * width);
            above[row * width..(row + 1) * width].swap_with_slice(&mut below[..width]);
        }
    }
}

/// The channel of each byte of a texel, 0 to 3 for red to alpha.
fn channels(format: Format) -> Option<&'static [usize]> {
    Some(match format {
        Format::R8_UNORM | Format::R8_SRGB => &[0],
        Format::R8G8_UNORM | Format::R8G8_SRGB => &[0, 1],
        Format::R8G8B8_UNORM | Format::R8G8B8_SRGB => &[0, 1, 2],
        Format::B8G8R8_UNORM | Format::B8G8R8_SRGB => &[2, 1, 0],
        Format::R8G8B8A8_UNORM | Format::R8G8B8A8_SRGB => &[0, 1, 2, 3],
        Format::B8G8R8A8_UNORM | Format::B8G8R8A8_SRGB => &[2, 1, 0, 3],
        _ => return None,
    })
}

fn rgba(texel: &[u8], order: &[usize]) -> [u8; 4] {
    let mut rgba = [0, 0, 0, 255];
    for (&byte, &channel) in texel.iter().zip(order) {
        rgba[channel] = byte;
    }
    rgba
}

fn scheme_name(scheme: SupercompressionScheme) -> &'static str {
    match scheme {
        SupercompressionScheme::BasisLZ => "BasisLZ",
        SupercompressionScheme::Zstandard => "Zstandard",
        SupercompressionScheme::ZLIB => "zlib",
        _ => "of an unknown kind",
    }
}
