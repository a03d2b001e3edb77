//! A host's surfaces: those that are kept, those that count as a miss, and the former place of a point.

use super::bench::{Bench, SIZES, Texel};
use super::codec::{assert_close, depth, unpack_motion, unpack_normal, word};
use super::plane::{Pinhole, V, dot, scale, unit};
use super::random::Random;
use crate::Settings;
use crate::passes::{Step, ingest_surface};
use crate::plan::{Feature, Features};

/// A point of the unfolded octahedron, −1…1 (Meyer et al. 2010).
fn octahedral(n: V) -> [f64; 2] {
    let n = scale(n, 1.0 / (n[0].abs() + n[1].abs() + n[2].abs()));
    let sign = |x: f64| if x >= 0.0 { 1.0 } else { -1.0 };
    if n[2] >= 0.0 { [n[0], n[1]] } else { [(1.0 - n[1].abs()) * sign(n[0]), (1.0 - n[0].abs()) * sign(n[1])] }
}

/// A normal in the host's encoding.
fn encode(n: V, features: Features) -> Texel {
    if features.has(Feature::PackedNormals) {
        let [x, y] = octahedral(n).map(|e| ((e * 0.5 + 0.5) * 65535.0).round() as u32);
        return [x | y << 16, 0, 0, 0];
    }
    let mut v = [n[0], n[1], n[2]];
    if features.has(Feature::OctahedralNormals) {
        let [x, y] = octahedral(n);
        v = [x, y, 0.0];
    }
    if features.has(Feature::MappedNormals) {
        v = v.map(|x| 0.5 * x + 0.5);
    }
    [word(v[0]), word(v[1]), word(v[2]), 0]
}

/// Numbers that no surface has.
const BROKEN: [f32; 2] = [f32::NAN, f32::NEG_INFINITY];

fn check(features: &[Feature]) {
    let features = Features::of(features);
    let step = Step::new(&ingest_surface::PASS, features);
    for size in SIZES {
        let mut bench = Bench::new(size, Settings::adaptive());
        bench.previous.eye[0] += 0.1;
        bench.previous.eye[2] += 0.2;
        let mut random = Random(31);
        let count = (size[0] * size[1]) as usize;
        let broken = |random: &mut Random, value: f64, other: &[f64]| match random.below(8) {
            0 => f64::from(BROKEN[random.below(2)]),
            1 => other[random.below(other.len())],
            _ => value,
        };
        let depths: Vec<f64> = (0..count)
            .map(|_| {
                let z = random.between(0.5, 9.0);
                f64::from(broken(&mut random, z, &[0.0, -1.0, f64::INFINITY]) as f32)
            })
            .collect();
        let normals: Vec<V> = (0..count).map(|_| random.direction()).collect();
        // In formats with three channels a normal may be missing, broken, or of any length.
        let three = !features.has(Feature::OctahedralNormals) && !features.has(Feature::PackedNormals);
        let kinds: Vec<usize> = (0..count).map(|_| random.below(10)).collect();
        let none = if features.has(Feature::MappedNormals) { word(0.5) } else { 0 };
        let normal_texels: Vec<Texel> = (0..count)
            .map(|i| match kinds[i] {
                0 if three => [none, none, none, 0],
                1 if three => [f32::NAN.to_bits(), 0, 0, 0],
                2 if three && !features.has(Feature::MappedNormals) => encode(scale(normals[i], 3.0), features),
                _ => encode(normals[i], features),
            })
            .collect();
        let motions: Vec<[f64; 2]> = (0..count)
            .map(|_| {
                let x = random.between(-5.0, 5.0);
                [f64::from(broken(&mut random, x, &[0.0]) as f32), f64::from(random.between(-5.0, 5.0) as f32)]
            })
            .collect();
        let before: Vec<f64> = (0..count)
            .map(|_| {
                let z = random.between(0.5, 9.0);
                f64::from(broken(&mut random, z, &[0.0, -2.0]) as f32)
            })
            .collect();
        let objects: Vec<u32> = (0..count).map(|_| random.below(7) as u32).collect();
        let mut inputs = vec![
            ("depth", depths.iter().map(|&z| [word(z), 0, 0, 0]).collect::<Vec<Texel>>()),
            ("normal", normal_texels),
            ("motion", motions.iter().map(|m| [word(m[0]), word(m[1]), 0, 0]).collect()),
        ];
        if features.has(Feature::PreviousDepth) {
            inputs.push(("previous_depth", before.iter().map(|&z| [word(z), 0, 0, 0]).collect()));
        }
        if features.has(Feature::Objects) {
            let number = |o: u32| if features.has(Feature::FloatObjects) { word(f64::from(o)) } else { o };
            inputs.push(("instance", objects.iter().map(|&o| [number(o), 0, 0, 0]).collect()));
        }
        let written = bench.run(&step, &inputs);
        let was = Pinhole::new(&bench.previous, size);
        for (x, y) in bench.pixels() {
            let i = bench.at(x, y).unwrap();
            let what = || format!("{size:?} ({x}, {y}), {features:?}");
            let guide = [written["guide_out"][i][0], written["guide_out"][i][1]];
            let motion = [written["motion_out"][i][0], written["motion_out"][i][1]];
            if features.has(Feature::Objects) {
                // Objects are told apart exactly where the host tells them apart.
                for j in 0..i {
                    let same = written["object_out"][i] == written["object_out"][j];
                    assert_eq!(same, objects[i] == objects[j], "{}", what());
                }
            }
            let z = depths[i];
            if !(z > 0.0 && z.is_finite()) || (three && kinds[i] <= 1) {
                assert_eq!((guide, motion), ([0; 2], [0; 2]), "{}: nothing was hit", what());
                continue;
            }
            assert_eq!(depth(guide), z, "{}", what());
            let found = unit(unpack_normal(guide[0]));
            assert!(dot(found, normals[i]) > 0.99999, "{}: {found:?}, not {:?}", what(), normals[i]);
            let previous =
                if features.has(Feature::PreviousDepth) { before[i] } else { was.project(bench.position(x, y, z))[2] };
            let motion = unpack_motion(motion);
            if !(motions[i][0].is_finite() && previous.is_finite() && previous > 0.0) {
                assert!(motion[0] < -1e5, "{}: the point was nowhere", what());
                continue;
            }
            for (found, expected) in motion.into_iter().zip(motions[i]) {
                assert_close(found, expected, 1.0 / 512.0, || format!("{}: motion", what()));
            }
            // The depth is rounded to 14 bits of mantissa, and is a sum of some ten terms in f32.
            assert_close(motion[2], previous, 3.3e-5 * previous, || format!("{}: depth before", what()));
        }
    }
}

#[test]
fn every_kind_of_surface() {
    use Feature::*;
    check(&[]);
    check(&[MappedNormals, PreviousDepth]);
    check(&[OctahedralNormals, Objects]);
    check(&[OctahedralNormals, MappedNormals, Objects, FloatObjects]);
    check(&[PackedNormals, PreviousDepth, Objects]);
}
