//! Environment maps from files.

mod exr;
mod primaries;
mod radiance;

use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageReader};

use crate::image_io::{Format, limits, read_file, recognise};
use crate::scene::description::{Environment, SceneError, Warning};
pub(crate) use primaries::linear_from_srgb;

/// Radiance of a texel that is infinite: the largest 16-bit float, which is what most files of infinite suns were meant to hold.
const BRIGHTEST: f32 = 65504.0;

/// A picture, and what could not be honoured of it.
type Picture = (Environment, Vec<String>);

impl Environment {
    /// Reads an equirectangular image. Its first bytes decide how, whatever its name is:
    ///
    /// * Radiance HDR (RGBE or XYZE, signed or not, in any of the eight orientations, with `EXPOSURE`, `COLORCORR` and `PRIMARIES`) and
    ///   EXR (colours or luminance and chroma, chromaticities converted to Rec. 709, the data window placed in the display window) hold
    ///   linear radiance.
    /// * PNG, JPEG, TGA, BMP, TIFF and WebP are taken to be sRGB with 1 as the largest radiance, floating-point TIFF to be linear.
    ///
    /// Negative channels and NaN become 0, infinity 65504, each with a warning that tells how many they are.
    ///
    /// # Errors
    ///
    /// A file that cannot be read or decoded, an image of more than 16384 texels a side, or an EXR file without colours.
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

/// Makes all radiances finite and, unless they are to be converted first, at least 0, channel by channel. Returns what there is
/// to say about it.
fn clean(radiance: &mut [[f32; 3]], last: bool) -> Vec<String> {
    let mut changed = [0; 3];
    for channel in radiance.as_flattened_mut() {
        let (kind, cleaned) = match *channel {
            x if x.is_nan() => (0, 0.0),
            f32::INFINITY => (2, BRIGHTEST),
            x if x < 0.0 && (last || x.is_infinite()) => (1, 0.0),
            _ => continue,
        };
        changed[kind] += 1;
        *channel = cleaned;
    }
    let kinds = ["no number; they are 0", "negative; they are 0", "infinite; they are 65504"];
    let said = changed.into_iter().zip(kinds).filter(|&(count, _)| count > 0);
    said.map(|(count, kind)| format!("{count} channels of texels are {kind}")).collect()
}

/// What to say of a picture that has the shape of another kind of environment map.
fn odd_shape(width: u32, height: u32) -> Option<String> {
    /// Smaller pictures are made by hand.
    const SMALLEST: u32 = 16;
    let kind = match (width, height) {
        _ if width.min(height) < SMALLEST => return None,
        _ if width == height => "a light probe",
        _ if 4 * width == 3 * height || 3 * width == 4 * height => "the cross of a cube map",
        _ if 6 * width == height || width == 6 * height => "the strip of a cube map",
        _ => return None,
    };
    Some(format!("{width} × {height} texels are the shape of {kind}; the picture is read as equirectangular"))
}
