//! Textures and the images behind them, each decoded once.

use std::collections::HashMap;
use std::path::PathBuf;

use gltf::json::image::Image as ImageSource;
use gltf::json::texture::{Info, MagFilter, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{Index, Texture as TextureSource};

use super::buffer::data_uri;
use super::source::Source;
use crate::scene::description::{Image, Texture, Wrap};
use crate::scene::load::decode::{decode, recognise};
use crate::scene::load::folder::Located;
use crate::scene::load::report::{Fault, Report};

/// Most texels that the images of one file may have together (4 GiB).
const MAX_TEXELS: usize = 1 << 30;

/// The images of a file, as far as they were asked for.
pub(super) struct Images<'a> {
    source: &'a Source<'a>,
    /// What was decoded.
    pub images: Vec<Image>,
    texels: usize,
    /// What became of each image of the file: its place in `images`, or nothing if it cannot be read.
    known: HashMap<usize, Option<usize>>,
    /// The same for files, which several images may name.
    files: HashMap<PathBuf, Option<usize>>,
}

impl<'a> Images<'a> {
    pub fn new(source: &'a Source<'a>) -> Self {
        Self { source, images: Vec::new(), texels: 0, known: HashMap::new(), files: HashMap::new() }
    }

    /// The texture of a material. Where its image cannot be read there is a warning and no texture.
    pub fn texture(&mut self, info: &Info, element: &str, report: &mut Report) -> Result<Option<Texture>, Fault> {
        let texture = self.source.get(info.index, element)?;
        let Some(image) = self.image(texture, info.index, report)? else { return Ok(None) };
        let mut used = Texture { image, uv_set: info.tex_coord as usize, ..Texture::new(image) };
        if let Some(transform) = info.extensions.as_ref().and_then(|extensions| extensions.texture_transform.as_ref()) {
            used.uv_set = transform.tex_coord.map_or(used.uv_set, |set| set as usize);
            used.transform = affine(transform.offset.0, transform.rotation.0, transform.scale.0);
        }
        if used.uv_set > 1 {
            let set = used.uv_set;
            report.warn(element, format!("TEXCOORD_{set} is not read (0 and 1 are); it is drawn without this texture"));
            return Ok(None);
        }
        if let Some(sampler) = texture.sampler {
            let user = format!("textures[{}].sampler", info.index);
            let sampler = self.source.get(sampler, &user)?;
            used.wrap = [wrap(sampler.wrap_s, &user)?, wrap(sampler.wrap_t, &user)?];
            used.nearest = sampler.mag_filter == Some(Checked::Valid(MagFilter::Nearest));
        }
        Ok(Some(used))
    }

    /// Looks at the images that no texture asked for, so that a file that is incomplete is never silently so.
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

    fn image(
        &mut self,
        texture: &TextureSource,
        index: Index<TextureSource>,
        report: &mut Report,
    ) -> Result<Option<usize>, Fault> {
        let user = format!("textures[{index}]");
        // The JSON reader stands this in for an absent source.
        if texture.source.value() == u32::MAX as usize {
            report.warn_once(&user, format!("texture {index} names no image that is read; it is left out"));
            return Ok(None);
        }
        let image = self.source.get(texture.source, &format!("{user}.source"))?;
        let key = texture.source.value();
        if let Some(&known) = self.known.get(&key) {
            return Ok(known);
        }
        let decoded = self.decode(image, key, report);
        let known = decoded.map_err(|reason| {
            report.warn(format!("images[{key}]"), format!("{reason}; materials are drawn without it"));
        });
        let known = known.ok().flatten();
        self.known.insert(key, known);
        Ok(known)
    }

    /// Decodes an image, unless the same file failed before: then there is `None`, and nothing more to say.
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
        let (_, bytes) = self.source.view(view, "bufferView").map_err(|fault| fault.reason)?;
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

/// The map of KHR_texture_transform: scale, then rotate, then offset. v grows downwards in the image, so that a
/// counter-clockwise rotation has the signs that it would have clockwise with v upwards.
fn affine(offset: [f32; 2], rotation: f32, scale: [f32; 2]) -> [[f32; 3]; 2] {
    let (sin, cos) = rotation.sin_cos();
    [[cos * scale[0], sin * scale[1], offset[0]], [-sin * scale[0], cos * scale[1], offset[1]]]
}

fn wrap(mode: Checked<WrappingMode>, element: &str) -> Result<Wrap, Fault> {
    match mode {
        Checked::Valid(WrappingMode::Repeat) => Ok(Wrap::Repeat),
        Checked::Valid(WrappingMode::MirroredRepeat) => Ok(Wrap::Mirror),
        Checked::Valid(WrappingMode::ClampToEdge) => Ok(Wrap::Clamp),
        Checked::Invalid => Err(Fault::new(element, "a wrap mode is none of 10497, 33071 and 33648")),
    }
}
