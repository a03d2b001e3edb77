//! Former places of reflections, against geometry in f64: mirrored points on flat mirrors, and the reflection equation on spheres.

use super::bench::{Bench, SIZES, Texel};
use super::codec::{
    assert_close, pack_motion, pack_normal, pack_unsigned, unpack_motion, unpack_reflection, unpack_unsigned, word,
};
use super::plane::{Pinhole, V, add, dot, scale, sub, unit};
use super::random::Random;
use crate::Settings;
use crate::passes::{Step, ingest_gloss, reflection};
use crate::plan::{Feature, Features};

/// A perfect mirror.
#[derive(Clone, Copy)]
enum Mirror {
    Flat { point: V, normal: V },
    Sphere { center: V, radius: f64 },
}

/// The direction in which a direction leaves a mirror of this normal.
pub(super) fn reflected(d: V, normal: V) -> V {
    sub(d, scale(normal, 2.0 * dot(d, normal)))
}

impl Mirror {
    /// The first point of a ray that is on the mirror, and the normal there.
    fn meet(self, eye: V, ray: V) -> Option<(V, V)> {
        match self {
            Self::Flat { point, normal } => {
                let t = dot(normal, sub(point, eye)) / dot(normal, ray);
                (t > 0.0).then(|| (add(eye, scale(ray, t)), normal))
            }
            Self::Sphere { center, radius } => {
                let d = unit(ray);
                let to_center = sub(center, eye);
                let along = dot(to_center, d);
                let squared = along * along - dot(to_center, to_center) + radius * radius;
                (squared > 0.0).then(|| {
                    let place = add(eye, scale(d, along - squared.sqrt()));
                    (place, unit(sub(place, center)))
                })
            }
        }
    }

    fn moved(self, by: V) -> Self {
        match self {
            Self::Flat { point, normal } => Self::Flat { point: add(point, by), normal },
            Self::Sphere { center, radius } => Self::Sphere { center: add(center, by), radius },
        }
    }

    /// A point on the line of sight along which an eye sees another point in the mirror.
    fn shows(self, eye: V, seen: V) -> V {
        match self {
            Self::Flat { point, normal } => sub(seen, scale(normal, 2.0 * dot(normal, sub(seen, point)))),
            Self::Sphere { center, radius } => {
                // The normal lies in the plane of both directions, between them: bisection over the blend of the two.
                let [to_eye, to_seen] = [eye, seen].map(|p| unit(sub(p, center)));
                let at = |t: f64| unit(add(scale(to_eye, 1.0 - t), scale(to_seen, t)));
                let (mut low, mut high) = (0.0, 1.0);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    let n = at(middle);
                    let place = add(center, scale(n, radius));
                    let cosine = |p: V| dot(unit(sub(p, place)), n);
                    // Both angles are the same where the eye sees the point; nearer to the eye's side, the eye's is smaller.
                    *if cosine(eye) > cosine(seen) { &mut low } else { &mut high } = middle;
                }
                add(center, scale(at(low), radius))
            }
        }
    }
}

/// A mirror, and what has changed since the last frame.
struct Case {
    bench: Bench,
    mirror: Mirror,
    /// Former place of the mirror less its place.
    displacement: V,
    /// The same of what is reflected.
    own: V,
    /// Distance from the mirror to what each pixel reflects.
    hit_distance: f64,
}

/// Code of a roughness: 1…255 for 0…1.
pub(super) fn gloss(roughness: f64, hit_distance: f64) -> u32 {
    (1.0 + (roughness * 254.0).round()) as u32 | pack_unsigned(hit_distance) << 8 | 255 << 24
}

/// The displacement's code, for displacements that it holds exactly: multiples of 1/255.
pub(super) fn displacement_code(d: V) -> u32 {
    let q = d.map(|x| (x * 255.0).round() as i32 as u32 & 0x1ff);
    if d == [0.0; 3] { 0 } else { q[0] | q[1] << 9 | q[2] << 18 | 23 << 27 }
}

pub(super) fn packed(words: [u32; 2]) -> Texel {
    [words[0], words[1], 0, 0]
}

impl Case {
    fn new(size: [u32; 2], mirror: Mirror, hit_distance: f64) -> Self {
        let bench = Bench::new(size, Settings::adaptive());
        Self { bench, mirror, displacement: [0.0; 3], own: [0.0; 3], hit_distance }
    }

    /// The same with a camera that has moved, and with other jitter in both frames.
    fn with_moved_camera(mut self) -> Self {
        self.bench.previous.eye = add(self.bench.camera.eye, [0.4, -0.2, 0.3]);
        (self.bench.camera.jitter, self.bench.previous.jitter) = ([0.4, -0.3], [-0.4, 0.2]);
        self
    }

