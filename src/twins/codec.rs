//! The formats of textures in f64, and images to try passes on.

use super::bench::{Bench, Texel};
use super::plane::{Pinhole, V, add, dot, scale, sub, unit};
use super::random::Random;

pub(super) fn luminance(c: V) -> f64 {
    dot(c, [0.2126, 0.7152, 0.0722])
}

/// Packs a colour with a common exponent of 8 bits and three mantissas of 18.
pub(super) fn pack_rgb(c: V) -> [u32; 2] {
    let largest = c.into_iter().fold(0.0, f64::max);
    let exponent = (largest.log2().floor() as i32 + 128).clamp(19, 253);
    let step = 2.0_f64.powi(exponent - 127 - 18);
    let m = c.map(|x| ((x / step).round() as u64).min((1 << 18) - 1));
    let bits = m[0] | m[1] << 18 | m[2] << 36 | (exponent as u64) << 54;
    [bits as u32, (bits >> 32) as u32]
}

pub(super) fn unpack_rgb(words: [u32; 2]) -> V {
    let bits = u64::from(words[0]) | u64::from(words[1]) << 32;
    let step = 2.0_f64.powi((bits >> 54) as i32 - 127 - 18);
    [0, 18, 36].map(|shift| (bits >> shift & 0x3ffff) as f64 * step)
}

/// Packs a number into 6 bits of exponent and 10 of mantissa, without a sign.
pub(super) fn pack_unsigned(x: f64) -> u32 {
    if x < 2.0_f64.powi(-30) {
        return 0;
    }
    let exponent = x.log2().floor();
    ((exponent + 31.0) * 1024.0 + ((x / exponent.exp2() - 1.0) * 1024.0).round()) as u32
}

pub(super) fn unpack_unsigned(bits: u32) -> f64 {
    match bits >> 10 {
        0 => 0.0,
        e => (1.0 + f64::from(bits & 1023) / 1024.0) * 2.0_f64.powi(e as i32 - 31),
    }
}

/// The history of a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Kept {
    pub color: V,
    pub variance: f64,
    pub length: f64,
}

/// The least power of two that is above the history's colour, even when its largest channel is rounded up to 13 bits, and whose
/// square times 2¹¹ is above the variance. At least −113; with a variance that f32 can hold, at least −68.
pub(super) fn history_exponent(color: V, variance: f64) -> i32 {
    let largest = color.into_iter().fold(0.0, f64::max);
    let below = largest.log2().floor() as i32 + 1;
    let below = below + i32::from(largest > f64::from(below).exp2() * 8191.0 / 8192.0);
    let of_color = if largest > 0.0 { below } else { i32::MIN };
    let of_variance = if variance < f64::from(f32::MIN_POSITIVE) {
        i32::MIN
    } else {
        (variance.log2().floor() as i32 + 127) / 2 - 68
    };
    of_color.max(of_variance).clamp(-113, 126)
}

/// The variance whose code is 0, as a fraction of the square of the history's power of two.
pub(super) const VARIANCE_UNIT: f64 = 1.0 / 1_048_576.0;

/// The code of a variance before rounding; the variance is a fraction of the square of the history's power of two.
pub(super) fn variance_code(relative: f64) -> f64 {
    float_code(relative / VARIANCE_UNIT, 16.0)
}

/// The code of a number before rounding, as a float with this number of steps in an octave; the code of 2⁰ is 0.
pub(super) fn float_code(x: f64, steps: f64) -> f64 {
    let exponent = x.log2().floor();
    steps * (exponent + x / exponent.exp2() - 1.0)
}

fn from_float_code(code: f64, steps: f64) -> f64 {
    let exponent = (code / steps).floor();
    exponent.exp2() * (1.0 + code / steps - exponent)
}

