//! What a host is handed to repeat a path: which, and how far its surface has moved.

use super::bench::{Bench, SIZES, Texel};
use super::codec::{assert_close, depth, float, word};
use super::plane::{Pinhole, add, dot, scale, sub};
use super::random::Random;
use crate::Settings;
use crate::passes::reshade;
use crate::plan::Features;

#[test]
fn a_surface_is_shifted_by_what_it_moved_and_by_nothing_where_it_rests() {
    for size in SIZES {
        let mut bench = Bench::new(size, Settings::adaptive());
        bench.previous.eye[0] += 0.03;
        bench.previous.jitter = [-0.1, 0.4];
        let mut random = Random(61);
        let guide = bench.guide(&mut random);
        let guide_before = bench.guide(&mut Random(62));
        let records = bench.records(&guide, &mut random);
        let was = Pinhole::new(&bench.previous, size);
        let [jx, jy] = bench.camera.jitter.map(f64::from);
        // Every other column of pixels has moved.
        let shifts: Vec<_> = bench
            .pixels()
            .map(|(x, _)| if x % 2 == 0 { [0.0; 3] } else { scale(random.direction(), random.between(0.01, 0.3)) })
            .collect();
        let motion: Vec<Texel> = bench
            .pixels()
            .map(|(x, y)| {
                let i = bench.at(x, y).unwrap();
                let p = was.project(sub(bench.position(x, y, depth(guide[i])), shifts[i]));
                [word(p[0] - f64::from(x) - 0.5 - jx), word(p[1] - f64::from(y) - 0.5 - jy), word(p[2]), 0]
            })
            .collect();
        let inputs = [
            ("samples", records.clone()),
            ("guide_previous", guide_before.iter().map(|g| [g[0], g[1], 0, 0]).collect()),
            ("motion", motion.clone()),
        ];
        let written = bench.run(&reshade::step(Features::default()), &inputs);
        let [across, _] = size.map(|s| s.div_ceil(3) as usize);
        for (sx, sy) in bench.strata() {
            let record = records[bench.stratum(sx, sy).unwrap()];
            let first = sy as usize * 2 * across + 2 * sx as usize;
            let texels = &written["repeats_out"][first..first + 2];
            let what = || format!("{size:?} ({sx}, {sy})");
            if record[0] == 0 {
                assert_eq!(texels, [[0; 4]; 2], "{}", what());
                continue;
            }
            let q = bench.at((record[1] & 0xffff) as i32, (record[1] >> 16) as i32).unwrap();
            assert_eq!(texels[0], [record[0], record[1], guide_before[q][0], guide_before[q][1]], "{}", what());
            let (px, py) = Bench::sample_pixel(record, sx, sy);
            let i = bench.at(px, py).unwrap();
            if px % 2 == 0 {
                assert_eq!(texels[1], [0; 4], "{}: at rest", what());
                continue;
            }
            // The point before, from the motion as the texture holds it.
            let m = motion[i].map(float);
            let ray = was.ray(f64::from(px) + 0.5 + jx + m[0], f64::from(py) + 0.5 + jy + m[1]);
            let z = depth(guide[i]);
            let expected = sub(bench.position(px, py, z), add(was.eye, scale(ray, m[2])));
            assert!(dot(sub(expected, shifts[i]), sub(expected, shifts[i])).sqrt() < 1e-4 * z, "{}", what());
            for c in 0..3 {
                assert_close(float(texels[1][c]), expected[c], 2e-6 * (z + m[2]), what);
            }
        }
    }
}
