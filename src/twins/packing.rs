//! The packed formats lose no more than documented.

use super::codec::{pack_motion, unpack_motion};
use super::compute::compute;
use super::plane::{V, cross, dot, length, unit};
use super::random::Random;
use crate::passes::resolve;
use crate::plan::Features;

struct Case {
    color: [f32; 3],
    normal: V,
    octahedral: u32,
    motion: V,
}

fn cases() -> Vec<Case> {
    let mut random = Random(1);
    let mut cases: Vec<Case> = (0..20_000)
        .map(|_| {
            let scale = 10.0_f64.powf(random.between(-30.0, 30.0));
            Case {
                color: [0; 3].map(|_| (scale * random.unit()) as f32),
                normal: random.direction(),
                octahedral: (random.unit() * 4294967295.0) as u32,
                motion: [random.between(-4200.0, 4200.0), random.between(-9.0, 9.0), 1000.0 * random.unit().powi(4)]
                    .map(|m| f64::from(m as f32)),
            }
        })
        .collect();
    // The edge cases are nothing, one channel alone, the largest mantissa, powers of two, and motions at their limits.
    let edges =
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1e-30], [1e30, 0.0, 1e29], [0.999_999_9; 3], [2.0; 3], [1e-36; 3]];
    for (case, color) in cases.iter_mut().zip(edges) {
        case.color = color;
    }
    let motions = [[0.0; 3], [4095.25, -4095.25, 0.0], [4096.0, 0.0, 1.0], [0.0, -1e9, 1.0], [1.0 / 256.0, -1.0, 1e30]];
    for (case, motion) in cases.iter_mut().zip(motions) {
        case.motion = motion.map(|m| f64::from(m as f32));
    }
    for (i, case) in cases.iter_mut().take(6).enumerate() {
        case.normal = [0, 1, 2].map(|axis| if axis == i / 2 { 1.0 - 2.0 * (i % 2) as f64 } else { 0.0 });
    }
    cases
}

/// A point of the unfolded octahedron: x and y if z ≥ 0, folded over the edges |x| + |y| = 1 below.
fn octahedral(bits: u32) -> V {
    let [x, y] = [bits & 0xffff, bits >> 16].map(|b| f64::from(b) * 2.0 / 65535.0 - 1.0);
    let z = 1.0 - x.abs() - y.abs();
    if z >= 0.0 {
        return unit([x, y, z]);
    }
    unit([(1.0 - y.abs()) * x.signum(), (1.0 - x.abs()) * y.signum(), z])
}

#[test]
fn every_format_keeps_what_it_promises() {
    let cases = cases();
    let numbers: Vec<[f32; 4]> = cases
        .iter()
        .flat_map(|c| {
            let [r, g, b] = c.color;
            let [x, y, z] = c.normal.map(|n| n as f32);
            let [mx, my, depth] = c.motion.map(|m| m as f32);
            [[r, g, b, 0.0], [x, y, z, 0.0], [mx, my, depth, f32::from_bits(c.octahedral)]]
        })
        .collect();
    let results = compute(include_str!("packing.wgsl"), &resolve::PASS, Features::default(), &numbers, 6 * cases.len());
    for (case, found) in cases.iter().zip(results.chunks_exact(6)) {
        let largest = f64::from(case.color.into_iter().fold(0.0, f32::max));
        for (i, &exact) in case.color.iter().enumerate() {
            let (back, x) = (f64::from(found[0][i]), f64::from(exact));
            // The error is a rounded step of 18 bits of the largest channel; below 2⁻¹⁰⁸, of the smallest exponent.
            assert!(
                (back - x).abs() <= largest * 1.0001 * 2.0_f64.powi(-18) + 2.0_f64.powi(-126),
                "{back} for {x} of {largest}"
            );
            assert!(exact != 0.0 || back == 0.0, "zero became {back}");
            let (half, inside) = (f64::from(found[2][i]), (2.0_f64.powi(-30)..8.5e9).contains(&x));
            assert!(!inside || (half - x).abs() <= x * 2.0_f64.powi(-11), "16 bits: {half} for {x}");
            assert!(x < 8.5e9 || (half / 8.5e9 - 1.0).abs() < 1e-2, "16 bits: {half} for {x}");
            assert!(x > 2.0_f64.powi(-30) || half <= 2.0_f64.powi(-30), "16 bits: {half} for {x}");
            let (f16, normal) = (f64::from(found[4][i]), (6.2e-5..65000.0).contains(&x));
            assert!(!normal || (f16 - x).abs() <= x * 2.0_f64.powi(-11), "f16: {f16} for {x}");
            assert!(!normal || f16.to_bits() << 22 == 0, "f16: {f16} has more than 10 bits of mantissa");
        }
        let back = [found[1][0], found[1][1], found[1][2]].map(f64::from);
        let angle = length(cross(back, case.normal)).atan2(dot(back, case.normal)).to_degrees();
        assert!(angle <= 0.1 && (length(back) - 1.0).abs() < 2e-3, "{angle}° off: {back:?} for {:?}", case.normal);
        let moved = [found[5][0], found[5][1], found[5][2]].map(f64::from);
        assert_eq!(moved, unpack_motion(pack_motion(case.motion)), "{:?}", case.motion);
        let near = case.motion[..2].iter().all(|m| m.abs() < 4095.5);
        for (m, exact) in moved.into_iter().zip(case.motion).take(2) {
            assert!(if near { (m - exact).abs() <= 1.0 / 512.0 } else { moved[0] == -1e6 }, "motion {m} for {exact}");
        }
        assert!((moved[2] / case.motion[2] - 1.0).abs() <= 2.0_f64.powi(-15) || moved[2] == case.motion[2]);
        let unfolded = octahedral(case.octahedral);
        for (i, expected) in unfolded.into_iter().enumerate() {
            // The error comes from cancellation in 1 − |x| − |y| and from the rounding of a square root.
            assert!((f64::from(found[3][i]) - expected).abs() < 1e-6, "{:?} for {unfolded:?}", found[3]);
        }
    }
}
