//! Several renderings of one frame in one picture, each with its name.

use crate::tone;
use asvgf::image_io::{self, ImageError};
use font8x8::UnicodeFonts as _;
use std::path::Path;

/// Pixels between renderings.
const GAP: usize = 2;

/// Mean radiance of a brightened dark scene, and the largest factor.
const MEAN: f32 = 0.1;
const BRIGHTEST: f32 = 8.0;

/// A rendering and its label.
pub struct Tile {
    pub label: String,
    pub colors: Vec<[f32; 3]>,
}

/// Returns the factor that makes a dark rendering legible; 1 for one that is bright enough.
pub fn exposure(colors: &[[f32; 3]]) -> f32 {
    let seen = colors.iter().map(|c| (0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]).min(1.0));
    let mean = seen.sum::<f32>() / colors.len() as f32;
    (MEAN / mean.max(1e-6)).clamp(1.0, BRIGHTEST)
}

/// Writes renderings of one size as one PNG: upright ones in a row, wide ones two by two.
pub fn write(path: &Path, [width, height]: [u32; 2], tiles: &[Tile], exposure: f32) -> Result<(), ImageError> {
    let (width, height) = (width as usize, height as usize);
    let columns = if width > height { 2 } else { tiles.len() };
    let rows = tiles.len().div_ceil(columns);
    // Letters of 8 pixels would be small in a large picture.
    let scale = (width / 300).max(1);
    let bar = 12 * scale;
    let mut canvas = Canvas::new(columns * (width + GAP) - GAP, rows * (bar + height + GAP) - GAP);
    for (i, tile) in tiles.iter().enumerate() {
        let (x, y) = (i % columns * (width + GAP), i / columns * (bar + height + GAP));
        canvas.text([x + 2 * scale, y + 2 * scale], x + width, scale, &tile.label);
        for (row, colors) in tile.colors.chunks_exact(width).enumerate() {
            for (column, &color) in colors.iter().enumerate() {
                canvas.set(x + column, y + bar + row, tone::pixel(color, exposure));
            }
        }
    }
    image_io::write_png(path, canvas.width as u32, canvas.height as u32, &canvas.pixels)
}

struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 4]>,
}

impl Canvas {
    fn new(width: usize, height: usize) -> Self {
        Self { width, height, pixels: vec![[24, 24, 24, 255]; width * height] }
    }

    fn set(&mut self, x: usize, y: usize, pixel: [u8; 4]) {
        self.pixels[y * self.width + x] = pixel;
    }

    /// Writes a line in letters of 8 · `scale` pixels, cut off at `end`.
    fn text(&mut self, [left, top]: [usize; 2], end: usize, scale: usize, line: &str) {
        for (i, letter) in line.chars().enumerate() {
            let glyph = font8x8::BASIC_FONTS.get(letter).unwrap_or_default();
            for (y, x) in (0..8 * scale).flat_map(|y| (0..8 * scale).map(move |x| (y, x))) {
                let at = left + i * 8 * scale + x;
                if at < end && top + y < self.height && glyph[y / scale] >> (x / scale) & 1 == 1 {
                    self.set(at, top + y, [235, 235, 235, 255]);
                }
            }
        }
    }
}