    /// The G-buffer of a camera.
    fn guide(&self, bench: &Bench, mirror: Mirror) -> Vec<Texel> {
        let eye = bench.camera.eye;
        let forward = unit(sub(bench.camera.target, eye));
        let texel = |(x, y)| match mirror.meet(eye, bench.ray(x, y)) {
            Some((place, normal)) => packed([pack_normal(normal), word(dot(forward, sub(place, eye)))]),
            None => [0; 4],
        };
        bench.pixels().map(texel).collect()
    }

    /// Former place of the surface less its place, in pixels, and its former depth.
    fn surface_motion(&self, x: i32, y: i32) -> Option<V> {
        let [jx, jy] = self.bench.camera.jitter.map(f64::from);
        let (place, _) = self.mirror.meet(self.bench.camera.eye, self.bench.ray(x, y))?;
        let was = Pinhole::new(&self.bench.previous, self.bench.size).project(add(place, self.displacement));
        Some([was[0] - f64::from(x) - 0.5 - jx, was[1] - f64::from(y) - 0.5 - jy, was[2]])
    }

    /// Runs the pass. Returns the motion of the reflection with its distance, and that of the surface with its former depth.
    fn run(&self) -> Vec<(V, V)> {
        let bench = &self.bench;
        let step = Step::new(&reflection::PASS, Features::of(&[Feature::Instanced]));
        let was = Bench { camera: bench.previous, ..bench.clone() };
        let motion: Vec<_> =
            bench.pixels().map(|(x, y)| pack_motion(self.surface_motion(x, y).unwrap_or_default())).collect();
        let count = bench.pixels().count();
        let inputs = [
            ("guide", self.guide(bench, self.mirror)),
            ("guide_previous", self.guide(&was, self.mirror.moved(self.displacement))),
            ("motion", motion.iter().map(|&m| packed(m)).collect()),
            ("gloss", vec![[gloss(0.1, self.hit_distance), 0, 0, 0]; count]),
            ("specular_radiance", vec![[0, 0, word(self.hit_distance), displacement_code(self.own)]; count]),
        ];
        let out = bench.run(&step, &inputs);
        let reflections = out["reflection_out"].iter().map(|t| unpack_reflection([t[0], t[1]]));
        reflections.zip(motion.into_iter().map(unpack_motion)).collect()
    }

    /// The true motion of a pixel's reflection, and the cosine at which it is seen.
    fn expected(&self, x: i32, y: i32) -> Option<([f64; 2], f64)> {
        let bench = &self.bench;
        let [jx, jy] = bench.camera.jitter.map(f64::from);
        let d = unit(bench.ray(x, y));
        let (place, normal) = self.mirror.meet(bench.camera.eye, d)?;
        let seen = add(place, scale(reflected(d, normal), unpack_unsigned(pack_unsigned(self.hit_distance))));
        let before = self.mirror.moved(self.displacement);
        let shown = before.shows(bench.previous.eye, add(seen, self.own));
        let was = Pinhole::new(&bench.previous, bench.size).project(shown);
        Some(([was[0] - f64::from(x) - 0.5 - jx, was[1] - f64::from(y) - 0.5 - jy], -dot(d, normal)))
    }

    /// Compares all pixels that see the mirror at an angle of this cosine at least, and more than `border` pixels away from what is not
    /// the mirror, now and before. Returns the largest error, in pixels.
    fn check(&self, least_cosine: f64, border: i32, allowed: f64, what: &str) {
        let found = self.run();
        let sees = |camera, mirror: Mirror, x, y| {
            let bench = Bench { camera, ..self.bench.clone() };
            bench.at(x, y).is_some() && mirror.meet(camera.eye, bench.ray(x, y)).is_some()
        };
        let around = |camera, mirror, [x, y]: [i32; 2]| {
            (-border..=border).all(|dy| (-border..=border).all(|dx| sees(camera, mirror, x + dx, y + dy)))
        };
        let (mut worst, mut compared, mut slid) = (0.0_f64, 0, 0.0_f64);
        for (x, y) in self.bench.pixels() {
            let Some((expected, cosine)) = self.expected(x, y) else { continue };
            let was = [x + expected[0].round() as i32, y + expected[1].round() as i32];
            let inside = around(self.bench.camera, self.mirror, [x, y])
                && around(self.bench.previous, self.mirror.moved(self.displacement), was);
            if cosine < least_cosine || !inside {
                continue;
            }
            let (motion, surface) = found[self.bench.at(x, y).unwrap()];
            let off = (motion[0] - expected[0]).hypot(motion[1] - expected[1]);
            assert!(off <= allowed, "{what}, ({x}, {y}): {motion:?}, not {expected:?}; the surface's is {surface:?}");
            worst = worst.max(off);
            slid = slid.max((surface[0] - expected[0]).hypot(surface[1] - expected[1]));
            compared += 1;
        }
        println!(
            "{what}: {worst:.3} pixels off at worst in {compared} pixels; surface and reflection are up to {slid:.1} apart"
        );
        assert!(compared > 200 && slid > 2.0 * allowed, "{what}: {compared} pixels, up to {slid} apart");
    }
}

