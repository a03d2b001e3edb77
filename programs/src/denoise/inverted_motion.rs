//! Inversion of motion.

use crate::denoise::grid::bilinear;
use crate::denoise::parallel;

/// Iterations of the inversion.
const ROUNDS: usize = 6;

/// Returns the motion n to the next frame, given the motion m from there. A point at p now is at p + n then, so n(p) =
/// −m(p + n(p)), solved by iteration from n = −m.
pub fn inverted(motion: &[f32], [width, height]: [u32; 2]) -> Vec<f32> {
    let (m, _) = motion.as_chunks::<2>();
    let finite = |m: [f32; 2]| m.map(|x| if x.is_finite() { x } else { 0.0 });
    let size = [width as usize, height as usize];
    let invert = |i: usize| {
        let (x, y) = ((i as u32 % width) as f32, (i as u32 / width) as f32);
        let mut n = finite(m[i]).map(|c| -c);
        for _ in 0..ROUNDS {
            n = bilinear(size, [x + n[0], y + n[1]], |j| finite(m[j])).map(|c| -c);
        }
        n
    };
    parallel::map(m.len(), invert).into_iter().flatten().collect()
}
