//! Environment maps from files.

mod exr;
mod picture;
mod primaries;
mod radiance;

use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageReader};

use crate::image_io::{Format, limits, read_file, recognise};
use crate::scene::description::linear_from_srgb;
use crate::scene::description::{Environment, SceneError, Warning};
use picture::{Picture, clean, odd_shape};

impl Environment {
    /// Reads an equirectangular image. Its first bytes decide the format, whatever its name is:
    ///
    /// * Radiance HDR holds linear radiance: RGBE or XYZE, signed or not, in any of the eight orientations, with `EXPOSURE`, `COLORCORR`
    ///   and `PRIMARIES`.
    /// * EXR holds linear radiance: colours, or luminance and chroma. Chromaticities are converted to Rec. 709, and the data window is
    ///   placed in the display window.
    /// * PNG, JPEG, TGA, BMP, TIFF and WebP count as sRGB with 1 as the largest radiance, floating-point TIFF as linear.
    ///
    /// Negative channels and NaN become 0, infinity becomes 65504, each with a warning that gives their number.
    ///
    /// # Errors
    ///
    /// Names the file if it cannot be read or decoded, has more than 16384 texels a side, or is an EXR file without colours.
    pub fn load(path: impl AsRef<Path>) -> Result<(Self, Vec<Warning>), SceneError> {
        let path = path.as_ref();
        let error =
            |reason: String| SceneError { file: path.display().to_string(), element: "environment".into(), reason };
        let (mut environment, mut reasons) = read(path).map_err(error)?;
        reasons.extend(clean(&mut environment.radiance, true));
        reasons.extend(odd_shape(environment.width, environment.height));
        let warning = |reason| Warning { element: "environment".into(), reason };
        Ok((environment, reasons.into_iter().map(warning).collect()))
    }
}

fn read(path: &Path) -> Result<Picture, String> {
    let bytes = read_file(path)?;
    if bytes.starts_with(b"\x76\x2F\x31\x01") {
        drop(bytes);
        return exr::read(path);
    }
    if radiance::is_radiance(&bytes) {
        return radiance::read(&bytes);
    }
    let format = match recognise(&bytes)? {
        Format::Image(format) => format,
        Format::Ktx2 => return Err("is a KTX2 file, which is not read as an environment".into()),
    };
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits());
    let image = reader.decode().map_err(|error| format!("cannot be decoded: {error}"))?;
    let linear = matches!(image, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_));
    let image = image.into_rgb32f();
    let radiance = image.pixels().map(|texel| if linear { texel.0 } else { texel.0.map(linear_from_srgb) }).collect();
    Ok((Environment { width: image.width(), height: image.height(), radiance }, Vec::new()))
}
