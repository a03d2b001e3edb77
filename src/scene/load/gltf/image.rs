//! Textures and the images behind them, each decoded once.

use std::collections::HashMap;
use std::path::PathBuf;

use gltf::json::image::Image as ImageSource;
use gltf::json::texture::{Info, MagFilter, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{Index, Texture as TextureSource};

use super::buffer::data_uri;
use super::source::Source;
use crate::image_io::recognise;
use crate::scene::description::{Image, Texture, Wrap};
use crate::scene::load::common::decode::decode;
use crate::scene::load::common::folder::Located;
use crate::scene::load::common::report::{Fault, Report};

/// Maximum number of texels of all images of one file (4 GiB).
const MAX_TEXELS: usize = 1 << 30;

/// The images of a file that were requested.
pub(super) struct Images<'a> {
    source: &'a Source<'a>,
    /// The decoded images.
    pub images: Vec<Image>,
    texels: usize,
    /// The place in `images` of each image of the file, or `None` if it cannot be read.
    known: HashMap<usize, Option<usize>>,
    /// The same by files, because several images may name one file.
    files: HashMap<PathBuf, Option<usize>>,
}

impl<'a> Images<'a> {
    pub fn new(source: &'a Source<'a>) -> Self {
        Self { source, images: Vec::new(), texels: 0, known: HashMap::new(), files: HashMap::new() }
    }

    /// The texture of a material. If it cannot be read, it alone is lost, with a warning.
    pub fn texture(&mut self, info: &Option<Info>, element: &str, report: &mut Report) -> Option<Texture> {
        let info = info.as_ref()?;
        let texture = match self.source.get(info.index, element) {
            Ok(texture) => texture,
            Err(fault) => {
                report.replace(fault, "the material is drawn without this texture");
                return None;
            }
        };
        let image = self.image(texture, info.index, report)?;
        let mut used = Texture { uv_set: info.tex_coord as usize, ..Texture::new(image) };
        if let Some(transform) = info.extensions.as_ref().and_then(|extensions| extensions.texture_transform.as_ref()) {
            used.uv_set = transform.tex_coord.map_or(used.uv_set, |set| set as usize);
            let matrix = affine(transform.offset.0, transform.rotation.0, transform.scale.0);
            if matrix.iter().flatten().all(|number| number.is_finite()) {
                used.transform = matrix;
            } else {
                report.warn(format!("{element}.KHR_texture_transform"), "is not finite; it is left out");
            }
        }
        if used.uv_set > 1 {
            let set = used.uv_set;
            report.warn(element, format!("TEXCOORD_{set} is not read (0 and 1 are); it is drawn without this texture"));
            return None;
        }
        if let Some(sampler) = texture.sampler {
            let user = format!("textures[{}].sampler", info.index);
            match self.source.get(sampler, &user) {
                Ok(sampler) => {
                    used.wrap = [wrap(sampler.wrap_s, &user, report), wrap(sampler.wrap_t, &user, report)];
                    used.nearest = sampler.mag_filter == Some(Checked::Valid(MagFilter::Nearest));
                }
                Err(fault) => report.replace(fault, "the texture repeats"),
            }
        }
        Some(used)
    }

    /// Checks the images that no texture requested, so that an incomplete file always gives a warning.
    pub fn check_unused(&self, report: &mut Report) {
        let unused = self.source.root.images.iter().enumerate().filter(|(index, _)| !self.known.contains_key(index));
        for (index, image) in unused {
            let Some(uri) = image.uri.as_deref().filter(|uri| data_uri(uri).is_none()) else { continue };
            let folder = &self.source.folder;
            let checked = folder.locate_uri(uri).and_then(|located| {
                recognise(&folder.start(&located.path)).map(|_| ()).map_err(|reason| format!("\"{uri}\" {reason}"))
            });
            if let Err(reason) = checked {
                report.warn(format!("images[{index}]"), format!("{reason}; it is not needed"));
            }
        }
    }

