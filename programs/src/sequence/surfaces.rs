//! Pixels that show one surface.

use super::Pixels;
use super::layers::Layer;
use crate::sequence::camera::dot;

/// True if pixels of two frames, or of one, may show one surface: one object, depths within a tenth, directions within
/// 37°.
pub fn is_same(pixels: &Pixels, i: usize, other: &Pixels, j: usize) -> bool {
    let normals = [three(pixels, Layer::Normal, i), three(other, Layer::Normal, j)].map(|n| n.map(f64::from));
    one(pixels, Layer::Id, i).to_bits() == one(other, Layer::Id, j).to_bits()
        && (one(other, Layer::Depth, j) / one(pixels, Layer::Depth, i) - 1.0).abs() < 0.1
        && dot(normals[0], normals[1]) > 0.8
}

/// Returns for each pixel the first pixel of its surface: neighbours in a row or a column that show the same surface
/// are connected.
pub fn surfaces(pixels: &Pixels, [width, height]: [u32; 2]) -> Vec<usize> {
    fn root(parents: &mut [usize], mut i: usize) -> usize {
        while parents[i] != i {
            parents[i] = parents[parents[i]];
            i = parents[i];
        }
        i
    }
    let (width, count) = (width as usize, width as usize * height as usize);
    let mut parents: Vec<usize> = (0..count).collect();
    for i in 0..count {
        let left = (!i.is_multiple_of(width)).then(|| i - 1);
        for j in [left, i.checked_sub(width)].into_iter().flatten().filter(|&j| is_same(pixels, i, pixels, j)) {
            let (a, b) = (root(&mut parents, i), root(&mut parents, j));
            parents[a.max(b)] = a.min(b);
        }
    }
    (0..count).map(|i| root(&mut parents, i)).collect()
}

/// Returns a layer's number in a pixel, 0 if there is none.
pub fn one(pixels: &Pixels, layer: Layer, i: usize) -> f32 {
    pixels.get(layer).and_then(|samples| samples.get(i).copied()).unwrap_or_default()
}

/// Returns a layer's three numbers in a pixel.
pub fn three(pixels: &Pixels, layer: Layer, i: usize) -> [f32; 3] {
    let samples = pixels.get(layer).unwrap_or_default();
    std::array::from_fn(|c| samples.get(3 * i + c).copied().unwrap_or_default())
}
