//! The choice of each stratum's gradient sample.

use super::bench::{Bench, SIZES, Texel};
use super::codec::{depth, pack_motion, unpack_motion, unpack_normal, word};
use super::plane::{Pinhole, dot, sub};
use super::random::Random;
use crate::Settings;
use crate::passes::{Step, gradient_sample};
use crate::plan::{Feature, Features};

/// Texels of two words.
fn guides(guide: &[[u32; 2]]) -> Vec<Texel> {
    guide.iter().map(|g| [g[0], g[1], 0, 0]).collect()
}

/// The records of a static view, frame after frame.
fn choose(bench: &Bench, guide: &[[u32; 2]], before: &[Texel]) -> Vec<Texel> {
    let motion: Vec<[u32; 2]> = guide.iter().map(|g| pack_motion([0.0, 0.0, depth(*g)])).collect();
    let inputs = [
        ("guide", guides(guide)),
        ("guide_previous", guides(guide)),
        ("motion", guides(&motion)),
        ("samples_previous", before.to_vec()),
    ];
    bench
        .run(&Step::new(&gradient_sample::PASS, Features::default()), &inputs)
        .remove("samples_out")
        .unwrap_or_default()
}

#[test]
fn a_static_view_visits_all_nine_places_in_nine_frames_and_none_twice_in_a_row() {
    // The scene is a wall, so that every place of a stratum can be chosen.
    let mut bench = Bench::new([33, 17], Settings::adaptive());
    let wall: Vec<[u32; 2]> = bench.pixels().map(|_| [super::codec::pack_normal([0.0, 0.0, 1.0]), word(4.0)]).collect();
    (bench.camera.target, bench.camera.eye) = ([0.0; 3], [0.0, 0.0, 4.0]);
    bench.previous = bench.camera;
    let mut frames: Vec<Vec<Texel>> = vec![vec![[0; 4]; bench.strata().len()]];
    for index in 0..30 {
        bench.index = index;
        let records = choose(&bench, &wall, &frames[frames.len() - 1]);
        frames.push(records);
    }
    for (x, y) in bench.strata() {
        let i = bench.stratum(x, y).unwrap();
        let places: Vec<u32> = frames[1..].iter().map(|f| f[i][0]).collect();
        assert!(places.windows(2).all(|p| p[0] != p[1] || p[0] == 0), "({x}, {y}): {places:?}");
        // Strata at the border have fewer than nine pixels.
        let whole = bench.at(3 * x + 2, 3 * y + 2).is_some();
        for nine in places.windows(9).filter(|_| whole) {
            let mut seen = nine.to_vec();
            seen.sort_unstable();
            assert_eq!(seen, (1..=9).collect::<Vec<_>>(), "({x}, {y})");
        }
    }
}

#[test]
fn what_is_chosen_is_the_same_surface_and_was_no_sample_before() {
    let (mut chosen, mut strata) = (0, 0);
    for (size, objects) in SIZES.into_iter().flat_map(|s| [(s, false), (s, true)]) {
        let mut bench = Bench::new(size, Settings::adaptive());
        bench.previous.eye[0] += 0.04;
        let mut random = Random(21);
        let guide = bench.guide(&mut random);
        let was = Bench { camera: bench.previous, ..bench.clone() };
        let guide_before = was.guide(&mut Random(22));
        let before = bench.records(&guide, &mut random);
        let [object, object_before] =
            [0; 2].map(|_| guide.iter().map(|_| u32::from(random.unit() < 0.2)).collect::<Vec<_>>());
        let [jx, jy] = bench.camera.jitter.map(f64::from);
        let pinhole = Pinhole::new(&bench.previous, size);
        let motion: Vec<[f64; 3]> = bench
            .pixels()
            .map(|(x, y)| {
                let p = pinhole.project(bench.position(x, y, depth(guide[bench.at(x, y).unwrap()])));
                // Take the motion as the texture holds it.
                unpack_motion(pack_motion([p[0] - f64::from(x) - 0.5 - jx, p[1] - f64::from(y) - 0.5 - jy, p[2]]))
            })
            .collect();
        let mut inputs = vec![
            ("guide", guides(&guide)),
            ("guide_previous", guides(&guide_before)),
            ("motion", guides(&motion.iter().map(|&m| pack_motion(m)).collect::<Vec<_>>())),
            ("samples_previous", before.clone()),
        ];
        let mut features = Features::default();
        if objects {
            features = Features::of(&[Feature::Objects]);
            inputs.push(("object", object.iter().map(|&o| [o; 4]).collect()));
            inputs.push(("object_previous", object_before.iter().map(|&o| [o; 4]).collect()));
        }
        let records = bench.run(&Step::new(&gradient_sample::PASS, features), &inputs).remove("samples_out").unwrap();
        for (x, y) in bench.strata() {
            strata += 1;
            let record = records[bench.stratum(x, y).unwrap()];
            if record[0] == 0 {
                assert_eq!(record, [0; 4]);
                continue;
            }
            chosen += 1;
            let (px, py) = Bench::sample_pixel(record, x, y);
            let i = bench.at(px, py).expect("a sample lies inside the image");
            assert_eq!(record[2..], guide[i], "the record has the pixel's guide");
            let [qx, qy] = [record[1] & 0xffff, record[1] >> 16].map(|q| q as i32);
            // The previous pixel is the one that the motion leads to.
            for (q, at) in [(qx, f64::from(px) + motion[i][0]), (qy, f64::from(py) + motion[i][1])] {
                assert!((f64::from(q) - at).abs() <= 0.5 + 1e-4, "({x}, {y}): {q} for {at}");
            }
            let q = bench.at(qx, qy).expect("a previous pixel lies inside the image");
            let (z, normal) = (depth(guide_before[q]), unpack_normal(guide_before[q][0]));
            let origin = {
                let point = [f64::from(px) + 0.5 + jx + motion[i][0], f64::from(py) + 0.5 + jy + motion[i][1]];
                super::plane::add(pinhole.eye, super::plane::scale(pinhole.ray(point[0], point[1]), motion[i][2]))
            };
            let offset = sub(origin, was.position(qx, qy, z));
            assert!(z > 0.0 && dot(normal, offset).abs() <= 0.01001 * z && dot(offset, offset).sqrt() <= 0.05001 * z);
            assert!(dot(normal, unpack_normal(guide[i][0])) >= 0.8999);
            assert!(!objects || object[i] == object_before[q], "the same object");
            let previous = before[bench.stratum(qx / 3, qy / 3).unwrap()];
            let was_sample = previous[0] != 0 && Bench::sample_pixel(previous, qx / 3, qy / 3) == (qx, qy);
            assert!(!was_sample, "({x}, {y}): a pixel that repeated a path has none of its own to repeat");
        }
    }
    assert!(chosen * 3 > strata, "only {chosen} of {strata} strata have a sample");
}

#[test]
fn without_a_frame_before_there_is_none() {
    let mut bench = Bench::new([33, 17], Settings::adaptive());
    bench.continued = false;
    let guide = bench.guide(&mut Random(1));
    assert!(choose(&bench, &guide, &vec![[0; 4]; bench.strata().len()]).iter().all(|r| *r == [0; 4]));
}