    /// The first readable image of a texture: its source, or that of an extension.
    fn image(&mut self, texture: &TextureSource, index: Index<TextureSource>, report: &mut Report) -> Option<usize> {
        // The JSON reader puts this in the place of an absent source.
        let own = Some(texture.source.value()).filter(|&source| source != u32::MAX as usize);
        let others = texture.extensions.as_ref().map(|extensions| &extensions.others);
        let named = |extension: &str| others?.get(extension)?.get("source")?.as_u64().map(|source| source as usize);
        let candidates = [own, named("EXT_texture_webp"), named("KHR_texture_basisu"), named("MSFT_texture_dds")];
        let mut candidates = candidates.into_iter().flatten().peekable();
        let user = format!("textures[{index}]");
        if candidates.peek().is_none() {
            report.warn(format!("{user}.source"), "names no image that is read; the texture is left out");
        }
        candidates.find_map(|source| self.listed(source, &user, report))
    }

    /// An image of the file's list.
    fn listed(&mut self, index: usize, user: &str, report: &mut Report) -> Option<usize> {
        let Some(image) = self.source.root.images.get(index) else {
            let reason = format!("index {index} is out of range: the file has {}", self.source.root.images.len());
            report.replace(Fault::new(format!("{user}.source"), reason), "materials are drawn without it");
            return None;
        };
        if let Some(&known) = self.known.get(&index) {
            return known;
        }
        let decoded = self.decode(image, index, report);
        let known = decoded.map_err(|reason| {
            let element = format!("images[{index}]");
            if !["bufferView", "uri"].iter().any(|member| report.is_removed(&format!("{element}.{member}"))) {
                report.warn(element, format!("{reason}; materials are drawn without it"));
            }
        });
        let known = known.ok().flatten();
        self.known.insert(index, known);
        known
    }

    /// Decodes an image. `None`, without a warning, if the same file failed before.
    fn decode(&mut self, image: &ImageSource, index: usize, report: &mut Report) -> Result<Option<usize>, String> {
        let name = image.name.clone().or_else(|| image.uri.clone().filter(|uri| data_uri(uri).is_none()));
        let name = name.unwrap_or_else(|| format!("image {index}"));
        if let Some(uri) = &image.uri {
            if let Some(bytes) = data_uri(uri) {
                return self.add(&name, &bytes?).map(Some);
            }
            let Located { path, note } = self.source.folder.locate_uri(uri)?;
            if let Some(note) = note {
                report.warn(format!("images[{index}]"), note);
            }
            if let Some(&known) = self.files.get(&path) {
                return Ok(known);
            }
            let added = self.source.folder.read(&path).and_then(|bytes| self.add(&name, &bytes));
            self.files.insert(path, added.as_ref().ok().copied());
            return added.map(Some).map_err(|reason| format!("\"{uri}\" {reason}"));
        }
        let view = image.buffer_view.ok_or("has neither a uri nor a buffer view")?;
        let (_, bytes) =
            self.source.view(view, "bufferView").map_err(|fault| format!("{}: {}", fault.element, fault.reason))?;
        self.add(&name, bytes).map(Some)
    }

    fn add(&mut self, name: &str, bytes: &[u8]) -> Result<usize, String> {
        let image = decode(name, bytes)?;
        self.texels += image.texels.len();
        if self.texels > MAX_TEXELS {
            return Err(format!("is left out: the images of the file have more than {MAX_TEXELS} texels together"));
        }
        self.images.push(image);
        Ok(self.images.len() - 1)
    }
}

/// The map of KHR_texture_transform: scale, then rotate, then offset. Because v grows downwards in the image, a counter-clockwise
/// rotation has the signs of a clockwise one with v upwards.
fn affine(offset: [f32; 2], rotation: f32, scale: [f32; 2]) -> [[f32; 3]; 2] {
    let (sin, cos) = rotation.sin_cos();
    [[cos * scale[0], sin * scale[1], offset[0]], [-sin * scale[0], cos * scale[1], offset[1]]]
}

fn wrap(mode: Checked<WrappingMode>, element: &str, report: &mut Report) -> Wrap {
    match mode {
        Checked::Valid(WrappingMode::Repeat) => Wrap::Repeat,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Invalid => {
            report.warn_once(element, "a wrap mode is none of 10497, 33071 and 33648; the texture repeats");
            Wrap::Repeat
        }
    }
}
