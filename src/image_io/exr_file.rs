//! EXR files with all that they hold beside the samples, so that they can be written again.

use std::collections::HashSet;
use std::io::Cursor;
use std::path::Path;

use exr::meta::MetaData;
use exr::meta::attribute::{AttributeValue, Chromaticities, EnvironmentMap};
use exr::meta::header::{ImageAttributes, LayerAttributes};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatImage, FlatSamples, Image, IntegerBounds, Layer, ReadChannels as _,
    ReadLayers as _, Text, Vec2, WritableImage as _, f16, read as exr_reader,
};

use crate::image_io::files::{MAX_BYTES, check_side, read_file, replace};
use crate::image_io::{Channels, ImageError};

/// A rectangle of pixels in the plane of a picture: x right, y down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// The first pixel's column and row.
    pub position: [i32; 2],
    /// Columns and rows, ≥ 1.
    pub size: [u32; 2],
}

impl Window {
    /// Returns the least window that contains both.
    pub fn union(self, other: Self) -> Self {
        let end = |w: Self, axis: usize| i64::from(w.position[axis]) + i64::from(w.size[axis]);
        let position = [0, 1].map(|axis| self.position[axis].min(other.position[axis]));
        let size = [0, 1].map(|axis| end(self, axis).max(end(other, axis)) - i64::from(position[axis]));
        Self { position, size: size.map(|side| u32::try_from(side).unwrap_or(u32::MAX)) }
    }

    /// Moves samples of this window into another. Pixels that this one does not have are `filling`.
    pub fn place(self, samples: &[f32], into: Self, filling: f32) -> Vec<f32> {
        if self == into {
            return samples.to_vec();
        }
        let mut placed = vec![filling; into.size[0] as usize * into.size[1] as usize];
        // Columns that both windows have, counted in this one.
        let first = (into.position[0].saturating_sub(self.position[0])).max(0) as usize;
        for (row, line) in samples.chunks_exact(self.size[0] as usize).enumerate() {
            let y = i64::from(self.position[1]) + row as i64 - i64::from(into.position[1]);
            let x = i64::from(self.position[0]) + first as i64 - i64::from(into.position[0]);
            if first >= line.len() || x < 0 || x >= i64::from(into.size[0]) || y < 0 || y >= i64::from(into.size[1]) {
                continue;
            }
            let (x, y) = (x as usize, y as usize);
            let count = (line.len() - first).min(into.size[0] as usize - x);
            let start = y * into.size[0] as usize + x;
            placed[start..start + count].copy_from_slice(&line[first..first + count]);
        }
        placed
    }
}

/// A value of a named attribute of an EXR file, of the kinds that describe cameras.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Attribute {
    /// A number.
    Number(f64),
    /// Two numbers.
    Pair([f64; 2]),
    /// Three numbers.
    Triple([f64; 3]),
    /// A 4×4 matrix in the order of the file: that of Imath, which multiplies row vectors from the left, `p' = p·M`.
    Matrix([[f64; 4]; 4]),
    /// A text.
    Text(String),
}

/// Type of the stored samples of an EXR file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SampleType {
    /// 16-bit floats. Finite numbers above 65504 become 65504.
    Half,
    /// 32-bit floats.
    Float,
}

/// Compression of an EXR file. Lossless, unless said.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Compression {
    /// None.
    None,
    /// Run lengths.
    Rle,
    /// Deflate, one row at a time.
    Zips,
    /// Deflate, 16 rows at a time.
    Zip,
    /// Wavelets: small for images with noise.
    Piz,
    /// 32-bit floats lose 8 bits.
    Pxr24,
    /// 16-bit floats in blocks of a fixed size, with loss.
    B44,
    /// B44 with smaller flat blocks.
    B44a,
    /// Cosine transform, 32 rows at a time, with loss.
    Dwaa,
    /// Cosine transform, 256 rows at a time, with loss.
    Dwab,
}

/// An EXR file: parts with their names, windows, attributes, compression, and samples as they are stored.
#[derive(Clone, Debug)]
pub struct ExrFile {
    image: FlatImage,
}