/// A mirror that faces the camera at an angle.
const FLAT: Mirror = Mirror::Flat { point: [0.1, 0.0, 0.0], normal: [0.6, 0.0, 0.8] };
const BALL: Mirror = Mirror::Sphere { center: [0.1, 0.0, 0.0], radius: 1.2 };
const SIZE: [u32; 2] = [64, 48];

/// Two roundings to 1/256 of a pixel, and a distance of 11 bits.
const ROUNDED: f64 = 0.01;

#[test]
fn a_flat_mirror_shows_what_is_behind_it() {
    for hit_distance in [0.3, 2.0, 50.0, 8e9] {
        let case = Case::new(SIZE, FLAT, hit_distance).with_moved_camera();
        case.check(0.0, 0, ROUNDED, &format!("flat, {hit_distance} away"));
    }
}

/// Translations along the mirror move no reflection, and those across move it twice as far as the mirror.
#[test]
fn a_flat_mirror_that_moves() {
    for displacement in [[0.16, 0.0, -0.12], [0.06, 0.0, 0.08], [0.05, 0.1, 0.02]] {
        let case = Case { displacement, ..Case::new(SIZE, FLAT, 1.5) };
        // Normals are 0.06° off.
        case.check(0.0, 0, 2.0 * ROUNDED, &format!("flat, moved by {displacement:?}"));
        let case = Case { displacement, ..Case::new(SIZE, FLAT, 1.5).with_moved_camera() };
        case.check(0.0, 0, 2.0 * ROUNDED, &format!("flat, moved by {displacement:?}, and the camera too"));
    }
}

#[test]
fn what_is_reflected_moves() {
    let own = [20.0 / 255.0, -10.0 / 255.0, 25.0 / 255.0];
    let case = Case { own, ..Case::new(SIZE, FLAT, 1.5) };
    case.check(0.0, 0, 2.0 * ROUNDED, "flat, and what it shows moves");
    let case = Case { own, displacement: [0.05, 0.1, 0.02], ..Case::new(SIZE, FLAT, 1.5).with_moved_camera() };
    case.check(0.0, 0, 2.0 * ROUNDED, "flat, and all moves");
}

#[test]
fn a_ball_shows_a_place_by_its_normals() {
    for (size, hit_distance) in [(SIZE, 0.5), (SIZE, 3.0), (SIZE, 100.0), ([160, 120], 3.0)] {
        let what = format!("ball, {hit_distance} away, {size:?}");
        let case = Case::new(size, BALL, hit_distance).with_moved_camera();
        case.check(0.3, 2, 0.25, &what);
        let case =
            Case { displacement: [0.08, 0.03, -0.05], ..Case::new(size, BALL, hit_distance).with_moved_camera() };
        case.check(0.3, 2, 0.25, &format!("moved {what}"));
    }
}

/// Codes of gloss: none, and every kind of distance, the largest and the smallest ones included.
fn any_gloss(random: &mut Random) -> u32 {
    let distance = [0, 1, 0xffff, 0xfbff, 0x8000, random.below(0x10000) as u32][random.below(6)];
    match random.below(4) {
        0 => 0,
        _ => (1 + random.below(255) as u32) | (distance << 8) | ((random.below(256) as u32) << 24),
    }
}

