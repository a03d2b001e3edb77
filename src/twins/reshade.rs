//! The data that a host needs to repeat a path: the path, and the displacement of its surface.

use super::bench::{Bench, SIZES, Texel};
use super::codec::{assert_close, depth, float, unpack_normal, word};
use super::plane::{Pinhole, V, add, dot, length, scale, sub};
use super::random::Random;
use crate::Settings;
use crate::passes::{Step, reshade};
use crate::plan::{Feature, Features};

/// Kinds of motion of the pixels, column by column.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Rests,
    /// The point rests, and the host's numbers are in f16.
    RestsRounded,
    Moves,
}

fn kind(x: i32) -> Kind {
    [Kind::Rests, Kind::RestsRounded, Kind::Moves][x as usize % 3]
}

/// The nearest number with f16's mantissa.
fn round_to_f16(x: f64) -> f64 {
    let step = (x.abs().log2().floor() - 10.0).exp2();
    if x == 0.0 { 0.0 } else { (x / step).round() * step }
}

/// The motion of a pixel's point: its former image point less the pixel's, and its former depth.
fn motion(bench: &Bench, x: i32, y: i32, z: f64, shift: V) -> V {
    let [jx, jy] = bench.camera.jitter.map(f64::from);
    let p = Pinhole::new(&bench.previous, bench.size).project(sub(bench.position(x, y, z), shift));
    [p[0] - f64::from(x) - 0.5 - jx, p[1] - f64::from(y) - 0.5 - jy, p[2]]
}

#[test]
fn a_surface_is_shifted_by_what_it_moved_and_by_nothing_where_it_rests() {
    check(Features::default());
    check(Features::of(&[Feature::PreviousDepth]));
}

fn check(features: Features) {
    let mut rounded = 0;
    for size in SIZES {
        let mut bench = Bench::new(size, Settings::adaptive());
        bench.previous.eye[0] += 0.03;
        bench.previous.jitter = [-0.1, 0.4];
        let was = Bench { camera: bench.previous, ..bench.clone() };
        let mut random = Random(61);
        let guide = bench.guide(&mut random);
        let guide_before = was.guide(&mut Random(62));
        let mut records = bench.records(&guide, &mut random);
        for (s, (x, y)) in bench.strata().into_iter().enumerate() {
            // Half of the paths were in the same pixel before.
            if records[s][0] != 0 && random.unit() < 0.5 {
                let (px, py) = Bench::sample_pixel(records[s], x, y);
                records[s][1] = px as u32 | (py as u32) << 16;
            }
        }
        let motions: Vec<V> = bench
            .pixels()
            .map(|(x, y)| {
                let z = depth(guide[bench.at(x, y).unwrap()]);
                let moves = scale(random.direction(), random.between(0.02, 0.3));
                match kind(x) {
                    Kind::Rests => motion(&bench, x, y, z, [0.0; 3]),
                    Kind::RestsRounded => motion(&bench, x, y, z, [0.0; 3]).map(round_to_f16),
                    Kind::Moves => motion(&bench, x, y, z, moves),
                }
                .map(|m| float(word(m)))
            })
            .collect();
        let knows_depth = features.has(Feature::PreviousDepth);
        let mut inputs = vec![
            ("samples", records.clone()),
            ("guide_previous", guide_before.iter().map(|g| [g[0], g[1], 0, 0]).collect()),
            ("motion", motions.iter().map(|m| [word(m[0]), word(m[1]), 0, 0]).collect::<Vec<Texel>>()),
        ];
        if knows_depth {
            inputs.push(("previous_depth", motions.iter().map(|m| [word(m[2]), 0, 0, 0]).collect()));
        }
        let written = bench.run(&Step::new(&reshade::PASS, features), &inputs);
        for (sx, sy) in bench.strata() {
            let s = bench.stratum(sx, sy).unwrap();
            let record = records[s];
            let [which, shift] = ["repeats_out", "shifts_out"].map(|name| written[name][s]);
            let what = || format!("{size:?} ({sx}, {sy})");
            if record[0] == 0 {
                assert_eq!([which, shift], [[0; 4]; 2], "{}", what());
                continue;
            }
            let [qx, qy] = [record[1] & 0xffff, record[1] >> 16].map(|q| q as i32);
            let q = guide_before[bench.at(qx, qy).unwrap()];
            assert_eq!(which, [record[0], record[1], q[0], q[1]], "{}", what());
            let (px, py) = Bench::sample_pixel(record, sx, sy);
            let i = bench.at(px, py).unwrap();
            let z = depth(guide[i]);
            let now = bench.position(px, py, z);
            // True if a point that 16 bits have moved a little is still on the surface.
            let off = dot(unpack_normal(guide[i][0]), sub(now, was.position(qx, qy, depth(q)))).abs();
            match kind(px) {
                Kind::Rests => {
                    assert_eq!(shift, [0; 4], "{}: at rest", what());
                    continue;
                }
                Kind::RestsRounded if off < 0.9e-4 * z => {
                    rounded += 1;
                    assert_eq!(shift, [0; 4], "{}: at rest, with 16 bits", what());
                    continue;
                }
                Kind::RestsRounded if off < 1.1e-4 * z => continue,
                _ => {}
            }
            let [jx, jy] = bench.camera.jitter.map(f64::from);
            let mut m = motions[i];
            if !knows_depth {
                // The depth that a point at rest had.
                m[2] = was.pinhole().project(now)[2];
            }
            let ray = was.pinhole().ray(f64::from(px) + 0.5 + jx + m[0], f64::from(py) + 0.5 + jy + m[1]);
            let expected = sub(now, add(was.pinhole().eye, scale(ray, m[2])));
            // A move that comes from rounding to 16 bits may be indistinguishable from none.
            let least = length(expected) < 1.5e-5 * z;
            for c in 0..3 {
                let found = float(shift[c]);
                if !(least && found == 0.0) {
                    assert_close(found, expected[c], 2e-6 * (z + m[2]), what);
                }
            }
        }
    }
    assert!(rounded > 3, "only {rounded}");
}
