//! Sizes of the image. tests/gpu/behaviour/lifecycle.rs tests changes between any two sizes.

use super::furnace::{self, Furnace, ROUNDING};
use super::painted::{Painted, adaptive, grey};
use super::{Breaks, Case, Worst};
use crate::stability::common::scenes::quad;
use asvgf::Camera;

pub const CASES: &[Case] = &[
    Case {
        name: "traced images",
        varied: "1×1, 1×N, N×1, 2×2, 3×3, primes, neighbours of multiples of 3 and 8, 8192×1, 1×8192",
        quantity: "largest difference of a pixel from ½ (surface) or 1 (sky)",
        bound: ROUNDING,
        origin: "a surface of albedo ½ under a white sky, at any size",
        measure: traced,
        breaks: Breaks::Known("sizes above the device's `max_texture_dimension_2d` are refused by name"),
    },
    Case {
        name: "a host's images",
        varied: "the same sizes, with pairs",
        quantity: "largest difference of a pixel from 1",
        bound: ROUNDING,
        origin: "a wall of radiance 1",
        measure: hosted,
        breaks: Breaks::Known("sizes above the device's `max_texture_dimension_2d` are refused by name"),
    },
];

const SIZES: [[u32; 2]; 20] = [
    [1, 1],
    [1, 2],
    [2, 1],
    [2, 2],
    [3, 3],
    [1, 17],
    [17, 1],
    [3, 8],
    [8, 3],
    [5, 7],
    [7, 5],
    [7, 9],
    [9, 7],
    [23, 24],
    [24, 25],
    [31, 37],
    [16, 64],
    [65, 10],
    [8192, 1],
    [1, 8192],
];

fn traced() -> Worst {
    let mut worst = Worst::default();
    let mut furnace = Furnace::new([4, 4]);
    for size in SIZES {
        let plane = quad([-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], 0);
        let camera = |_| Camera { eye: [0.2, 0.1, 2.0], target: [0.0; 3], ..Default::default() };
        furnace.resize(size);
        worst.add(furnace.farthest_seen(furnace::grey(vec![plane]), 3, camera), || format!("{size:?}"));
    }
    worst
}

fn hosted() -> Worst {
    let mut worst = Worst::default();
    let mut host = Painted::new([4, 4], adaptive());
    for size in SIZES {
        host.resize(size);
        let image = host.frames(3, &|_| grey(1.0));
        let away = image.iter().flatten().map(|x| f64::from((x - 1.0).abs()));
        worst.add(away.fold(0.0, f64::max), || format!("{size:?}"));
    }
    worst
}