#[test]
fn where_nothing_has_moved_reflections_rest() {
    for mirror in [FLAT, BALL] {
        for distances in [true, false] {
            let case = Case::new(SIZE, mirror, 1.0);
            let bench = &case.bench;
            let step = Step::new(&reflection::PASS, Features::default());
            let guide = case.guide(bench, mirror);
            let motion: Vec<Texel> = bench
                .pixels()
                .map(|(x, y)| {
                    let depth = case.surface_motion(x, y).unwrap_or_default()[2];
                    packed(pack_motion([0.0, 0.0, depth]))
                })
                .collect();
            let mut random = Random(8);
            let gloss: Vec<Texel> = guide
                .iter()
                .map(|_| [if distances { any_gloss(&mut random) } else { gloss(0.2, 0.7) }, 0, 0, 0])
                .collect();
            let inputs = [
                ("guide", guide.clone()),
                ("guide_previous", guide.clone()),
                ("motion", motion.clone()),
                ("gloss", gloss.clone()),
            ];
            let out = bench.run(&step, &inputs);
            for (i, texel) in out["reflection_out"].iter().enumerate() {
                if guide[i][1] == 0 || gloss[i][0] & 255 == 0 {
                    assert_eq!(*texel, [0; 4], "pixel {i}: nothing shines");
                    continue;
                }
                assert_eq!(texel[1] >> 10 & 255, gloss[i][0] & 255, "pixel {i}: the roughness");
                assert_eq!(unpack_reflection([texel[0], texel[1]])[..2], [0.0; 2], "pixel {i}");
            }
        }
    }
}

/// Any G-buffer, gloss and motion, and a host's motions of reflections that are no numbers.
#[test]
fn no_input_gives_a_number_that_is_not_finite() {
    for features in [&[Feature::ReflectionMotion, Feature::Objects][..], &[], &[Feature::Instanced], &[Feature::Still]]
    {
        let step = Step::new(&reflection::PASS, Features::of(features));
        let has = |name: &str| step.bindings.iter().any(|bound| bound.name == name);
        for size in SIZES {
            let mut bench = Bench::new(size, Settings::adaptive());
            bench.previous.eye = [0.5, 0.2, 3.0];
            let mut random = Random(4);
            let guide: Vec<Texel> = bench.guide(&mut random).into_iter().map(packed).collect();
            let before: Vec<Texel> = bench.guide(&mut Random(5)).into_iter().map(packed).collect();
            let mut each = |f: &mut dyn FnMut(&mut Random) -> Texel| -> Vec<Texel> {
                guide.iter().map(|_| f(&mut random)).collect()
            };
            let numbers = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30, 0.0, 0.7].map(f32::to_bits);
            let gloss = each(&mut |r| [any_gloss(r), r.below(2) as u32, 0, 0]);
            let given = each(&mut |r| [numbers[r.below(7)], numbers[r.below(7)], 0, 0]);
            let motion = each(&mut |r| packed(pack_motion([r.between(-9.0, 9.0), [0.0, -1e9][r.below(2)], 2.0])));
            let all = [
                ("guide", guide.clone()),
                ("guide_previous", before),
                ("gloss", gloss.clone()),
                ("motion", motion.clone()),
                ("specular_radiance", each(&mut |r| [0, 0, 0, r.below(1 << 32) as u32])),
                ("object_previous", each(&mut |r| [r.below(2) as u32, 0, 0, 0])),
                ("reflection_motion", given.clone()),
            ];
            let inputs: Vec<_> = all.into_iter().filter(|(name, _)| has(name)).collect();
            let out = bench.run(&step, &inputs);
            for (i, texel) in out["reflection_out"].iter().enumerate() {
                let what = || format!("{features:?}, {size:?}, pixel {i}: {texel:08x?}, gloss {:08x}", gloss[i][0]);
                let code = gloss[i][0] & 255;
                let shines = guide[i][1] != 0 && code != 0;
                if !shines {
                    assert_eq!(*texel, [0; 4], "{}: nothing shines", what());
                    continue;
                }
                assert_eq!(texel[1] >> 10 & 255, code, "{}: the roughness", what());
                let shift = unpack_reflection([texel[0], texel[1]]);
                let surface = unpack_motion([motion[i][0], motion[i][1]]);
                assert!(shift.into_iter().all(f64::is_finite) && shift[2] > 0.0, "{}", what());
                let told = given[i].map(f32::from_bits);
                // A surface that was nowhere shows no former reflection.
                if has("reflection_motion") && told[..2] == [0.7; 2] && surface[0] > -1e5 {
                    assert_eq!(shift[..2], [179.0 / 256.0; 2], "{}: the host's own motion", what());
                }
            }
        }
    }
}

/// The distance of what is reflected where no path tells: half the depth.
#[test]
fn an_unknown_distance_is_half_the_depth() {
    let case = Case::new(SIZE, FLAT, 0.0);
    for ((x, y), (motion, surface)) in case.bench.pixels().zip(case.run()) {
        if case.surface_motion(x, y).is_some() {
            // The distance is rounded to 10 bits of mantissa and then to 8.
            assert_close(
                motion[2],
                0.5 * surface[2],
                0.5 * surface[2] * (2.0_f64.powi(-9) + 2.0_f64.powi(-11)),
                || format!("({x}, {y})"),
            );
        }
    }
}

