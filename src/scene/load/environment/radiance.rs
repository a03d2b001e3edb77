//! Environment maps in Radiance's picture format.
//!
//! The `image` crate decodes the scanlines. It reads one orientation, one signature and no variable of the header. It therefore gets a
//! header in that form, and the file's own header is honoured here (Ward, "The RADIANCE Picture File Format").

use std::io::Cursor;

use image::{ImageFormat, ImageReader};

use super::picture::Picture;
use super::primaries::{differ, to_rec_709, xyz_to_rec_709};
use crate::image_io::limits;
use crate::scene::description::Environment;

/// Longest header that is read.
const LONGEST: usize = 1 << 20;

/// The content of a header.
struct Header {
    /// Scanlines, and texels of each.
    size: [usize; 2],
    /// True if scanlines are columns.
    columns: bool,
    /// True if scanlines, and texels in them, run up and to the left instead of down and to the right.
    reversed: [bool; 2],
    /// The factors by which texels were multiplied.
    exposure: [f32; 3],
    /// True if texels are X, Y and Z.
    xyz: bool,
    primaries: Option<[[f64; 2]; 4]>,
    /// Offset of the scanlines in the file.
    end: usize,
}

/// True if a file begins like a Radiance picture: with the signature or, because some writers omit that, with a text header.
pub(super) fn is_radiance(bytes: &[u8]) -> bool {
    bytes.starts_with(b"#?") || parse(bytes).is_ok()
}

pub(super) fn read(bytes: &[u8]) -> Result<Picture, String> {
    let header = parse(bytes)?;
    let [lines, length] = header.size;
    let mut plain = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {lines} +X {length}\n").into_bytes();
    plain.extend_from_slice(bytes.get(header.end..).unwrap_or_default());
    let mut reader = ImageReader::with_format(Cursor::new(plain), ImageFormat::Hdr);
    reader.limits(limits());
    let image = reader.decode().map_err(|error| format!("cannot be decoded: {error}"))?.into_rgb32f();

    let (width, height) = if header.columns { (lines, length) } else { (length, lines) };
    let mut warnings = Vec::new();
    let mut radiance = vec![[0.0; 3]; width * height];
    for (x, y, texel) in image.enumerate_pixels() {
        let place = |at: usize, count: usize, reversed: bool| if reversed { count - 1 - at } else { at };
        let line = place(y as usize, lines, header.reversed[0]);
        let texel_place = place(x as usize, length, header.reversed[1]);
        let at = if header.columns { texel_place * width + line } else { line * width + texel_place };
        radiance[at] = [0, 1, 2].map(|channel| texel.0[channel] / header.exposure[channel]);
    }
    /// The white of Radiance, to which X, Y and Z are relative, has equal energy.
    const EQUAL_ENERGY: [f64; 2] = [1.0 / 3.0, 1.0 / 3.0];
    if header.xyz {
        if let Some(map) = xyz_to_rec_709(EQUAL_ENERGY) {
            radiance.iter_mut().for_each(|color| *color = map(*color));
        }
    } else if let Some(primaries) = header.primaries.filter(|&primaries| differ(primaries)) {
        match to_rec_709(primaries) {
            Some(map) => radiance.iter_mut().for_each(|color| *color = map(*color)),
            None => warnings.push(format!("the primaries {primaries:?} span no colours; they are taken for Rec. 709")),
        }
    }
    Ok((Environment { width: width as u32, height: height as u32, radiance }, warnings))
}

fn parse(bytes: &[u8]) -> Result<Header, String> {
    let mut header = Header {
        size: [0; 2],
        columns: false,
        reversed: [false; 2],
        exposure: [1.0; 3],
        xyz: false,
        primaries: None,
        end: 0,
    };
    let start = &bytes[..bytes.len().min(LONGEST)];
    let mut variables = true;
    for line in start.split_inclusive(|&byte| byte == b'\n') {
        header.end += line.len();
        let length = line.len();
        // Names of people may be in any encoding.
        let line = String::from_utf8_lossy(line);
        let line = line.trim_end_matches(['\r', '\n']);
        if !variables {
            header.resolution(line).ok_or_else(|| format!("\"{line}\" is not the size of a Radiance picture"))?;
            return Ok(header);
        }
        if line.is_empty() {
            variables = false;
        } else if header.end == length && header.resolution(line).is_some() {
            break; // a size in the first line: no header at all
        } else if !line.starts_with('#') {
            header.variable(line)?;
        }
    }
    Err("is not a Radiance picture: its header does not end".into())
}

impl Header {
    fn variable(&mut self, line: &str) -> Result<(), String> {
        let Some((name, value)) = line.split_once('=') else { return Ok(()) };
        let numbers: Vec<f64> = value.split_whitespace().map_while(|word| word.parse().ok()).collect();
        match (name.trim(), numbers.as_slice()) {
            ("FORMAT", _) => match value.trim() {
                "32-bit_rle_rgbe" => self.xyz = false,
                "32-bit_rle_xyze" => self.xyz = true,
                other => return Err(format!("is a Radiance picture of the format {other}, which is not read")),
            },
            // Several of one kind multiply.
            ("EXPOSURE", &[factor]) if factor > 0.0 => {
                self.exposure = self.exposure.map(|exposure| exposure * factor as f32);
            }
            ("COLORCORR", &[r, g, b]) if r > 0.0 && g > 0.0 && b > 0.0 => {
                for (exposure, factor) in self.exposure.iter_mut().zip([r, g, b]) {
                    *exposure *= factor as f32;
                }
            }
            ("PRIMARIES", &[rx, ry, gx, gy, bx, by, wx, wy]) => {
                self.primaries = Some([[rx, ry], [gx, gy], [bx, by], [wx, wy]]);
            }
            _ => {}
        }
        Ok(())
    }

    /// Two signed axes, each with its length, the slower axis first. −Y is down, +X is to the right.
    fn resolution(&mut self, line: &str) -> Option<()> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let &[slow, lines, fast, length] = words.as_slice() else { return None };
        self.size = [lines.parse().ok().filter(|&size| size > 0)?, length.parse().ok().filter(|&size| size > 0)?];
        self.columns = matches!(slow, "+X" | "-X");
        let axes = if self.columns { ["+Y", "-Y"] } else { ["+X", "-X"] };
        let sound = self.columns || matches!(slow, "+Y" | "-Y");
        self.reversed = [slow, fast].map(|axis| matches!(axis, "+Y" | "-X"));
        (sound && axes.contains(&fast)).then_some(())
    }
}
