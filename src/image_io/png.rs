//! PNG files of 8-bit RGBA.

use std::io::Cursor;
use std::path::Path;

use image::{ImageFormat, ImageReader};

use crate::image_io::ImageError;
use crate::image_io::files::{area, limits, read_file, replace};

/// Writes 8-bit RGBA pixels, encoded as sRGB, as a PNG file.
///
/// # Errors
///
/// Fails for another number than `width · height` pixels, a size of 0 or above 16384, or a file that cannot be written.
pub fn write_png(path: impl AsRef<Path>, width: u32, height: u32, pixels: &[[u8; 4]]) -> Result<(), ImageError> {
    let path = path.as_ref();
    let error = |reason: String| ImageError::new(path, reason);
    let area = area(width, height).map_err(error)?;
    if pixels.len() != area {
        return Err(error(format!("{} pixels, where {area} belong", pixels.len())));
    }
    let mut bytes = Vec::new();
    let samples = pixels.as_flattened();
    let format = ImageFormat::Png;
    image::write_buffer_with_format(
        &mut Cursor::new(&mut bytes),
        samples,
        width,
        height,
        image::ColorType::Rgba8,
        format,
    )
    .map_err(|cause| error(cause.to_string()))?;
    replace(path, &bytes)
}

/// Reads a PNG file as 8-bit RGBA: width, height and pixels.
///
/// # Errors
///
/// Fails for a file that cannot be read, that is no PNG file, or that is larger than 16384 pixels a side.
pub fn read_png(path: impl AsRef<Path>) -> Result<(u32, u32, Vec<[u8; 4]>), ImageError> {
    let path = path.as_ref();
    let error = |reason: String| ImageError::new(path, reason);
    let bytes = read_file(path).map_err(error)?;
    let mut reader = ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png);
    reader.limits(limits());
    let image = reader.decode().map_err(|cause| error(format!("cannot be decoded: {cause}")))?.into_rgba8();
    let (width, height) = image.dimensions();
    Ok((width, height, image.as_chunks::<4>().0.to_vec()))
}
