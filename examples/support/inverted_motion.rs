//! Motion the other way round.

use crate::parallel;

/// Rounds in which a motion is inverted.
const ROUNDS: usize = 6;

/// The motion to the next frame, n, of the motion m from there: what is at p now is at p + n then, so that n(p) = −m(p + n(p)), solved by
/// iteration from n = −m.
pub fn inverted(motion: &[f32], [width, height]: [u32; 2]) -> Vec<f32> {
    let (m, _) = motion.as_chunks::<2>();
    let finite = |m: [f32; 2]| m.map(|x| if x.is_finite() { x } else { 0.0 });
    let at = |x: i64, y: i64| {
        let (x, y) = (x.clamp(0, i64::from(width) - 1), y.clamp(0, i64::from(height) - 1));
        finite(m[y as usize * width as usize + x as usize])
    };
    let bilinear = |x: f32, y: f32| {
        let inside = |v: f32, side: u32| v.clamp(0.0, (side - 1) as f32);
        let (x, y) = (inside(x, width), inside(y, height));
        let (left, top) = (x.floor(), y.floor());
        let (u, v) = (x - left, y - top);
        let (left, top) = (left as i64, top as i64);
        let [a, b, c, d] = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| at(left + i, top + j));
        [0, 1].map(|k| (a[k] * (1.0 - u) + b[k] * u) * (1.0 - v) + (c[k] * (1.0 - u) + d[k] * u) * v)
    };
    let invert = |i: usize| {
        let (x, y) = ((i as u32 % width) as f32, (i as u32 / width) as f32);
        let mut n = finite(m[i]).map(|c| -c);
        for _ in 0..ROUNDS {
            n = bilinear(x + n[0], y + n[1]).map(|c| -c);
        }
        n
    };
    parallel::map(m.len(), invert).into_iter().flatten().collect()
}
