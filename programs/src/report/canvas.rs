//! Canvas of pixels for plots and pictures, with its own letters: no font need be installed.

use asvgf::image_io::{self, ImageError};
use font8x8::{BASIC_FONTS, GREEK_FONTS, LATIN_FONTS, UnicodeFonts as _};
use plotters::prelude::DrawingBackend;
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{BackendColor, BackendCoord, BackendTextStyle, DrawingErrorKind, FontTransform};
use std::convert::Infallible;
use std::path::Path;

/// Width and height of a letter.
pub const LETTER: i32 = 8;

pub struct Canvas {
    size: [u32; 2],
    pixels: Vec<[u8; 4]>,
}

impl Canvas {
    pub fn new(size: [u32; 2], color: [u8; 4]) -> Self {
        Self { size, pixels: vec![color; size[0] as usize * size[1] as usize] }
    }

    /// Sets a pixel, if it is inside.
    pub fn set(&mut self, [x, y]: [i32; 2], color: [u8; 4]) {
        if let Some(pixel) = self.pixel([x, y]) {
            *pixel = color;
        }
    }

    /// Writes a line, beginning at its upper left corner.
    pub fn text(&mut self, [left, top]: [i32; 2], color: [u8; 4], line: &str) {
        for (x, y) in dots(line) {
            self.set([left + x, top + y], color);
        }
    }

    pub fn save(&self, path: &Path) -> Result<(), ImageError> {
        image_io::write_png(path, self.size[0], self.size[1], &self.pixels)
    }

    fn pixel(&mut self, [x, y]: [i32; 2]) -> Option<&mut [u8; 4]> {
        let [width, height] = self.size.map(|side| side as i32);
        let inside = (0..width).contains(&x) && (0..height).contains(&y);
        self.pixels.get_mut(if inside { (y * width + x) as usize } else { usize::MAX })
    }
}

/// Returns the dots of a line of letters, relative to its upper left corner.
fn dots(line: &str) -> impl Iterator<Item = (i32, i32)> {
    line.chars().enumerate().flat_map(|(i, letter)| {
        let glyph = BASIC_FONTS.get(letter).or_else(|| GREEK_FONTS.get(letter)).or_else(|| LATIN_FONTS.get(letter));
        let glyph = glyph.unwrap_or_default();
        let places = (0..LETTER).flat_map(|y| (0..LETTER).map(move |x| (x, y)));
        let lit = places.filter(move |&(x, y)| glyph[y as usize] >> x & 1 == 1);
        lit.map(move |(x, y)| (x + i as i32 * LETTER, y))
    })
}

/// Adapter through which plotters draws on a canvas.
pub struct Ink<'a>(pub &'a mut Canvas);

impl DrawingBackend for Ink<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        (self.0.size[0], self.0.size[1])
    }

    fn ensure_prepared(&mut self) -> Result<(), DrawingErrorKind<Infallible>> {
        Ok(())
    }

    fn present(&mut self) -> Result<(), DrawingErrorKind<Infallible>> {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Result<(), DrawingErrorKind<Infallible>> {
        if let Some(pixel) = self.0.pixel([x, y]) {
            let (r, g, b) = color.rgb;
            for (channel, new) in pixel.iter_mut().zip([r, g, b]) {
                let mixed = color.alpha * f64::from(new) + (1.0 - color.alpha) * f64::from(*channel);
                *channel = mixed.round() as u8;
            }
        }
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        (x, y): BackendCoord,
    ) -> Result<(), DrawingErrorKind<Infallible>> {
        let width = LETTER * text.chars().count() as i32;
        let left = match style.anchor().h_pos {
            HPos::Left => 0,
            HPos::Center => -width / 2,
            HPos::Right => -width,
        };
        let top = match style.anchor().v_pos {
            VPos::Top => 0,
            VPos::Center => -LETTER / 2,
            VPos::Bottom => -LETTER,
        };
        let (r, g, b) = style.color().rgb;
        for (dx, dy) in dots(text) {
            let (dx, dy) = (dx + left, dy + top);
            let [dx, dy] = match style.transform() {
                FontTransform::None => [dx, dy],
                FontTransform::Rotate90 => [-dy, dx],
                FontTransform::Rotate180 => [-dx, -dy],
                FontTransform::Rotate270 => [dy, -dx],
            };
            self.0.set([x + dx, y + dy], [r, g, b, 255]);
        }
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        _: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        Ok((LETTER as u32 * text.chars().count() as u32, LETTER as u32))
    }
}
