//! The images of all libraries, each read once, and images made of two. MTL has opacity, roughness and metalness in separate files, a
//! [`Material`](crate::scene::Material) has them in the channels of one image.
//!
//! The larger of two images decides the size of the result. The statement of the colour (or of the roughness) decides its place.

use std::collections::HashMap;
use std::path::PathBuf;

use image::imageops::{FilterType, resize};
use image::{GrayImage, ImageBuffer};

use super::map::{Channel, Map};
use crate::scene::description::{Image, Texture, Wrap};
use crate::scene::load::common::decode::decode;
use crate::scene::load::common::folder::{Folder, Located};
use crate::scene::load::common::recognise::foreign;
use crate::scene::load::common::report::Report;

/// Maximum number of texels of all images of one file (4 GiB).
const MAX_TEXELS: usize = 1 << 30;

/// An image file, by its number.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) struct Raw(usize);

/// The origin of an image of the scene.
enum Slot {
    File(usize),
    Made(Image),
}

/// The composition of an image made of others.
#[derive(PartialEq, Eq, Hash)]
enum Recipe {
    /// Colour, opacity.
    Masked(Option<Raw>, Raw, Channel),
    /// Roughness, metalness.
    Packed([Option<(Raw, Channel)>; 2]),
}

/// The images of all libraries.
pub(super) struct Textures<'a> {
    folder: &'a Folder<'a>,
    files: Vec<Image>,
    by_path: HashMap<PathBuf, Option<usize>>,
    slots: Vec<Slot>,
    by_file: HashMap<usize, usize>,
    by_recipe: HashMap<Recipe, usize>,
    texels: usize,
}

impl<'a> Textures<'a> {
    pub fn new(folder: &'a Folder<'a>) -> Self {
        Self {
            folder,
            files: Vec::new(),
            by_path: HashMap::new(),
            slots: Vec::new(),
            by_file: HashMap::new(),
            by_recipe: HashMap::new(),
            texels: 0,
        }
    }

    /// The images to which textures refer.
    pub fn into_images(self) -> Vec<Image> {
        let mut files: Vec<Option<Image>> = self.files.into_iter().map(Some).collect();
        let image = |slot| match slot {
            Slot::File(number) => files.get_mut(number).and_then(Option::take).unwrap_or_default(),
            Slot::Made(image) => image,
        };
        self.slots.into_iter().map(image).collect()
    }

    /// The image file of a statement. `None`, with a warning, if it cannot be read.
    pub fn file(&mut self, map: &Map, element: &str, report: &mut Report) -> Option<Raw> {
        let [short, whole] = &map.files;
        let with_comment = || self.folder.locate(whole).ok().filter(|found| found.note.is_none());
        let located = match self.folder.locate(short) {
            Ok(found) if found.note.is_none() || short == whole => Ok(found),
            other => with_comment().map_or(other, Ok),
        };
        let Located { path, note } = match located {
            Ok(located) => located,
            Err(reason) => {
                report.warn_once(element, format!("{reason}; materials are drawn without this texture"));
                return None;
            }
        };
        if let Some(note) = note {
            report.warn_once(element, note);
        }
        if let Some(&known) = self.by_path.get(&path) {
            return known.map(Raw);
        }
        let decoded = self.folder.read(&path).and_then(|bytes| {
            // A Git LFS pointer or a web page is not a broken image.
            let kind = || foreign(&bytes).filter(|kind| !kind.ends_with("image"));
            decode(short, &bytes).map_err(|reason| kind().map_or(reason, str::to_owned))
        });
        let number = decoded.and_then(|image| self.reserve(image.texels.len()).map(|()| image)).map(|image| {
            self.files.push(image);
            self.files.len() - 1
        });
        let number = number.map_err(|reason| {
            report.warn(element, format!("\"{short}\" {reason}; materials are drawn without it"));
        });
        self.by_path.insert(path, number.ok());
        number.ok().map(Raw)
    }

    /// An image file, unchanged.
    pub fn plain(&mut self, raw: Raw, map: &Map) -> Texture {
        let next = self.slots.len();
        let image = *self.by_file.entry(raw.0).or_insert(next);
        if image == next {
            self.slots.push(Slot::File(raw.0));
        }
        placed(image, map)
    }

    /// The colour of one file (white without one) with the opacity of another. The error is a reason.
    pub fn masked(&mut self, color: Option<(Raw, &Map)>, mask: (Raw, &Map, Channel)) -> Result<Texture, String> {
        let (raw, map, channel) = mask;
        let recipe = Recipe::Masked(color.map(|(raw, _)| raw), raw, channel);
        let place = color.map_or(map, |(_, map)| map);
        self.made(recipe, place, |textures| {
            let mask = textures.channel(raw, channel);
            let color = color.map(|(raw, _)| textures.image(raw));
            let [width, height] = larger(color.map(size), Some(mask.dimensions()));
            let mask = resized(&mask, width, height);
            let mut texels =
                color.map_or_else(|| vec![[255; 4]; mask.len()], |color| resized_color(color, width, height));
            for (texel, opacity) in texels.iter_mut().zip(mask) {
                texel[3] = opacity;
            }
            Image { name: textures.image(raw).name.clone(), width, height, texels }
        })
    }

