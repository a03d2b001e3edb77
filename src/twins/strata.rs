//! Records of strata and the weights between them, in f64.

use super::bench::{Bench, Texel};
use super::codec::{depth, unpack_normal};
use super::plane::{V, dot, sub};
use super::random::Random;
use crate::plan::Grid;

/// Tolerated distance from the plane, as a fraction of the depth.
const REACH: f64 = 0.02;

/// A falloff like e⁻ˣ: (1 − x/8)⁸, and 0 from 8 on.
pub(super) fn falloff(x: f64) -> f64 {
    (1.0 - x / 8.0).max(0.0).powi(8)
}

/// The surface point of a stratum's sample.
pub(super) struct Site {
    pub position: V,
    pub normal: V,
    pub depth: f64,
}

impl Bench {
    /// Records with a random sample pixel and a random previous pixel; some strata have none.
    pub fn records(&self, guide: &[[u32; 2]], random: &mut Random) -> Vec<Texel> {
        let [columns, rows] = Grid::Strata.extent(self.size).map(|s| s as i32);
        (0..columns * rows)
            .map(|i| {
                let place = random.below(9) as i32;
                let pixel = (i % columns * 3 + place % 3, i / columns * 3 + place / 3);
                match self.at(pixel.0, pixel.1).map(|p| guide[p]) {
                    Some(g) if depth(g) > 0.0 && random.unit() < 0.85 => {
                        let previous = self.size.map(|s| random.below(s as usize) as u32);
                        [place as u32 + 1, previous[0] | previous[1] << 16, g[0], g[1]]
                    }
                    _ => [0; 4],
                }
            })
            .collect()
    }

    /// Index of a stratum, if there is one.
    pub fn stratum(&self, x: i32, y: i32) -> Option<usize> {
        let [columns, rows] = Grid::Strata.extent(self.size).map(|s| s as i32);
        ((0..columns).contains(&x) && (0..rows).contains(&y)).then_some((y * columns + x) as usize)
    }

    pub fn strata(&self) -> Vec<(i32, i32)> {
        let [columns, rows] = Grid::Strata.extent(self.size).map(|s| s as i32);
        (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))).collect()
    }

    /// The sample pixel of a record.
    pub fn sample_pixel(record: Texel, x: i32, y: i32) -> (i32, i32) {
        let place = record[0] as i32 - 1;
        (3 * x + place % 3, 3 * y + place / 3)
    }

    pub fn site(&self, record: Texel, x: i32, y: i32) -> Site {
        let (px, py) = Self::sample_pixel(record, x, y);
        let depth = depth([record[2], record[3]]);
        Site { position: self.position(px, py, depth), normal: unpack_normal(record[2]), depth }
    }

    /// Taps of one iteration of the filter over strata: the stratum and its weight.
    pub fn strata_taps(&self, records: &[Texel], x: i32, y: i32, stride: i32) -> Vec<(usize, [f64; 2])> {
        let here = self.site(records[self.stratum(x, y).unwrap()], x, y);
        let offsets = (-1..=1).flat_map(|dy: i32| (-1..=1).map(move |dx: i32| (dx, dy)));
        offsets
            .filter_map(|(dx, dy)| {
                let (tx, ty) = (x + dx * stride, y + dy * stride);
                let i = self.stratum(tx, ty).filter(|&i| records[i][0] != 0)?;
                let exponent = exponent(&here, &self.site(records[i], tx, ty), here.depth * f64::from(stride));
                let tent = f64::from((2 - dx.abs()) * (2 - dy.abs()));
                Some((i, [tent * falloff(exponent), tent]))
            })
            .collect()
    }
}

/// Exponent of the geometric weight: the distance of a site from another's plane as a fraction of the reach, and the angle between
/// their normals.
pub(super) fn exponent(here: &Site, there: &Site, depth: f64) -> f64 {
    let distance = dot(here.normal, sub(there.position, here.position)).abs();
    distance / (REACH * depth) + 32.0 * (1.0 - dot(here.normal, there.normal))
}