/// Packs a history, rounded to the nearest: 3 × 13 bits and their exponent; 9 bits of variance; 8 bits of length, in which a
/// length of 1 has the code 1.
pub(super) fn pack_history(kept: Kept) -> [u32; 2] {
    if kept.length == 0.0 {
        return [0; 2];
    }
    let exponent = history_exponent(kept.color, kept.variance);
    let scale = f64::from(exponent).exp2();
    let [r, g, b] = kept.color.map(|c| (c / scale * 8192.0).round() as u64);
    let relative = kept.variance / (scale * scale);
    let variance = if relative < 2.0 * VARIANCE_UNIT { 0 } else { variance_code(relative).round() as u64 };
    let length = (float_code(kept.length, 16.0) + 1.0).round() as u64;
    let bits = r | g << 13 | b << 26 | ((exponent + 127) as u64) << 39 | variance << 47 | length << 56;
    [bits as u32, (bits >> 32) as u32]
}

pub(super) fn unpack_history(words: [u32; 2]) -> Kept {
    let bits = u64::from(words[0]) | u64::from(words[1]) << 32;
    let field = |shift: u32, bits_wide: u32| (bits >> shift & ((1 << bits_wide) - 1)) as f64;
    let scale = (field(39, 8) - 127.0).exp2();
    let color = [0, 13, 26].map(|shift| field(shift, 13) / 8192.0 * scale);
    let (variance, length) = (field(47, 9), field(56, 8));
    let variance = if variance < 16.0 { 0.0 } else { from_float_code(variance, 16.0) * VARIANCE_UNIT * scale * scale };
    Kept { color, variance, length: if length == 0.0 { 0.0 } else { from_float_code(length - 1.0, 16.0) } }
}

/// PCG-RXS-M-XS 32 (O'Neill 2014).
pub(super) fn hash(x: u32) -> u32 {
    let state = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = (state >> ((state >> 28) + 4) ^ state).wrapping_mul(277_803_737);
    word >> 22 ^ word
}

/// Random numbers 0…1 for the rounding of a pixel's colour, variance and length: Roberts' sequence of three dimensions.
pub(super) fn rounding(pixel: [u32; 2], index: u32) -> V {
    let start = hash(pixel[0] ^ hash(pixel[1]));
    let step = [3_518_319_155_u32, 2_882_110_345, 2_360_945_575];
    let bits = [0, 11, 22].map(|shift| start << shift);
    [0, 1, 2].map(|i| f64::from(bits[i].wrapping_add(index.wrapping_mul(step[i]))) / 2.0_f64.powi(32))
}

/// Packs a motion in steps of 1/256 pixel, 21 signed bits each, and a depth with 14 bits of mantissa. A motion that is too long
/// leads nowhere.
pub(super) fn pack_motion(m: V) -> [u32; 2] {
    let near = m[..2].iter().all(|c| c.abs() < 4095.5);
    let q = [0, 1].map(|i| if near { (m[i] * 256.0).round_ties_even() as i64 } else { -(1 << 20) });
    let [x, y] = q.map(|q| q as u64 & 0x1f_ffff);
    let z = if m[2] > 0.0 { (u64::from(word(m[2])) + 256) >> 9 } else { 0 };
    let bits = x | y << 21 | z << 42;
    [bits as u32, (bits >> 32) as u32]
}

pub(super) fn unpack_motion(words: [u32; 2]) -> V {
    let bits = i64::from(words[0]) | i64::from(words[1]) << 32;
    let z = f64::from(f32::from_bits(((bits as u64 >> 42) as u32) << 9));
    match [bits << 43 >> 43, bits << 22 >> 43] {
        [q, _] if q == -(1 << 20) => [-1e6, -1e6, z],
        [x, y] => [x as f64 / 256.0, y as f64 / 256.0, z],
    }
}

/// A reflection: its motion in pixels, the distance of what is reflected, and the code of the roughness.
pub(super) fn pack_reflection([x, y, distance]: V, code: u32) -> [u32; 2] {
    let [low, high] = pack_motion([x, y, 0.0]);
    [low, high | code << 10 | ((pack_unsigned(distance) + 2) >> 2).clamp(0x100, 0x3fff) << 18]
}

/// The motion and the distance.
pub(super) fn unpack_reflection(words: [u32; 2]) -> V {
    let [x, y, _] = unpack_motion(words);
    [x, y, unpack_unsigned(words[1] >> 18 << 2)]
}

pub(super) fn pack_normal(n: V) -> u32 {
    let q = n.map(|x| ((x * 511.0).round() as i32 & 0x3ff) as u32);
    q[0] | q[1] << 10 | q[2] << 20
}

