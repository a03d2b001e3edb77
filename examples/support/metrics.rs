//! How far a sequence is from the truth: error, bias, flicker.

/// A frame's pixels: a result, its reference, and what says which of them count.
pub struct Pair<'a> {
    pub image: &'a [[f32; 3]],
    pub reference: &'a [[f32; 3]],
    /// Pixels that are neither emitters nor misses.
    pub counted: &'a [bool],
}

/// mean (a − b)² / (b² + 0.01) over the counted pixels and their channels, a the image, b the reference.
pub fn rel_mse(pair: &Pair<'_>) -> f64 {
    mean(samples(pair).map(|(a, b)| (a - b) * (a - b) / (b * b + 0.01)))
}

/// mean (a − b) / mean b: brighter than the truth above 0, darker below.
pub fn bias(pair: &Pair<'_>) -> f64 {
    mean(samples(pair).map(|(a, b)| a - b)) / mean(samples(pair).map(|(_, b)| b))
}

/// mean |(aₜ − aₜ₋₁) − (bₜ − bₜ₋₁)| / mean bₜ along the motion: `origins` are the pixels of the last frame that saw the same
/// surface, `None` for those that do not count.
pub fn flicker(now: &Pair<'_>, before: &Pair<'_>, origins: &[Option<usize>]) -> f64 {
    let steady = || origins.iter().enumerate().filter_map(|(p, q)| Some((p, (*q)?)));
    let change = |a: &[[f32; 3]], b: &[[f32; 3]], p: usize, q: usize, c: usize| f64::from(a[p][c]) - f64::from(b[q][c]);
    let difference = mean(steady().flat_map(|(p, q)| (0..3).map(move |c| (p, q, c))).map(|(p, q, c)| {
        (change(now.image, before.image, p, q, c) - change(now.reference, before.reference, p, q, c)).abs()
    }));
    difference / mean(steady().flat_map(|(p, _)| now.reference[p].map(f64::from))).max(1e-6)
}

/// The channels of the counted pixels, image and reference.
fn samples(pair: &Pair<'_>) -> impl Iterator<Item = (f64, f64)> {
    let pixels = pair.image.iter().zip(pair.reference).zip(pair.counted).filter(|(_, counted)| **counted);
    pixels.flat_map(|((a, b), _)| (0..3).map(|c| (f64::from(a[c]), f64::from(b[c]))))
}

/// 0 of nothing.
pub fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_u64), |(sum, count), value| (sum + value, count + 1));
    if count == 0 { 0.0 } else { sum / count as f64 }
}