/// Numbers of a host's view, good and bad ones.
fn numbers(random: &mut Random, count: usize) -> Vec<f32> {
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, -0.0, 0.0, 1e-30, 3e38];
    (0..count).map(|_| if random.below(2) == 0 { bad[random.below(8)] } else { random.unit() as f32 }).collect()
}

fn check_ingest(features: &[Feature]) {
    let features = Features::of(features);
    let has = |feature| features.has(feature);
    let step = Step::new(&ingest_gloss::PASS, features);
    for size in SIZES {
        let bench = Bench::new(size, Settings::adaptive());
        let mut random = Random(21);
        let guide: Vec<Texel> = bench.guide(&mut random).into_iter().map(packed).collect();
        let [roughness, distance, reflectance, albedo] = [0; 4].map(|_| numbers(&mut random, guide.len()));
        // Some reflectances are bad in one channel alone.
        let broken: Vec<bool> = guide.iter().map(|_| random.below(6) == 0).collect();
        let gray = |x: f32| [x.to_bits(), x.to_bits(), x.to_bits(), 0];
        let partly = |x: f32| [x.to_bits(), f32::NAN.to_bits(), x.to_bits(), 0];
        let all =
            [
                ("guide", guide.clone()),
                (
                    "roughness",
                    roughness
                        .iter()
                        .map(|r| {
                            if has(Feature::RoughnessInAlpha) { [0, 0, 0, r.to_bits()] } else { [r.to_bits(), 0, 0, 0] }
                        })
                        .collect(),
                ),
                ("hit_distance", distance.iter().map(|h| [h.to_bits(), 0, 0, 0]).collect()),
                (
                    "reflectance",
                    reflectance.iter().zip(&broken).map(|(&x, &b)| if b { partly(x) } else { gray(x) }).collect(),
                ),
                ("albedo", albedo.iter().map(|&x| gray(x)).collect()),
            ];
        let inputs: Vec<(&str, Vec<Texel>)> =
            all.into_iter().filter(|(name, _)| step.bindings.iter().any(|bound| bound.name == *name)).collect();
        let out = bench.run(&step, &inputs);
        // Greater numbers count as 10¹⁵, and those that are no number as 0.
        let light = |x: f32| if x.is_finite() { f64::from(x).clamp(0.0, 1e15) } else { 0.0 };
        for (i, texel) in out["gloss_out"].iter().enumerate() {
            let given = [roughness[i], distance[i], reflectance[i], albedo[i]];
            let what = || format!("{features:?}, {size:?}, pixel {i}: {given:?}");
            let shines = !has(Feature::Reflectance) || !broken[i] && light(reflectance[i]) > 0.0;
            if guide[i][1] == 0 || !shines {
                assert_eq!(texel[0], 0, "{}: nothing shines", what());
                continue;
            }
            let expected = match roughness[i] {
                r if has(Feature::Roughness) && r.is_finite() => f64::from(r).clamp(0.0, 1.0),
                _ => 0.35,
            };
            let code = texel[0] & 255;
            assert!(code > 0, "{}: it shines", what());
            assert_close(f64::from(code - 1) / 254.0, expected, 0.51 / 254.0, || format!("{}: roughness", what()));
            let expected = match distance[i] {
                h if !has(Feature::HitDistance) || h.is_nan() || h <= 0.0 => 0.0,
                h => f64::from(h).min(8e9),
            };
            let found = unpack_unsigned(texel[0] >> 8 & 0xffff);
            let step = if expected < 2.0_f64.powi(-30) { 2.0_f64.powi(-30) } else { expected * 2.0_f64.powi(-11) };
            assert_close(found, expected, step, || format!("{}: distance", what()));
            let part = match light(reflectance[i]) {
                _ if !has(Feature::MixedGloss) => 1.0,
                _ if !has(Feature::Reflectance) => 0.5,
                s if has(Feature::Albedo) => s / (s + light(albedo[i])).max(1e-6),
                s => s.min(1.0),
            };
            assert_close(f64::from(texel[0] >> 24) / 255.0, part, 0.51 / 255.0, || format!("{}: part", what()));
        }
    }
}

#[test]
fn gloss_of_every_host() {
    use Feature::*;
    check_ingest(&[]);
    check_ingest(&[Roughness, HitDistance, Reflectance]);
    check_ingest(&[Roughness, RoughnessInAlpha, MixedGloss]);
    check_ingest(&[Reflectance, MixedGloss, Albedo, HitDistance]);
    check_ingest(&[Reflectance, MixedGloss]);
}
