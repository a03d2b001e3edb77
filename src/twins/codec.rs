//! The textures' formats in f64, and images to try passes on.

use super::bench::{Bench, Texel};
use super::plane::{Pinhole, V, add, dot, scale, sub, unit};
use super::random::Random;

pub(super) fn luminance(c: V) -> f64 {
    dot(c, [0.2126, 0.7152, 0.0722])
}

/// A common exponent of 8 bits and three mantissas of 18.
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

/// 6 bits of exponent, 10 of mantissa, no sign.
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

/// In steps of 1/256 pixel, 21 bits each with a sign; what is too far leads nowhere. The depth has 14 bits of mantissa.
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

pub(super) fn pack_normal(n: V) -> u32 {
    let q = n.map(|x| ((x * 511.0).round() as i32 & 0x3ff) as u32);
    q[0] | q[1] << 10 | q[2] << 20
}

pub(super) fn unpack_normal(bits: u32) -> V {
    [0, 10, 20].map(|shift| f64::from((bits << (22 - shift)) as i32 >> 22) / 511.0)
}

/// Colour and standard deviation.
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
        add(self.camera.eye.map(f64::from), scale(self.ray(x, y), depth))
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
        let eye = self.camera.eye.map(f64::from);
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