impl ExrFile {
    /// Reads a file whole.
    ///
    /// # Errors
    ///
    /// Fails for a file that cannot be read, that is no EXR file, or that holds deep data or subsampled channels. Fails also
    /// if its windows are together larger than 16384 pixels a side, or its samples than 4 GiB.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ImageError> {
        let path = path.as_ref();
        let error = |reason: String| ImageError::new(path, reason);
        let bytes = read_file(path).map_err(error)?;
        // The size is checked before memory is taken for it.
        let broken = |cause: exr::error::Error| match cause {
            exr::error::Error::NotSupported(what) => error(format!("holds what is not read: {what}")),
            cause => error(format!("is no EXR file, or is damaged or cut short: {cause}")),
        };
        if let Some(number) = unknown_compression(&bytes) {
            let name = if number < 12 { "HTJ2K" } else { "unknown" };
            return Err(error(format!("is compressed with {name} (number {number}), which is not read")));
        }
        let meta = MetaData::read_from_buffered(bytes.as_slice(), false).map_err(broken)?;
        let mut total = 0_u64;
        let mut window: Option<Window> = None;
        for header in &meta.headers {
            let (width, height) = (header.layer_size.width(), header.layer_size.height());
            check_side(width).and_then(|()| check_side(height)).map_err(error)?;
            let own = window_of(header.own_attributes.layer_position, header.layer_size);
            let whole = window.map_or(own, |window| window.union(own));
            whole.size.into_iter().try_for_each(|side| check_side(side as usize)).map_err(error)?;
            window = Some(whole);
            total = total.saturating_add((width * height * 4) as u64 * header.channels.list.len() as u64);
        }
        // Parts are placed in the window that contains them all.
        let channels: usize = meta.headers.iter().map(|header| header.channels.list.len()).sum();
        let area = window.map_or(0, |window| u64::from(window.size[0]) * u64::from(window.size[1]));
        total = total.max(area.saturating_mul(4 * channels as u64));
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
        if image.layer_data.is_empty() {
            return Err(error("has no parts".into()));
        }
        for (part, layer) in image.layer_data.iter().enumerate() {
            let subsampled = |c: &&AnyChannel<FlatSamples>| c.sample_data.len() != layer.size.area();
            if let Some(channel) = layer.channel_data.list.iter().find(subsampled) {
                return Err(error(format!("part {part}: channel {} is subsampled", channel.name)));
            }
        }
        Ok(Self { image })
    }

    /// Makes a file of these channels, in 32-bit floats.
    pub(super) fn of(image: &Channels) -> Self {
        let size = Vec2(image.width as usize, image.height as usize);
        let layer =
            Layer::new(size, LayerAttributes::default(), Encoding::SMALL_LOSSLESS, sorted(&image.channels, None));
        let attributes = ImageAttributes::new(IntegerBounds::from_dimensions(size));
        Self { image: Image { attributes, layer_data: [layer].into_iter().collect() } }
    }

    /// Returns the window of the samples: the least one that contains those of all parts.
    pub fn data_window(&self) -> Window {
        let windows = self.image.layer_data.iter().map(|l| window_of(l.attributes.layer_position, l.size));
        windows.reduce(Window::union).unwrap_or(Window { position: [0; 2], size: [1; 2] })
    }

    /// Returns the window of the picture that cameras and viewers refer to. The data window may be smaller or larger, and lie
    /// anywhere.
    pub fn display_window(&self) -> Window {
        let bounds = self.image.attributes.display_window;
        window_of(bounds.position, bounds.size)
    }

    /// Returns the places of red, green, blue and white in the chromaticity diagram (CIE 1931 x and y), if the file names
    /// them.
    pub fn chromaticities(&self) -> Option<[[f32; 2]; 4]> {
        let Chromaticities { red, green, blue, white } = self.image.attributes.chromaticities?;
        Some([red, green, blue, white].map(|Vec2(x, y)| [x, y]))
    }

    /// Returns true if the file says that it holds the six faces of a cube.
    pub(crate) fn is_cube_map(&self) -> bool {
        let cube = |layer: &Layer<_>| layer.attributes.environment_map == Some(EnvironmentMap::Cube);
        self.image.layer_data.iter().any(cube)
    }

    /// Returns a pixel's width over its height.
    pub fn pixel_aspect(&self) -> f32 {
        self.image.attributes.pixel_aspect
    }

    /// Returns the full names of the channels, part by part. In a file of several parts they have the part's name in front.
    pub fn names(&self) -> Vec<String> {
        self.named().into_iter().map(|(name, ..)| name).collect()
    }

    /// Returns all samples over the data window as 32-bit floats, by the names of [`ExrFile::names`]; the first of two equal
    /// names counts. A part's channels are 0 at pixels that it does not have.
    pub fn channels(&self) -> Channels {
        let window = self.data_window();
        let mut names = HashSet::new();
        let mut channels = Vec::new();
        for (name, part, channel) in self.named() {
            let layer = &self.image.layer_data[part];
            if names.insert(name.clone()) {
                let samples: Vec<f32> = layer.channel_data.list[channel].sample_data.values_as_f32().collect();
                let own = window_of(layer.attributes.layer_position, layer.size);
                channels.push((name, own.place(&samples, window, 0.0)));
            }
        }
        Channels { width: window.size[0], height: window.size[1], channels }
    }

    /// Returns an attribute by its name in the file: the file's, or that of the first part that has it.
    pub fn attribute(&self, name: &str) -> Option<Attribute> {
        self.image.layer_data.iter().find_map(|layer| of_part(&layer.attributes, name)).or_else(|| {
            let value = self.image.attributes.other.iter().find(|(known, _)| **known == *name)?.1;
            simple(value)
        })
    }

    /// Replaces the samples of channels over the data window, by the names of [`ExrFile::names`]. The type of the samples
    /// stays. Names that the file does not have are ignored.
    pub fn replace(&mut self, channels: &[(String, Vec<f32>)]) {
        let window = self.data_window();
        for (name, part, channel) in self.named() {
            if let Some((_, samples)) = channels.iter().find(|(known, _)| *known == name) {
                let layer = &mut self.image.layer_data[part];
                let own = window_of(layer.attributes.layer_position, layer.size);
                let stored = &mut layer.channel_data.list[channel].sample_data;
                *stored = as_stored(&window.place(samples, own, 0.0), stored);
            }
        }
    }

    /// Makes a file of one part with these channels over the data window of the part that has the channel `like`, and with
    /// that part's attributes, compression and type of samples. The given samples are of this file's data window.
    pub fn with_channels(&self, like: &str, channels: &[(String, Vec<f32>)]) -> Self {
        let found = self.named().into_iter().find(|(name, ..)| name == like).map_or((0, 0), |(_, p, c)| (p, c));
        let layer = &self.image.layer_data[found.0];
        let window = self.data_window();
        let own = window_of(layer.attributes.layer_position, layer.size);
        let placed: Vec<(String, Vec<f32>)> =
            channels.iter().map(|(name, samples)| (name.clone(), window.place(samples, own, 0.0))).collect();
        let stored = layer.channel_data.list.get(found.1).map(|channel| &channel.sample_data);
        let attributes = LayerAttributes { layer_name: None, ..layer.attributes.clone() };
        let part = Layer::new(layer.size, attributes, layer.encoding, sorted(&placed, stored));
        Self { image: Image { attributes: self.image.attributes.clone(), layer_data: [part].into_iter().collect() } }
    }

    /// Sets the type in which the floats of channels are written, by the names of [`ExrFile::names`]. Depths and numbers of
    /// objects may be too large for 16 bits.
    pub fn set_sample_type(&mut self, sample_type: SampleType, names: &[String]) {
        let like = match sample_type {
            SampleType::Half => FlatSamples::F16(Vec::new()),
            SampleType::Float => FlatSamples::F32(Vec::new()),
        };
        for (_, part, number) in self.named().into_iter().filter(|(name, ..)| names.contains(name)) {
            let channel = &mut self.image.layer_data[part].channel_data.list[number];
            if !matches!(channel.sample_data, FlatSamples::U32(_)) {
                let samples: Vec<f32> = channel.sample_data.values_as_f32().collect();
                channel.sample_data = as_stored(&samples, &like);
            }
        }
    }

    /// Sets the compression of all parts.
    pub fn set_compression(&mut self, compression: Compression) {
        use exr::prelude::Compression as Of;
        let compression = match compression {
            Compression::None => Of::Uncompressed,
            Compression::Rle => Of::RLE,
            Compression::Zips => Of::ZIP1,
            Compression::Zip => Of::ZIP16,
            Compression::Piz => Of::PIZ,
            Compression::Pxr24 => Of::PXR24,
            Compression::B44 => Of::B44,
            Compression::B44a => Of::B44A,
            Compression::Dwaa => Of::DWAA(None),
            Compression::Dwab => Of::DWAB(None),
        };
        self.image.layer_data.iter_mut().for_each(|layer| layer.encoding.compression = compression);
    }

    /// Writes the file.
    ///
    /// # Errors
    ///
    /// Fails for contents that the format does not allow, or a file that cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), ImageError> {
        let path = path.as_ref();
        let mut bytes = Vec::new();
        let written = self.image.write().to_buffered(Cursor::new(&mut bytes));
        written.map_err(|cause| ImageError::new(path, cause.to_string()))?;
        replace(path, &bytes)
    }

    /// Full name, part and number in it of each channel.
    fn named(&self) -> Vec<(String, usize, usize)> {
        let several = self.image.layer_data.len() > 1;
        let parts = self.image.layer_data.iter().enumerate();
        let of_part = |(part, layer): (usize, &Layer<AnyChannels<FlatSamples>>)| {
            let name = layer.attributes.layer_name.as_ref().map(text).filter(|_| several);
            let channels = layer.channel_data.list.iter().enumerate();
            let full = |(number, channel): (usize, &AnyChannel<FlatSamples>)| {
                (full_name(name.as_deref(), text(&channel.name)), part, number)
            };
            channels.map(full).collect::<Vec<_>>()
        };
        parts.flat_map(of_part).collect()
    }
}

