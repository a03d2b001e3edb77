//! Images of named channels, all of one size.

use std::collections::HashSet;
use std::path::Path;

use crate::image_io::files::area;
use crate::image_io::{ExrFile, ImageError};

/// An image of named channels, which all have the same size.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Channels {
    /// Pixels per row, ≥ 1.
    pub width: u32,
    /// Rows, ≥ 1.
    pub height: u32,
    /// Names (`R`, `albedo.G`, `Z`) and `width · height` samples each, first row first.
    pub channels: Vec<(String, Vec<f32>)>,
}

impl Channels {
    /// Returns the samples of a channel, by its full name.
    pub fn get(&self, name: &str) -> Option<&[f32]> {
        self.channels.iter().find(|(known, _)| known == name).map(|(_, samples)| samples.as_slice())
    }
}

/// Reads all channels of an EXR file; f16 and u32 samples become f32.
///
/// Channel names are kept in full. In a file of several parts, a part's channels get the part's name in front (`albedo.R`),
/// unless they have it already. The image is that of the data window, see [`ExrFile::data_window`].
///
/// # Errors
///
/// Fails as [`ExrFile::read`] does.
pub fn read_exr(path: impl AsRef<Path>) -> Result<Channels, ImageError> {
    Ok(ExrFile::read(path)?.channels())
}

/// Writes channels as an EXR file: 32-bit floats, ZIP compression, no loss.
///
/// # Errors
///
/// Fails if there are no channels, if channels do not have `width · height` samples or share a name, for a size of 0 or above
/// 16384, and for a file that cannot be written.
pub fn write_exr(path: impl AsRef<Path>, image: &Channels) -> Result<(), ImageError> {
    let path = path.as_ref();
    let error = |reason: String| ImageError::new(path, reason);
    let area = area(image.width, image.height).map_err(error)?;
    if image.channels.is_empty() {
        return Err(error("there are no channels to write".into()));
    }
    let mut names = HashSet::new();
    for (name, samples) in &image.channels {
        if samples.len() != area {
            return Err(error(format!("channel {name} has {} samples, where {area} belong", samples.len())));
        }
        if name.is_empty() || !names.insert(name) || exr::prelude::Text::new_or_none(name).is_none() {
            return Err(error(format!("\"{name}\" is used twice or cannot be the name of a channel")));
        }
    }
    ExrFile::of(image).write(path)
}

/// Writes linear colours as an EXR file with the channels R, G and B.
///
/// # Errors
///
/// Fails as [`write_exr`] does.
pub fn write_exr_rgb(path: impl AsRef<Path>, width: u32, height: u32, pixels: &[[f32; 3]]) -> Result<(), ImageError> {
    let channel = |name: &str, index: usize| (name.to_owned(), pixels.iter().map(|pixel| pixel[index]).collect());
    write_exr(path, &Channels { width, height, channels: vec![channel("R", 0), channel("G", 1), channel("B", 2)] })
}
