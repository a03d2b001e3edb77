//! The picture as a file: what the window shows as PNG, linear radiance as EXR.

use crate::embed::Film;
use crate::means::floats;
use crate::readback::Readback;
use asvgf::image_io;
use std::path::{Path, PathBuf};
use wgpu::{CommandEncoder, Device};

/// What became of a file: what to tell the user.
pub type Outcome = Result<String, String>;

/// Records the copy of a film; the file is written when it has arrived.
pub fn record(outcomes: &Readback<Outcome>, device: &Device, encoder: &mut CommandEncoder, film: &Film, path: PathBuf) {
    let texture = if is_exr(&path) { film.radiance.texture() } else { film.picture.texture() };
    let size = [texture.width(), texture.height()];
    outcomes.fetch_texture(device, encoder, texture, move |texels| {
        write(&path, size, texels).map(|()| format!("{} was written", path.display()))
    });
}

/// Whether a file holds numbers instead of a picture.
pub fn is_exr(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("exr"))
}

fn write(path: &Path, [width, height]: [u32; 2], texels: &[u8]) -> Result<(), String> {
    let written = if is_exr(path) {
        let colors: Vec<[f32; 3]> = floats(texels).chunks_exact(4).map(|c| [c[0], c[1], c[2]]).collect();
        image_io::write_exr_rgb(path, width, height, &colors)
    } else {
        image_io::write_png(path, width, height, texels.as_chunks::<4>().0)
    };
    written.map_err(|error| error.to_string())
}
