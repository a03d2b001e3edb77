//! Texture images: PNG and JPEG to 8-bit RGBA.

use std::io::Cursor;

use image::{ImageFormat, ImageReader};

use crate::image_io::limits;
use crate::scene::description::Image;

/// Decodes a PNG or JPEG file. The error is a reason.
pub(crate) fn decode(name: &str, bytes: &[u8]) -> Result<Image, String> {
    let format = recognise(bytes)?;
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits());
    let texels = reader.decode().map_err(|error| format!("cannot be decoded: {error}"))?.into_rgba8();
    let (width, height) = texels.dimensions();
    let (texels, _) = texels.as_chunks::<4>();
    Ok(Image { name: name.into(), width, height, texels: texels.to_vec() })
}

/// Tells from the first bytes of a file whether it can be decoded. The error is a reason.
pub(crate) fn recognise(start: &[u8]) -> Result<ImageFormat, String> {
    const ONLY: &str = "only PNG and JPEG are read";
    match image::guess_format(start) {
        Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => Ok(format),
        Ok(other) => Err(format!("is a {} file; {ONLY}", other.extensions_str().first().unwrap_or(&"different"))),
        Err(_) if start.starts_with(b"\xABKTX") => Err(format!("is a KTX file; {ONLY}")),
        Err(_) => Err(format!("is not an image in a known format; {ONLY}")),
    }
}
