//! The packed formats lose no more than documented.

use super::codec::{pack_motion, pack_reflection, unpack_motion, unpack_reflection};
use super::compute::compute;
use super::plane::{V, cross, dot, length, scale, unit};
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
            let size = 10.0_f64.powf(random.between(-30.0, 30.0));
            Case {
                color: [0; 3].map(|_| (size * random.unit()) as f32),
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

#[test]
fn gloss_and_displacements_too() {
    let mut random = Random(2);
    let mut numbers: Vec<[f32; 4]> = (0..20_000)
        .flat_map(|_| {
            let mut any = |low, high| 10.0_f64.powf(random.between(low, high));
            let [distance, depth, size] = [any(-8.0, 9.9), any(-18.0, 18.0), any(-8.0, 2.4)];
            let gloss = [random.unit(), distance, random.unit(), depth];
            // One component may be far below the others.
            let [x, y, z] = random.direction();
            let d = scale([x, y * random.unit().powi(8), z], size);
            [gloss, [d[0], d[1], d[2], 0.0]].map(|v| v.map(|x| x as f32))
        })
        .collect();
    // The edge cases are the ends of all ranges, and displacements at their limits.
    let edges = [
        ([0.0, 0.0, 0.0, 1e-18], [0.0; 3]),
        ([1.0, 8e9, 1.0, 1e18], [-256.0, 256.0, 0.0]),
        ([-1.0, -1.0, -1.0, 1.0], [0.0, 0.0, 5.96e-8]),
        ([2.0, 3e38, 2.0, 1.0], [5.9e-8, 0.0, 0.0]),
        ([0.5, 1e-30, 0.5, 1.999_999_9], [1.0, -1.0, 1.0]),
        ([0.5, 1.0, 0.5, 1.0], [0.999_999_9, 0.0, -1e-3]),
        ([0.5, 1.0, 0.5, 1.0], [1e3, -1.0, 0.0]),
    ];
    for (case, (gloss, [x, y, z])) in numbers.chunks_exact_mut(2).zip(edges) {
        (case[0], case[1]) = (gloss, [x, y, z, 0.0]);
    }
    let results = compute(
        include_str!("packing_gloss.wgsl"),
        &resolve::PASS,
        Features::default(),
        &numbers,
        5 * numbers.len() / 2,
    );
    let mut worst = 0.0_f64;
    for (case, found) in numbers.chunks_exact(2).zip(results.chunks_exact(5)) {
        let [roughness, distance, part, depth] = case[0].map(f64::from);
        let back = found[0].map(f64::from);
        let what = || format!("{case:?} became {found:?}");
        assert_eq!(back[3], 1.0, "{}: it shines", what());
        // Codes are steps of 1/254 and 1/255, halved by rounding.
        assert!((back[0] - roughness.clamp(0.0, 1.0)).abs() <= 0.501 / 254.0, "{}: roughness", what());
        assert!((back[2] - part.clamp(0.0, 1.0)).abs() <= 0.501 / 255.0, "{}: part", what());
        let far = distance.clamp(0.0, 8.5e9);
        assert!((back[1] - far).abs() <= (far * 2.0_f64.powi(-11)).max(2.0_f64.powi(-30)), "{}: distance", what());
        let [shown, kept, dull, none] = found[1].map(f64::from);
        assert_eq!([shown, dull, none], [back[0], 0.0, 0.0], "{}: the guide's roughness", what());
        assert!((kept - depth).abs() < depth * 2.0_f64.powi(-15), "{}: depth", what());
        let [x, y, far, shown] = found[3].map(f64::from);
        let moved = unpack_reflection(pack_reflection([100.0 * roughness, 100.0 * distance, distance], 1));
        assert!((x - moved[0]).abs() <= 1.001 / 256.0 && (y - moved[1]).abs() <= 1.001 / 256.0, "{}: motion", what());
        // The last step, 2⁻³⁰, is the least number.
        let allowed = (distance * (2.0_f64.powi(-9) + 2.0_f64.powi(-11))).max(2.0_f64.powi(-30));
        assert!((far - distance.clamp(0.0, 8.5e9)).abs() <= allowed, "{}: distance of a reflection", what());
        assert_eq!(shown, back[0], "{}: roughness of a reflection", what());
        let evidence = found[4].map(f64::from);
        let t = f64::from(case[1][0]);
        let allowed = (t.abs() * (2.0_f64.powi(-10) + 2.0_f64.powi(-11))).max(2.0_f64.powi(-30));
        assert!((evidence[0] - t).abs() <= allowed, "{}: t", what());
        assert!(
            (evidence[1] - distance.clamp(0.0, 8.5e9)).abs() <= (distance * 2.0_f64.powi(-11)).max(2.0_f64.powi(-30))
        );
        assert_eq!(evidence[2..], [1.0, f64::from(u8::from(case[0][0] > 0.5))], "{}: evidence", what());
        let d = [case[1][0], case[1][1], case[1][2]].map(f64::from);
        let largest = d.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (&found, exact) in found[2].iter().zip(d) {
            if largest < 5.96e-8 {
                assert_eq!(found, 0.0, "{}: as good as none", what());
                continue;
            }
            let off = (f64::from(found) - exact.clamp(-256.0, 256.0)).abs() / largest;
            worst = worst.max(off * f64::from(u8::from(largest <= 256.0)));
            assert!(off <= 1.0001 / 255.0, "{}: displacement", what());
        }
    }
    println!("displacements are 1/{:.1} of the largest component off at worst", 1.0 / worst);
}
