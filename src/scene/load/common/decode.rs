//! Texture images: PNG, JPEG, TGA, BMP, TIFF, WebP and uncompressed KTX2 to 8-bit RGBA.

use std::io::Cursor;

use image::{ImageFormat, ImageReader};

use super::ktx2;
use super::recognise::foreign;
use crate::image_io::{Format, limits, recognise};
use crate::scene::description::Image;

/// Decodes an image file. The error is a reason.
pub(crate) fn decode(name: &str, bytes: &[u8]) -> Result<Image, String> {
    let format = match recognise(bytes).map_err(|reason| foreign(bytes).map_or(reason, str::to_owned))? {
        Format::Ktx2 => return ktx2::decode(name, bytes),
        Format::Image(format) => format,
    };
    // The decoder would fill the missing part with a colour of its own.
    if format == ImageFormat::Jpeg && !bytes.windows(2).rev().take(bytes.len() / 2).any(|pair| pair == [0xFF, 0xD9]) {
        return Err("is cut short: the end of the JPEG is not there".into());
    }
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits());
    let texels = reader.decode().map_err(|error| format!("cannot be decoded: {error}"))?.into_rgba8();
    let (width, height) = texels.dimensions();
    let (texels, _) = texels.as_chunks::<4>();
    Ok(Image { name: name.into(), width, height, texels: texels.to_vec() })
}
