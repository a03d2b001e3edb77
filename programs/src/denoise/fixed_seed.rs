//! Detects a renderer that takes the same random numbers in each frame.

use crate::sequence::Pixels;
use crate::sequence::camera::Camera;
use crate::sequence::layers::Layer;

/// State of the test for a fixed seed, with which a renderer takes the same random numbers in each frame. One
/// repetition proves nothing, because a sequence may hold a frame. Two in a row prove a fixed seed, until two frames in
/// a row differ: a light may change in between.
#[derive(Default)]
pub struct FixedSeed {
    fixed: bool,
    same: u32,
    other: u32,
}

impl FixedSeed {
    pub fn observe(&mut self, repeats: bool) -> bool {
        (self.same, self.other) = if repeats { (self.same + 1, 0) } else { (0, self.other + 1) };
        self.fixed = if self.fixed { self.other < 2 } else { self.same >= 2 };
        self.fixed
    }
}

/// Part of the lit pixels at rest that must show the same noise before it counts as repeated.
const REPEATED: f32 = 0.5;

/// Fewest pixels at rest for a decision.
const FEWEST: usize = 64;

/// Difference of a pixel to the mean of its neighbours, over that mean, from which on it is noise.
const NOISY: f32 = 0.05;

/// True if a frame has the random numbers of the last one, as from a renderer with a fixed seed: pixels at rest then
/// show the same noise to the last bit.
pub fn repeats_noise(last: &Pixels, now: &Pixels, width: u32, [camera, before]: [Camera; 2]) -> bool {
    let radiance = |pixels| Pixels::get(pixels, Layer::Color).unwrap_or_default();
    let (was, is) = (radiance(last), radiance(now));
    let depth = now.get(Layer::Depth).unwrap_or_default();
    let motion = now.get(Layer::Motion);
    let rests = |i: usize| match motion {
        Some(motion) => motion[2 * i].abs().max(motion[2 * i + 1].abs()) < 1e-3,
        None => camera == before,
    };
    let brightness = |i: usize| is[3 * i..3 * i + 3].iter().sum::<f32>();
    // Compares a pixel with its two neighbours in the row, because an image without noise may well stay the same.
    let is_noisy = |i: usize| {
        let column = i as u32 % width;
        let inside = column > 0 && column + 1 < width;
        let around = if inside { 0.5 * (brightness(i - 1) + brightness(i + 1)) } else { brightness(i) };
        (brightness(i) - around).abs() > NOISY * around
    };
    let (mut counted, mut same, mut noisy) = (0, 0, 0);
    for (i, (a, b)) in was.chunks_exact(3).zip(is.chunks_exact(3)).enumerate() {
        if depth[i] > 0.0 && rests(i) && b.iter().any(|x| *x != 0.0) {
            counted += 1;
            same += usize::from(a == b);
            noisy += usize::from(is_noisy(i));
        }
    }
    let most = REPEATED * counted as f32;
    counted >= FEWEST && same as f32 > most && noisy as f32 > most
}
