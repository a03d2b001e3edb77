//! Whether a pixel stands for a point or for its whole area.
//!
//! Images of many samples are smooth at edges, and frames of one sample are jagged. Where they shall become such an image, edges are to be smoothed; where pixels are
//! points, as those of a G-buffer that was rasterized, that would only blur them. Nothing but the frames tells which it is.

use super::Pixels;
use super::layers::Layer;
use asvgf::image_io::{Attribute, ExrFile};

/// Why pixels are taken for areas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Area {
    /// Depths are those of points all over the pixels.
    Scattered,
    /// Blender wrote the file: its images are filtered, and its depths at one sample are those of the pixels' middles.
    Blender,
}

/// How far, in pixels, points lie apart from a regular grid, from which on they are scattered. In half a pixel around the middle, 0.7; in a grid, rounding.
const SCATTERED: f64 = 0.05;

/// Fewest triples of pixels that tell.
const ENOUGH: usize = 50;

/// Least difference of two depths, in parts of them, that tells where points are.
const SLANTED: f64 = 1e-3;

/// What the first frame tells.
pub fn area(of_blender: bool, pixels: &Pixels, size: [u32; 2]) -> Option<Area> {
    if scattered(pixels, size) >= SCATTERED {
        return Some(Area::Scattered);
    }
    of_blender.then_some(Area::Blender)
}

/// Whether Blender wrote a file.
pub fn is_of_blender(file: &ExrFile) -> bool {
    matches!(file.attribute("BlenderMultiChannel"), Some(Attribute::Text(_)))
}

/// The median over three pixels in a row of one plane: how much the second difference of 1/z, which is 0 on a grid, is in parts of the first.
fn scattered(pixels: &Pixels, [width, height]: [u32; 2]) -> f64 {
    let (Some(depth), Some(normal)) = (pixels.get(Layer::Depth), pixels.get(Layer::Normal)) else { return 0.0 };
    let (width, height) = (width as usize, height as usize);
    let n = |i: usize| [normal[3 * i], normal[3 * i + 1], normal[3 * i + 2]];
    let mut found = Vec::new();
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        for (step, fits) in [(1, x + 2 < width), (width, y + 2 < height)] {
            let at = [0, 1, 2].map(|k| y * width + x + k * step);
            if !fits || n(at[0]) != n(at[1]) || n(at[0]) != n(at[2]) {
                continue;
            }
            let [a, b, c] = at.map(|i| 1.0 / f64::from(depth[i]));
            let slope = 0.5 * (c - a).abs();
            if [a, b, c].iter().all(|x| x.is_finite() && *x > 0.0) && slope > SLANTED * b {
                found.push((a - 2.0 * b + c).abs() / slope);
            }
        }
    }
    if found.len() < ENOUGH {
        return 0.0;
    }
    let middle = found.len() / 2;
    *found.select_nth_unstable_by(middle, f64::total_cmp).1
}
