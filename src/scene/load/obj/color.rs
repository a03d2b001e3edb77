//! Colours of vertices: three or four numbers after the position in a `v` statement, or the comments of ZBrush.
//!
//! The format does not define the numbers. They are read as sRGB, as Blender and three.js do. A fourth number is a linear alpha.

use super::text::number;
use crate::scene::description::linear_from_srgb;
use crate::scene::load::common::report::Report;

const WHITE: [f32; 4] = [1.0; 4];
/// The largest rounding error of exporters.
const ROUNDING: f32 = 1.01;

/// The colours of a file.
#[derive(Default)]
pub(super) struct Colors {
    /// The colours of the file, by vertex. NaN for vertices without one.
    encoded: Vec<[f32; 4]>,
    mrgb: Vec<[f32; 4]>,
}

impl Colors {
    /// Adds the colour of a vertex. The error is the reason why it has none.
    pub fn add<'a>(
        &mut self,
        vertex: usize,
        words: impl Iterator<Item = &'a str>,
        commas: &mut bool,
    ) -> Result<(), String> {
        let mut color = [f32::NAN, f32::NAN, f32::NAN, f32::INFINITY];
        let mut count = 0;
        for word in words {
            let value = number(word, commas)?;
            if let Some(channel) = color.get_mut(count) {
                *channel = value;
            }
            count += 1;
        }
        if !(3..=4).contains(&count) {
            return Err(format!("there are {count} numbers, where 3 or 4 belong"));
        }
        self.encoded.resize(vertex, [f32::NAN; 4]);
        self.encoded.push(color);
        Ok(())
    }

    /// Adds a comment of ZBrush: up to 64 vertices as `MMRRGGBB`, whose first byte is a mask.
    pub fn add_mrgb(&mut self, digits: &str) {
        for vertex in digits.trim().as_bytes().as_chunks::<8>().0 {
            let digits = std::str::from_utf8(vertex).ok().and_then(|digits| u32::from_str_radix(digits, 16).ok());
            let Some(bits) = digits else { return };
            let [_, r, g, b] = bits.to_be_bytes();
            self.mrgb.push([r, g, b, 255].map(|byte| f32::from(byte) / 255.0));
        }
    }

    /// Linear colours of the first vertices, white for those without one. All vertices after these have none.
    pub fn linear(mut self, report: &mut Report) -> Vec<[f32; 4]> {
        if self.encoded.is_empty() {
            self.encoded = self.mrgb;
        }
        let largest = |values: &mut dyn Iterator<Item = f32>| values.filter(|x| x.is_finite()).fold(0.0, f32::max);
        let color = largest(&mut self.encoded.iter().flat_map(|&[r, g, b, _]| [r, g, b]));
        let alpha = largest(&mut self.encoded.iter().map(|&[.., alpha]| alpha));
        // Bytes are whole numbers. A number such as 2.5 is a colour that is too bright.
        let whole = self.encoded.iter().flatten().all(|x| !x.is_finite() || x.fract() == 0.0);
        let bytes = |largest: f32| if largest > 2.0 && whole { 255.0 } else { 1.0 };
        let divisors = [bytes(color), bytes(color), bytes(color), bytes(alpha)];
        let mut clamped = 0_usize;
        for color in &mut self.encoded {
            if color[0].is_nan() {
                *color = WHITE;
                continue;
            }
            let scaled: [f32; 4] =
                std::array::from_fn(|i| if color[i] == f32::INFINITY { 1.0 } else { color[i] / divisors[i] });
            clamped += usize::from(scaled.iter().any(|x| !(1.0 - ROUNDING..=ROUNDING).contains(x)));
            let [r, g, b, alpha] = scaled.map(|x| x.clamp(0.0, 1.0));
            *color = [linear_from_srgb(r), linear_from_srgb(g), linear_from_srgb(b), alpha];
        }
        if divisors != [1.0; 4] {
            let reason = format!("their largest number is {}; all are taken as 0…255", color.max(alpha));
            report.warn("vertex colours", reason);
        }
        if clamped > 0 {
            report.warn("vertex colours", format!("{clamped} are outside 0…1; they are brought into it"));
        }
        self.encoded
    }
}
