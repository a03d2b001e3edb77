//! Normal maps.

use gltf::json::Extras;
use gltf::json::extensions::texture::{Info as InfoExtensions, TextureTransform};
use gltf::json::material::NormalTexture;
use gltf::json::texture::Info;
use serde::Deserialize;

use super::image::Images;
use crate::scene::description::Texture;
use crate::scene::load::common::report::Report;

/// A normal map and its scale.
pub(super) fn read(
    map: Option<&NormalTexture>,
    user: &str,
    images: &mut Images,
    report: &mut Report,
) -> (Option<Texture>, f32) {
    let Some(map) = map else { return (None, 1.0) };
    let mut info = Info { index: map.index, tex_coord: map.tex_coord, extensions: None, extras: Extras::default() };
    // The JSON reader knows this extension in other textures only.
    let transform = map.extensions.as_ref().and_then(|extensions| extensions.others.get("KHR_texture_transform"));
    if let Some(transform) = transform {
        match TextureTransform::deserialize(transform) {
            Ok(transform) => {
                info.extensions = Some(InfoExtensions { texture_transform: Some(transform), ..Default::default() });
            }
            Err(error) => report.warn(format!("{user}.KHR_texture_transform"), format!("{error}; it is left out")),
        }
    }
    let texture = images.texture(&Some(info), user, report);
    if map.scale.is_finite() {
        return (texture, map.scale);
    }
    report.warn(format!("{user}.scale"), format!("{} is not finite; 1 is used", map.scale));
    (texture, 1.0)
}
