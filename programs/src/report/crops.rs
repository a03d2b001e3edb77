//! Pictures side by side, with maps of their errors as an eye sees them.

use crate::report::canvas::{Canvas, LETTER};
use crate::report::truth::Rgb;
use crate::tone;
use std::error::Error;
use std::path::Path;

/// Pixels between pictures.
const GAP: i32 = 4;
const GREY: [u8; 4] = [24, 24, 24, 255];
const WHITE: [u8; 4] = [235, 235, 235, 255];

/// Width in pixels to which small pictures are magnified, about.
const WIDTH: u32 = 288;

/// Writes renderings with their names, the reference last. With the feature `flip`, each but the reference has its FLIP
/// map below it, and the map's mean.
pub fn write(path: &Path, size: [u32; 2], tiles: &[(String, Vec<Rgb>)]) -> Result<(), Box<dyn Error>> {
    let Some((_, reference)) = tiles.last() else { return Ok(()) };
    let scale = (WIDTH / size[0]).max(1) as i32;
    let [width, height] = size.map(|side| side as i32 * scale);
    let bar = LETTER + 4;
    let rows = if cfg!(feature = "flip") { 2 } else { 1 };
    let side = [tiles.len() as i32 * (width + GAP) - GAP, rows * (bar + height + GAP) - GAP];
    let mut canvas = Canvas::new(side.map(|pixels| pixels as u32), GREY);
    let exposure = exposure(reference);
    let mut tile = |[column, row]: [i32; 2], label: &str, pixels: &[[u8; 4]]| {
        let [left, top] = [column * (width + GAP), row * (bar + height + GAP)];
        canvas.text([left + 2, top + 2], WHITE, label);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let pixel = pixels[(y / scale) as usize * size[0] as usize + (x / scale) as usize];
            canvas.set([left + x, top + bar + y], pixel);
        }
    };
    for (column, (label, colors)) in tiles.iter().enumerate() {
        let pixels: Vec<_> = colors.iter().map(|&color| tone::pixel(color, exposure)).collect();
        tile([column as i32, 0], label, &pixels);
    }
    #[cfg(feature = "flip")]
    {
        use asvgf::metrics::{PIXELS_PER_DEGREE, Pair, encode, flip};
        let truth = encode(reference, exposure);
        for (column, (_, colors)) in tiles[..tiles.len() - 1].iter().enumerate() {
            let shown = encode(colors, exposure);
            let map = flip(&Pair::new(&shown, &truth)?, size, PIXELS_PER_DEGREE)?;
            tile([column as i32, 1], &format!("FLIP {:.4}", map.mean), &map.picture());
        }
    }
    Ok(canvas.save(path)?)
}

/// Returns the factor that makes a dark rendering legible; 1 for one that is bright enough.
fn exposure(colors: &[Rgb]) -> f32 {
    let seen = colors.iter().map(|c| (0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]).min(1.0));
    let mean = seen.sum::<f32>() / colors.len() as f32;
    (0.1 / mean.max(1e-6)).clamp(1.0, 8.0)
}
