//! Environment maps from files.

use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageFormat, ImageReader};

use crate::image_io::{self, limits, read_file};
use crate::scene::description::{Environment, SceneError, Warning};

impl Environment {
    /// Reads an equirectangular image: `.hdr` (Radiance) and `.exr` hold linear radiance, `.png` and `.jpg` are taken
    /// to be sRGB with 1 as the largest radiance. Texels that are negative or not finite become black, with a warning
    /// that tells how many they are.
    ///
    /// # Errors
    ///
    /// An unknown extension, a file that cannot be read or decoded, an image of more than 16384 texels a side, or an
    /// EXR file without the channels R, G and B (or Y).
    pub fn load(path: impl AsRef<Path>) -> Result<(Self, Vec<Warning>), SceneError> {
        let path = path.as_ref();
        let error =
            |reason: String| SceneError { file: path.display().to_string(), element: "environment".into(), reason };
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        let mut environment = match extension.as_deref() {
            Some("exr") => read_exr(path),
            Some("hdr") => read_image(path, ImageFormat::Hdr),
            Some("png") => read_image(path, ImageFormat::Png),
            Some("jpg" | "jpeg") => read_image(path, ImageFormat::Jpeg),
            _ => Err("unknown extension; known are .hdr, .exr, .png, .jpg and .jpeg".into()),
        }
        .map_err(error)?;

        let mut cleaned = 0;
        for texel in &mut environment.radiance {
            if texel.iter().any(|&x| !(x.is_finite() && x >= 0.0)) {
                *texel = [0.0; 3];
                cleaned += 1;
            }
        }
        let warning = |cleaned: usize| Warning {
            element: "environment".into(),
            reason: format!("{cleaned} texels are negative or not finite; they are black"),
        };
        Ok((environment, (cleaned > 0).then(|| warning(cleaned)).into_iter().collect()))
    }
}

fn read_exr(path: &Path) -> Result<Environment, String> {
    let image = image_io::read_exr(path).map_err(|error| error.reason)?;
    let (width, height) = (image.width, image.height);
    let channel = |name: &str| image.channels.iter().find(|(known, _)| known == name).map(|(_, samples)| samples);
    let channels = match (channel("R"), channel("G"), channel("B"), channel("Y")) {
        (Some(r), Some(g), Some(b), _) => [r, g, b],
        (_, _, _, Some(y)) => [y; 3],
        _ => return Err("has no channels R, G and B".into()),
    };
    let [r, g, b] = channels;
    let radiance = r.iter().zip(g).zip(b).map(|((&r, &g), &b)| [r, g, b]).collect();
    Ok(Environment { width, height, radiance })
}

fn read_image(path: &Path, format: ImageFormat) -> Result<Environment, String> {
    let bytes = read_file(path)?;
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits());
    let image = reader.decode().map_err(|error| format!("cannot be decoded: {error}"))?;
    let linear = matches!(image, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_));
    let image = image.into_rgb32f();
    let radiance = image.pixels().map(|texel| if linear { texel.0 } else { texel.0.map(linear_from_srgb) }).collect();
    Ok(Environment { width: image.width(), height: image.height(), radiance })
}

/// The transfer function of sRGB, from 0…1 to 0…1.
pub(crate) fn linear_from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}
