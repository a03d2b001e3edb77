//! Places between pixels and around them.

/// Returns the pixels of a square around one, itself included, that lie within the image; `reach` is the size to each
/// side.
pub fn around([width, height]: [usize; 2], i: usize, reach: usize) -> impl Iterator<Item = usize> {
    let near = |at: usize, side: usize| at.saturating_sub(reach)..=(at + reach).min(side - 1);
    let columns = near(i % width, width);
    near(i / width, height).flat_map(move |y| columns.clone().map(move |x| y * width + x))
}

/// Interpolates a value between four pixels; beyond the border, the border's value applies.
pub fn bilinear<const N: usize>(
    [width, height]: [usize; 2],
    [x, y]: [f32; 2],
    at: impl Fn(usize) -> [f32; N],
) -> [f32; N] {
    let inside = |v: f32, side: usize| v.clamp(0.0, (side - 1) as f32);
    let (x, y) = (inside(x, width), inside(y, height));
    let (left, top) = (x as usize, y as usize);
    let (right, bottom) = ((left + 1).min(width - 1), (top + 1).min(height - 1));
    let (u, v) = (x - left as f32, y - top as f32);
    let [a, b, c, d] = [(left, top), (right, top), (left, bottom), (right, bottom)].map(|(x, y)| at(y * width + x));
    std::array::from_fn(|k| (a[k] * (1.0 - u) + b[k] * u) * (1.0 - v) + (c[k] * (1.0 - u) + d[k] * u) * v)
}