    /// Roughness and metalness of two files in green and blue. 1 replaces a missing file. The error is a reason.
    pub fn packed(&mut self, maps: [Option<(Raw, &Map, Channel)>; 2]) -> Result<Option<Texture>, String> {
        let Some((first, place, _)) = maps.into_iter().flatten().next() else { return Ok(None) };
        let recipe = Recipe::Packed(maps.map(|map| map.map(|(raw, _, channel)| (raw, channel))));
        let made = self.made(recipe, place, |textures| {
            let channels = maps.map(|map| map.map(|(raw, _, channel)| textures.channel(raw, channel)));
            let [width, height] = larger(
                channels[0].as_ref().map(ImageBuffer::dimensions),
                channels[1].as_ref().map(ImageBuffer::dimensions),
            );
            let count = width as usize * height as usize;
            let [green, blue] = channels
                .map(|channel| channel.map_or_else(|| vec![255; count], |channel| resized(&channel, width, height)));
            let texels = std::iter::zip(green, blue).map(|(green, blue)| [255, green, blue, 255]).collect();
            Image { name: textures.image(first).name.clone(), width, height, texels }
        });
        made.map(Some)
    }

    /// True if any texel is not opaque.
    pub fn has_alpha(&self, raw: Raw) -> bool {
        self.image(raw).texels.iter().any(|texel| texel[3] != 255)
    }

    /// True if red, green and blue are equal everywhere.
    pub fn is_grey(&self, raw: Raw) -> bool {
        self.image(raw).texels.iter().all(|[r, g, b, _]| r == g && g == b)
    }

    /// True if the texels are about unit vectors that point out of the image, with means of 1 ± ¼ and at least ½.
    pub fn is_normal_map(&self, raw: Raw) -> bool {
        let texels = &self.image(raw).texels;
        let vectors = || texels.iter().map(|&[r, g, b, _]| [r, g, b].map(|byte| f64::from(byte) / 127.5 - 1.0));
        let count = texels.len().max(1) as f64;
        let upright = vectors().map(|[.., z]| z).sum::<f64>() / count;
        let length = vectors().map(|v| v.map(|x| x * x).iter().sum::<f64>().sqrt()).sum::<f64>() / count;
        upright > 0.5 && (length - 1.0).abs() < 0.25 && !self.is_grey(raw)
    }

    /// True if all texels have one colour.
    pub fn is_plain(&self, raw: Raw) -> bool {
        let texels = &self.image(raw).texels;
        texels.iter().all(|texel| texels.first().is_some_and(|first| texel[..3] == first[..3]))
    }

    fn image(&self, raw: Raw) -> &Image {
        const NONE: &Image = &Image { name: String::new(), width: 0, height: 0, texels: Vec::new() };
        self.files.get(raw.0).unwrap_or(NONE)
    }

    fn channel(&self, raw: Raw, channel: Channel) -> GrayImage {
        let image = self.image(raw);
        let value = |texel: &[u8; 4]| match channel {
            Channel::One(channel) => texel.get(channel).copied().unwrap_or(255),
            Channel::Luminance => luminance(*texel),
        };
        let values = image.texels.iter().map(value).collect();
        GrayImage::from_raw(image.width, image.height, values).unwrap_or_default()
    }

    fn made(&mut self, recipe: Recipe, place: &Map, make: impl FnOnce(&Self) -> Image) -> Result<Texture, String> {
        if let Some(&known) = self.by_recipe.get(&recipe) {
            return Ok(placed(known, place));
        }
        let image = make(self);
        self.reserve(image.texels.len())?;
        self.slots.push(Slot::Made(image));
        self.by_recipe.insert(recipe, self.slots.len() - 1);
        Ok(placed(self.slots.len() - 1, place))
    }

    fn reserve(&mut self, texels: usize) -> Result<(), String> {
        self.texels += texels;
        if self.texels > MAX_TEXELS {
            return Err(format!("is left out: the images of the file have more than {MAX_TEXELS} texels together"));
        }
        Ok(())
    }
}

fn placed(image: usize, map: &Map) -> Texture {
    let wrap = if map.clamp { Wrap::Clamp } else { Wrap::Repeat };
    Texture { wrap: [wrap; 2], transform: map.transform(), ..Texture::new(image) }
}

/// Rec. 709 luma.
fn luminance([r, g, b, _]: [u8; 4]) -> u8 {
    let [r, g, b] = [r, g, b].map(u32::from);
    ((2126 * r + 7152 * g + 722 * b + 5000) / 10_000) as u8
}

fn size(image: &Image) -> (u32, u32) {
    (image.width, image.height)
}

/// The size of the image with more texels. The larger width times the larger height may be far more than either image.
fn larger(a: Option<(u32, u32)>, b: Option<(u32, u32)>) -> [u32; 2] {
    let texels = |&(width, height): &(u32, u32)| u64::from(width) * u64::from(height);
    // Among equals, the first.
    let (width, height) = [b, a].into_iter().flatten().max_by_key(texels).unwrap_or((1, 1));
    [width, height]
}

fn resized(image: &GrayImage, width: u32, height: u32) -> Vec<u8> {
    if image.dimensions() == (width, height) {
        return image.as_raw().clone();
    }
    resize(image, width, height, FilterType::Triangle).into_raw()
}

fn resized_color(image: &Image, width: u32, height: u32) -> Vec<[u8; 4]> {
    if (image.width, image.height) == (width, height) {
        return image.texels.clone();
    }
    let pixels = image::RgbaImage::from_raw(image.width, image.height, image.texels.as_flattened().to_vec());
    let resized = resize(&pixels.unwrap_or_default(), width, height, FilterType::Triangle).into_raw();
    resized.as_chunks::<4>().0.to_vec()
}
