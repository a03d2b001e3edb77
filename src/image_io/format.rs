//! Kinds of image files.

use image::ImageFormat;

/// The decoder of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Format {
    /// The `image` crate.
    Image(ImageFormat),
    Ktx2,
}

/// Finds the decoder of a file from its first bytes. The error is a reason.
pub(crate) fn recognise(start: &[u8]) -> Result<Format, String> {
    const ONLY: &str = "only PNG, JPEG, TGA, BMP, TIFF, WebP and KTX2 are read";
    use ImageFormat::{Bmp, Jpeg, Png, Tiff, WebP};
    match image::guess_format(start) {
        Ok(format @ (Png | Jpeg | Bmp | Tiff | WebP)) => Ok(Format::Image(format)),
        Ok(other) => Err(format!("is a {} file; {ONLY}", other.extensions_str().first().unwrap_or(&"different"))),
        Err(_) if start.starts_with(b"\xABKTX 20\xBB") => Ok(Format::Ktx2),
        Err(_) if start.starts_with(b"\xABKTX") => Err(format!("is a KTX 1 file; {ONLY}")),
        Err(_) if is_tga(start) => Ok(Format::Image(ImageFormat::Tga)),
        Err(_) => Err(format!("is not an image in a known format; {ONLY}")),
    }
}

/// Recognises a TGA file. These have no signature, but their header is one that no text and none of the other formats has.
fn is_tga(start: &[u8]) -> bool {
    let Some(&[_, map, kind, _, _, _, _, map_depth, _, _, _, _, w0, w1, h0, h1, depth, flags]) =
        start.first_chunk::<18>()
    else {
        return false;
    };
    let mapped = matches!((map, kind), (1, 1 | 9)) && matches!(map_depth, 15 | 16 | 24 | 32);
    let direct = matches!((map, kind), (0 | 1, 2 | 3 | 10 | 11));
    let sized = w0 | w1 != 0 && h0 | h1 != 0;
    (mapped || direct) && sized && matches!(depth, 8 | 15 | 16 | 24 | 32) && flags & 0xC0 == 0
}
