//! Decision between pixels as points and pixels as areas.
//!
//! Images of many samples are smooth at edges, and frames of one sample are jagged. If such frames are to become such
//! an image, the edges must be smoothed. If pixels are points, as those of a rasterized G-buffer are, smoothing would
//! only blur them. Only the frames themselves show the difference.

use super::Pixels;
use super::layers::Layer;
use asvgf::image_io::{Attribute, ExrFile};

/// Evidence that pixels are areas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Area {
    /// Depths belong to points all over the pixels.
    Scattered,
    /// Blender wrote the file: its images are filtered, and its depths at one sample belong to the pixels' middles.
    Blender,
}

/// Distance of points from a regular grid, in pixels, from which on they are scattered. Points in half a pixel around
/// the middle have 0.7; points on a grid have rounding only.
const SCATTERED: f64 = 0.05;

/// Fewest triples of pixels for a decision.
const ENOUGH: usize = 50;

/// Least difference of two depths, in parts of them, that reveals the points' places.
const SLANTED: f64 = 1e-3;

/// Returns the evidence in the first frame.
pub fn area(of_blender: bool, pixels: &Pixels, size: [u32; 2]) -> Option<Area> {
    if scattered(pixels, size) >= SCATTERED {
        return Some(Area::Scattered);
    }
    of_blender.then_some(Area::Blender)
}

/// True if Blender wrote a file.
pub fn is_of_blender(file: &ExrFile) -> bool {
    matches!(file.attribute("BlenderMultiChannel"), Some(Attribute::Text(_)))
}

/// Returns the median of a ratio over three pixels in a row of one plane: the second difference of 1/z, which is 0 on a
/// grid, over the first difference.
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
