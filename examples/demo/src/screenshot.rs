//! The picture as a file: the shown picture as PNG, linear radiance as EXR. A split picture has both halves in it.

use crate::embed::Film;
use crate::means::floats;
use crate::readback::Readback;
use asvgf::image_io;
use std::path::{Path, PathBuf};
use wgpu::{CommandEncoder, Device};

/// The outcome of writing a file, as a text for the user.
pub type Outcome = Result<String, String>;

/// Colour of the divider in a PNG. An EXR has no divider.
const DIVIDER: [u8; 4] = [255; 4];

/// Records the copy of a film and, if the picture is split, of the film to the right of the divider, 0…1. The file is written
/// when the copies have arrived.
pub fn record(
    outcomes: &Readback<Outcome>,
    device: &Device,
    encoder: &mut CommandEncoder,
    left: &Film,
    right: Option<(&Film, f32)>,
    path: PathBuf,
) {
    let texture = |film: &Film| if is_exr(&path) { film.radiance.texture() } else { film.picture.texture() }.clone();
    let size = texture(left).size();
    let divider = right.map(|(_, divider)| column(divider, size.width));
    let middle = divider.unwrap_or(size.width);
    let mut parts = vec![(texture(left), 0..middle)];
    parts.extend(right.map(|(film, _)| (texture(film), middle..size.width)));
    outcomes.fetch_columns(device, encoder, size, &parts, move |texels| {
        write(&path, [size.width, size.height], texels, divider).map(|()| format!("{} was written", path.display()))
    });
}

/// The first column to the right of a divider.
fn column(divider: f32, width: u32) -> u32 {
    ((divider * width as f32).round() as u32).min(width)
}

/// Returns true if a file holds numbers instead of a picture.
pub fn is_exr(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("exr"))
}

fn write(path: &Path, [width, height]: [u32; 2], texels: &[u8], divider: Option<u32>) -> Result<(), String> {
    let written = if is_exr(path) {
        let colors: Vec<[f32; 3]> = floats(texels).chunks_exact(4).map(|c| [c[0], c[1], c[2]]).collect();
        image_io::write_exr_rgb(path, width, height, &colors)
    } else {
        let mut texels = texels.as_chunks::<4>().0.to_vec();
        if let Some(column) = divider.filter(|column| *column < width) {
            texels.chunks_exact_mut(width as usize).for_each(|row| row[column as usize] = DIVIDER);
        }
        image_io::write_png(path, width, height, &texels)
    };
    written.map_err(|error| error.to_string())
}