pub(super) fn unpack_normal(bits: u32) -> V {
    [0, 10, 20].map(|shift| f64::from((bits << (22 - shift)) as i32 >> 22) / 511.0)
}

/// Packs a colour and a standard deviation.
pub(super) fn pack_tap(color: V, deviation: f64) -> [u32; 2] {
    let [r, g, b] = color.map(pack_unsigned);
    [r | g << 16, b | pack_unsigned(deviation) << 16]
}

pub(super) fn unpack_tap(t: Texel) -> (V, f64) {
    let half = |w: u32, high: bool| unpack_unsigned(if high { w >> 16 } else { w & 0xffff });
    ([half(t[0], false), half(t[0], true), half(t[1], false)], half(t[1], true))
}

pub(super) fn depth(guide: [u32; 2]) -> f64 {
    f32::from_bits(guide[1]).into()
}

pub(super) fn float(word: u32) -> f64 {
    f32::from_bits(word).into()
}

pub(super) fn word(x: f64) -> u32 {
    (x as f32).to_bits()
}

impl Bench {
    pub fn pinhole(&self) -> Pinhole {
        Pinhole::new(&self.camera, self.size)
    }

    /// Direction of a pixel's ray with unit depth.
    pub fn ray(&self, x: i32, y: i32) -> V {
        let [jx, jy] = self.camera.jitter.map(f64::from);
        self.pinhole().ray(f64::from(x) + 0.5 + jx, f64::from(y) + 0.5 + jy)
    }

    /// World position of a pixel's surface.
    pub fn position(&self, x: i32, y: i32, depth: f64) -> V {
        add(self.camera.eye, scale(self.ray(x, y), depth))
    }

    pub fn pixels(&self) -> impl Iterator<Item = (i32, i32)> + use<> {
        let [w, h] = self.size.map(|s| s as i32);
        (0..h).flat_map(move |y| (0..w).map(move |x| (x, y)))
    }

    /// Index of a pixel, if there is one.
    pub fn at(&self, x: i32, y: i32) -> Option<usize> {
        let [w, h] = self.size.map(|s| s as i32);
        ((0..w).contains(&x) && (0..h).contains(&y)).then_some((y * w + x) as usize)
    }

    /// Normals and depths of a few planes, one of them grazing, with misses between and some bumps.
    pub fn guide(&self, random: &mut Random) -> Vec<[u32; 2]> {
        let planes: [(V, V); 4] = [
            ([0.0, 0.0, 1.0], [0.0, 0.0, 0.0]),
            (unit([0.6, 0.0, 0.5]), [0.5, 0.0, 0.0]),
            (unit([0.0, 1.0, 0.02]), [0.0, -0.6, 0.0]),
            (unit([-0.7, 0.3, 0.4]), [-0.5, 0.2, -1.0]),
        ];
        let eye = self.camera.eye;
        self.pixels()
            .map(|(x, y)| {
                let which = (x / 5 + y / 4) as usize % 5;
                let Some((normal, point)) = planes.get(which) else { return [0; 2] };
                let z = dot(*normal, sub(*point, eye)) / dot(*normal, self.ray(x, y));
                if !(0.5..50.0).contains(&z) {
                    return [0; 2];
                }
                let bump = if random.unit() < 0.2 { 0.15 } else { 0.0 };
                let n = unit(add(*normal, scale(random.direction(), bump)));
                [pack_normal(n), word(z * (1.0 + bump * random.between(-0.05, 0.05)))]
            })
            .collect()
    }
}

/// Radiances of every kind: dark, dim, bright, and a firefly.
pub(super) fn radiance(random: &mut Random) -> V {
    let scale = match random.below(12) {
        0 => 0.0,
        1 => 1e-7,
        2 => 1e5,
        _ => 1.0,
    };
    [0; 3].map(|_| scale * random.unit().powi(3))
}

/// Asserts that two numbers agree.
#[track_caller]
pub(super) fn assert_close(actual: f64, expected: f64, tolerance: f64, what: impl Fn() -> String) {
    let fine = (actual - expected).abs() <= tolerance;
    assert!(fine, "{}: {actual}, not {expected} ± {tolerance}", what());
}
