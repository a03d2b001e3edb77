//! Image files: EXR with any number of named channels, and PNG.
//!
//! Files are written under a temporary name in the same folder and renamed when they are complete, so that there is
//! never a file that is half written, and an older file stays until the new one replaces it.

use std::collections::HashSet;
use std::ffi::OsString;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

use exr::meta::MetaData;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, ReadChannels as _, ReadLayers as _,
    WritableImage as _, read as exr_reader,
};
use image::{ImageFormat, ImageReader, Limits};

/// Largest width and height that is read or written.
const MAX_SIDE: usize = 16_384;

/// Largest file that is read, and most memory that the samples of one image may take.
const MAX_BYTES: u64 = 1 << 32;

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
    /// The samples of a channel, by its full name.
    pub fn get(&self, name: &str) -> Option<&[f32]> {
        self.channels.iter().find(|(known, _)| known == name).map(|(_, samples)| samples.as_slice())
    }
}

/// Why an image file cannot be read or written.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{file}: {reason}")]
pub struct ImageError {
    /// The file.
    pub file: String,
    /// What is wrong with it.
    pub reason: String,
}

impl ImageError {
    fn new(file: &Path, reason: impl Into<String>) -> Self {
        Self { file: file.display().to_string(), reason: reason.into() }
    }
}

/// Reads all channels of an EXR file; f16 and u32 samples become f32.
///
/// Channel names are kept in full. In a file of several parts, the channels of every part but the first get the name
/// of their part in front (`albedo.R`), unless they have it already.
///
/// # Errors
///
/// A file that cannot be read, that is no EXR file, holds deep data, has parts of different sizes or subsampled
/// channels, or is larger than 16384 pixels a side or 4 GiB.
pub fn read_exr(path: impl AsRef<Path>) -> Result<Channels, ImageError> {
    let path = path.as_ref();
    let error = |reason: String| ImageError::new(path, reason);
    let bytes = read_file(path).map_err(error)?;
    // The size is looked at before memory is taken for it.
    let broken = |cause: exr::error::Error| error(format!("is no EXR file, or is damaged or cut short: {cause}"));
    let meta = MetaData::read_from_buffered(bytes.as_slice(), false).map_err(broken)?;
    let mut total = 0_u64;
    for header in &meta.headers {
        let (width, height) = (header.layer_size.width(), header.layer_size.height());
        check_side(width).and_then(|()| check_side(height)).map_err(error)?;
        total = total.saturating_add((width * height * 4) as u64 * header.channels.list.len() as u64);
    }
    if total > MAX_BYTES {
        return Err(error(format!("its samples take {total} bytes; at most {MAX_BYTES} are read")));
    }

    let image = exr_reader()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(broken)?;
    let size = image.layer_data.first().map(|layer| layer.size).ok_or_else(|| error("has no layers".into()))?;
    let mut channels = Vec::new();
    let mut names = HashSet::new();
    for (index, layer) in image.layer_data.into_iter().enumerate() {
        if layer.size != size {
            return Err(error(format!("part {index} has another size than the first")));
        }
        let part = layer.attributes.layer_name.map(|name| name.to_string()).filter(|_| index > 0);
        for channel in layer.channel_data.list {
            let name = full_name(part.as_deref(), channel.name.to_string());
            let samples: Vec<f32> = channel.sample_data.values_as_f32().collect();
            if samples.len() != size.area() {
                return Err(error(format!("channel {name} is subsampled")));
            }
            // The first of two equal names counts.
            if names.insert(name.clone()) {
                channels.push((name, samples));
            }
        }
    }
    Ok(Channels { width: size.width() as u32, height: size.height() as u32, channels })
}

