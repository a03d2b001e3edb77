//! Places of surfaces in the last frame.

use super::MetricError;

/// Returns for each pixel the one of the last frame that its motion leads to (previous − current position in pixels). `None`
/// if that is outside the image or not finite, or if `same(pixel, origin)` says that another surface was there.
///
/// # Errors
/// Fails if the motion is for another number of pixels than the size says.
pub fn origins(
    size: [u32; 2],
    motion: &[[f32; 2]],
    same: impl Fn(usize, usize) -> bool,
) -> Result<Vec<Option<usize>>, MetricError> {
    MetricError::size(size, motion.len())?;
    let [width, height] = size.map(|side| side as usize);
    let origin = |(pixel, moved): (usize, &[f32; 2])| {
        let x = ((pixel % width) as f32 + 0.5 + moved[0]).floor();
        let y = ((pixel / width) as f32 + 0.5 + moved[1]).floor();
        // NaN fails this test too.
        let inside = x >= 0.0 && y >= 0.0 && x < width as f32 && y < height as f32;
        let origin = inside.then(|| y as usize * width + x as usize)?;
        same(pixel, origin).then_some(origin)
    };
    Ok(motion.iter().enumerate().map(origin).collect())
}