/// Number of a compression that is newer than the reader, which reports such a file as damaged.
fn unknown_compression(bytes: &[u8]) -> Option<u8> {
    const ATTRIBUTE: &[u8] = b"compression\0compression\0\x01\0\0\0";
    const DWAB: u8 = 9;
    // The header comes first.
    let start = &bytes[..bytes.len().min(1 << 16)];
    let at = start.windows(ATTRIBUTE.len()).position(|window| window == ATTRIBUTE)?;
    start.get(at + ATTRIBUTE.len()).copied().filter(|&number| number > DWAB)
}

/// Returns a channel's name with its part's name in front, if it does not have that already.
fn full_name(part: Option<&str>, channel: String) -> String {
    match part.filter(|part| !part.is_empty()) {
        Some(part) if !channel.strip_prefix(part).is_some_and(|rest| rest.starts_with('.')) => {
            format!("{part}.{channel}")
        }
        _ => channel,
    }
}

/// Returns a name as its program wrote it, in UTF-8 if it is that.
fn text(name: &Text) -> String {
    String::from_utf8(name.bytes().to_vec()).unwrap_or_else(|_| name.to_string())
}

fn window_of(position: Vec2<i32>, size: Vec2<usize>) -> Window {
    let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
    Window { position: [position.x(), position.y()], size: [side(size.width()), side(size.height())] }
}