/// Writes channels as an EXR file: 32-bit floats, ZIP compression, no loss.
///
/// # Errors
///
/// No channels, channels that do not have `width · height` samples or share a name, a size of 0 or above 16384, or a
/// file that cannot be written.
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
    let channel =
        |(name, samples): &(String, Vec<f32>)| AnyChannel::new(name.as_str(), FlatSamples::F32(samples.clone()));
    let channels = AnyChannels::sort(image.channels.iter().map(channel).collect());
    let size = (image.width as usize, image.height as usize);
    let layer = Layer::new(size, LayerAttributes::default(), Encoding::SMALL_LOSSLESS, channels);
    let mut bytes = Vec::new();
    Image::from_layer(layer).write().to_buffered(Cursor::new(&mut bytes)).map_err(|cause| error(cause.to_string()))?;
    replace(path, &bytes)
}

/// Writes linear colours as an EXR file with the channels R, G and B.
///
/// # Errors
///
/// As [`write_exr`].
pub fn write_exr_rgb(path: impl AsRef<Path>, width: u32, height: u32, pixels: &[[f32; 3]]) -> Result<(), ImageError> {
    let channel = |name: &str, index: usize| (name.to_owned(), pixels.iter().map(|pixel| pixel[index]).collect());
    write_exr(path, &Channels { width, height, channels: vec![channel("R", 0), channel("G", 1), channel("B", 2)] })
}

/// Writes 8-bit RGBA pixels, encoded as sRGB, as a PNG file.
///
/// # Errors
///
/// Other than `width · height` pixels, a size of 0 or above 16384, or a file that cannot be written.
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
/// A file that cannot be read, that is no PNG file, or is larger than 16384 pixels a side.
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

/// The bytes of a file. The error is a reason.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, String> {
    let unreadable = |cause| format!("cannot be read: {cause}");
    let metadata = fs::metadata(path).map_err(unreadable)?;
    if !metadata.is_file() {
        // Pipes and devices may never end.
        return Err("is not a regular file".into());
    }
    if metadata.len() > MAX_BYTES {
        return Err(format!("is {} bytes long; at most {MAX_BYTES} are read", metadata.len()));
    }
    fs::read(path).map_err(unreadable)
}

/// The limits within which images are decoded.
pub(crate) fn limits() -> Limits {
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE as u32);
    limits.max_image_height = Some(MAX_SIDE as u32);
    limits.max_alloc = Some(MAX_BYTES);
    limits
}

/// The name of a channel with the name of its part in front, where it does not have that already.
fn full_name(part: Option<&str>, channel: String) -> String {
    match part {
        Some(part) if !channel.strip_prefix(part).is_some_and(|rest| rest.starts_with('.')) => {
            format!("{part}.{channel}")
        }
        _ => channel,
    }
}

/// Number of pixels of an image. The error is a reason.
fn area(width: u32, height: u32) -> Result<usize, String> {
    let (width, height) = (width as usize, height as usize);
    check_side(width)?;
    check_side(height)?;
    Ok(width * height)
}

fn check_side(side: usize) -> Result<(), String> {
    if (1..=MAX_SIDE).contains(&side) {
        Ok(())
    } else {
        Err(format!("{side} pixels a side are not within 1…{MAX_SIDE}"))
    }
}

/// Puts a complete file in the place of whatever was there.
fn replace(path: &Path, bytes: &[u8]) -> Result<(), ImageError> {
    let temporary = temporary_name(path).ok_or_else(|| ImageError::new(path, "is not the name of a file"))?;
    let written = fs::write(&temporary, bytes).and_then(|()| fs::rename(&temporary, path));
    written.map_err(|cause| {
        // It may not even exist; the first error is the one that matters.
        let _ = fs::remove_file(&temporary);
        ImageError::new(path, format!("cannot be written: {cause}"))
    })
}

/// A name in the same folder that no other process or thread uses.
fn temporary_name(path: &Path) -> Option<PathBuf> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let mut name: OsString = path.file_name()?.to_owned();
    name.push(format!(".{}-{}.tmp", process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
    Some(path.with_file_name(name))
}