/// Orders channels as the format demands, stored as others are, or as 32-bit floats.
fn sorted(channels: &[(String, Vec<f32>)], like: Option<&FlatSamples>) -> AnyChannels<FlatSamples> {
    let stored = |samples: &Vec<f32>| like.map_or_else(|| FlatSamples::F32(samples.clone()), |l| as_stored(samples, l));
    let channel = |(name, samples): &(String, Vec<f32>)| AnyChannel::new(name.as_str(), stored(samples));
    AnyChannels::sort(channels.iter().map(channel).collect())
}

/// Converts samples to the type of others. Finite numbers stay finite.
fn as_stored(samples: &[f32], like: &FlatSamples) -> FlatSamples {
    const LARGEST: f32 = 65504.0;
    let half = |&x: &f32| f16::from_f32(if x.is_finite() { x.clamp(-LARGEST, LARGEST) } else { x });
    match like {
        FlatSamples::F16(_) => FlatSamples::F16(samples.iter().map(half).collect()),
        FlatSamples::F32(_) => FlatSamples::F32(samples.to_vec()),
        FlatSamples::U32(_) => FlatSamples::U32(samples.iter().map(|&x| x as u32).collect()),
    }
}

/// An attribute of a part. The reader knows the standard names, and keeps the others.
fn of_part(attributes: &LayerAttributes, name: &str) -> Option<Attribute> {
    let number = |x: Option<f32>| x.map(|x| Attribute::Number(x.into()));
    let matrix = |m: Option<[f32; 16]>| m.map(rows);
    match name {
        "worldToCamera" => matrix(attributes.world_to_camera),
        "worldToNDC" => matrix(attributes.world_to_normalized_device),
        "fieldOfViewHorizontal" => number(attributes.horizontal_field_of_view),
        "fieldOfViewVertical" => number(attributes.vertical_field_of_view),
        "screenWindowWidth" => number(Some(attributes.screen_window_width)),
        "screenWindowCenter" => {
            let Vec2(x, y) = attributes.screen_window_center;
            Some(Attribute::Pair([x, y].map(f64::from)))
        }
        _ => simple(attributes.other.iter().find(|(known, _)| **known == *name)?.1),
    }
}

fn simple(value: &AttributeValue) -> Option<Attribute> {
    Some(match value {
        AttributeValue::F32(x) => Attribute::Number((*x).into()),
        AttributeValue::F64(x) => Attribute::Number(*x),
        AttributeValue::I32(x) => Attribute::Number((*x).into()),
        AttributeValue::FloatVec2(Vec2(x, y)) => Attribute::Pair([*x, *y].map(f64::from)),
        AttributeValue::FloatVec3((x, y, z)) => Attribute::Triple([*x, *y, *z].map(f64::from)),
        AttributeValue::Matrix4x4(m) => rows(*m),
        AttributeValue::Text(text) => Attribute::Text(text.to_string()),
        _ => return None,
    })
}

fn rows(m: [f32; 16]) -> Attribute {
    Attribute::Matrix(std::array::from_fn(|row| std::array::from_fn(|column| m[4 * row + column].into())))
}
