//! Motions of reflections against Fermat's principle: a mirror shows a point where the path from the point to the eye is stationary,
//!
//!   ∂/∂Y (|P − Y| + |Y − o|) = 0    for Y on the mirror
//!
//! solved by Newton's method along the way from this frame to the last one. (An orthographic view has −Y·f instead of |Y − o|, where f is
//! the direction against the view.)

use super::bench::{Bench, Texel, axes};
use super::codec::{pack_motion, pack_normal, pack_unsigned, unpack_motion, unpack_reflection, unpack_unsigned, word};
use super::plane::{Pinhole, V, add, cross, dot, length, scale, sub, unit};
use super::reflection::{displacement_code, gloss, packed, reflected};
use crate::passes::{Step, reflection};
use crate::plan::{Feature, Features};
use crate::{Camera, Settings};

/// A mirror.
#[derive(Clone, Copy, Debug)]
enum Mirror {
    Plane {
        point: V,
        normal: V,
    },
    /// A ball's outside, or the inside of a hollow one.
    Sphere {
        center: V,
        radius: f64,
        inside: bool,
    },
    /// The inside of a box about the origin with this half size.
    Room {
        half: V,
    },
}

/// Rotates a vector about a unit axis (Rodrigues).
fn turned(v: V, axis: V, angle: f64) -> V {
    let (s, c) = angle.sin_cos();
    add(add(scale(v, c), scale(cross(axis, v), s)), scale(axis, dot(axis, v) * (1.0 - c)))
}

/// The way of a rigid body from this frame's place to the last one's.
#[derive(Clone, Copy, Debug)]
struct Way {
    pivot: V,
    axis: V,
    angle: f64,
    shift: V,
}

const REST: Way = Way { pivot: [0.0; 3], axis: [0.0, 1.0, 0.0], angle: 0.0, shift: [0.0; 3] };

impl Way {
    /// The place of a body's point after a part of the way.
    fn place(self, x: V, part: f64) -> V {
        let about = turned(sub(x, self.pivot), self.axis, part * self.angle);
        add(add(self.pivot, about), scale(self.shift, part))
    }
}

impl Mirror {
    fn moved(self, way: Way, part: f64) -> Self {
        match self {
            Self::Plane { point, normal } => {
                Self::Plane { point: way.place(point, part), normal: turned(normal, way.axis, part * way.angle) }
            }
            Self::Sphere { center, radius, inside } => Self::Sphere { center: way.place(center, part), radius, inside },
            Self::Room { .. } => self,
        }
    }

    /// The point that a ray meets, and the normal there.
    fn meet(self, from: V, ray: V) -> Option<(V, V)> {
        let d = unit(ray);
        match self {
            Self::Plane { point, normal } => {
                let t = dot(normal, sub(point, from)) / dot(normal, d);
                (t > 0.0 && dot(normal, d) < 0.0).then(|| (add(from, scale(d, t)), normal))
            }
            Self::Sphere { center, radius, inside } => {
                let to = sub(center, from);
                let along = dot(to, d);
                let root = (along * along - dot(to, to) + radius * radius).max(0.0).sqrt();
                let t = if inside { along + root } else { along - root };
                let place = add(from, scale(d, t));
                (root > 0.0 && t > 0.0).then(|| (place, self.normal(place)))
            }
            Self::Room { half } => {
                let wall = |i: usize| {
                    let t = (half[i].copysign(d[i]) - from[i]) / d[i];
                    (if d[i] == 0.0 { f64::INFINITY } else { t }, i)
                };
                let (t, _) = [0, 1, 2].map(wall).into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
                let place = add(from, scale(d, t));
                Some((place, self.normal(place)))
            }
        }
    }

    fn normal(self, place: V) -> V {
        match self {
            Self::Plane { normal, .. } => normal,
            Self::Sphere { center, inside, .. } => unit(scale(sub(place, center), if inside { -1.0 } else { 1.0 })),
            Self::Room { half } => {
                let nearest = |&i: &usize| half[i] - place[i].abs();
                let i = (0..3).min_by(|a, b| nearest(a).total_cmp(&nearest(b))).unwrap();
                let mut normal = [0.0; 3];
                normal[i] = -place[i].signum();
                normal
            }
        }
    }

    /// The mirror's point nearest to a point beside it.
    fn nearest(self, place: V) -> V {
        match self {
            Self::Plane { point, normal } => sub(place, scale(normal, dot(normal, sub(place, point)))),
            Self::Sphere { center, radius, .. } => add(center, scale(unit(sub(place, center)), radius)),
            Self::Room { half } => {
                let n = self.normal(place);
                let i = (0..3).find(|&i| n[i] != 0.0).unwrap();
                let mut on = place;
                on[i] = -n[i] * half[i];
                on
            }
        }
    }
}

/// A camera that is a pinhole or orthographic.
struct Eye {
    camera: Camera,
    size: [u32; 2],
    half_height: Option<f64>,
}

impl Eye {
    fn of(bench: &Bench, camera: Camera) -> Self {
        Self { camera, size: bench.size, half_height: bench.half_height }
    }

    /// Origin and direction of the ray through a pixel's centre and the jitter.
    fn ray(&self, x: i32, y: i32) -> (V, V) {
        let [px, py] = [(x, 0), (y, 1)].map(|(p, i)| f64::from(p) + 0.5 + f64::from(self.camera.jitter[i]));
        let [right, up, back] = axes(&self.camera);
        let Some(half) = self.half_height else {
            return (self.camera.eye, Pinhole::new(&self.camera, self.size).ray(px, py));
        };
        let [w, h] = self.size.map(f64::from);
        let across = (2.0 * px - w) / h * half;
        let above = (h - 2.0 * py) / h * half;
        (add(self.camera.eye, add(scale(right, across), scale(up, above))), scale(back, -1.0))
    }

    /// Image point in pixels, and depth.
    fn project(&self, p: V) -> V {
        let Some(half) = self.half_height else { return Pinhole::new(&self.camera, self.size).project(p) };
        let [right, up, back] = axes(&self.camera);
        let offset = sub(p, self.camera.eye);
        let [w, h] = self.size.map(f64::from);
        [(dot(offset, right) / half * h + w) / 2.0, (1.0 - dot(offset, up) / half) * h / 2.0, -dot(offset, back)]
    }

    /// Length of the way of light from a point, but for a constant.
    fn way_from(&self, p: V) -> f64 {
        let [.., back] = axes(&self.camera);
        if self.half_height.is_some() { -dot(p, back) } else { length(sub(self.camera.eye, p)) }
    }

    fn to_eye(&self, p: V) -> V {
        let [.., back] = axes(&self.camera);
        if self.half_height.is_some() { back } else { unit(sub(self.camera.eye, p)) }
    }

    /// A camera between two.
    fn between(a: &Camera, b: &Camera, part: f64) -> Camera {
        let mix = |p: V, q: V| add(scale(p, 1.0 - part), scale(q, part));
        Camera { eye: mix(a.eye, b.eye), target: mix(a.target, b.target), ..*a }
    }
}

/// The place near a first guess at which a mirror shows a point; `None` if there is none.
fn stationary(mirror: Mirror, eye: &Eye, seen: V, mut place: V) -> Option<V> {
    for _ in 0..30 {
        let n = mirror.normal(place);
        let a = unit(cross(n, if n[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] }));
        let b = cross(n, a);
        let at = |u: f64, v: f64| mirror.nearest(add(place, add(scale(a, u), scale(b, v))));
        let way = |u: f64, v: f64| {
            let y = at(u, v);
            length(sub(seen, y)) + eye.way_from(y)
        };
        let h = 1e-3;
        let [p, q] = [(way(h, 0.0) - way(-h, 0.0)) / (2.0 * h), (way(0.0, h) - way(0.0, -h)) / (2.0 * h)];
        let middle = way(0.0, 0.0);
        let uu = (way(h, 0.0) + way(-h, 0.0) - 2.0 * middle) / (h * h);
        let vv = (way(0.0, h) + way(0.0, -h) - 2.0 * middle) / (h * h);
        let uv = (way(h, h) + way(-h, -h) - way(h, -h) - way(-h, h)) / (4.0 * h * h);
        let determinant = uu * vv - uv * uv;
        let step = [-(vv * p - uv * q) / determinant, -(uu * q - uv * p) / determinant];
        let long = step[0].hypot(step[1]);
        if !long.is_finite() {
            return None;
        }
        let short = (0.1 / long).min(1.0);
        place = at(short * step[0], short * step[1]);
        if long < 1e-8 {
            return Some(place);
        }
    }
    None
}

/// Distance from a point of a mirror to what it shows in a direction.
type Distance = fn(V, V) -> f64;

/// A mirror, what it shows, and what has moved since the last frame.
#[derive(Clone)]
struct Case {
    bench: Bench,
    mirror: Mirror,
    way: Way,
    distance: Distance,
    /// Former place of what is reflected less its place.
    own: V,
}

impl Case {
    /// Former place in pixels less the place, and depth, of a point that was there.
    fn motion(&self, x: i32, y: i32, was: V) -> V {
        let [jx, jy] = self.bench.camera.jitter.map(f64::from);
        let p = Eye::of(&self.bench, self.bench.previous).project(was);
        [p[0] - f64::from(x) - 0.5 - jx, p[1] - f64::from(y) - 0.5 - jy, p[2]]
    }

    fn seen_at(&self, x: i32, y: i32) -> Option<(V, V, V)> {
        let (from, ray) = Eye::of(&self.bench, self.bench.camera).ray(x, y);
        self.mirror.meet(from, ray).map(|(place, normal)| (place, normal, unit(ray)))
    }

    fn guide(&self, camera: Camera, mirror: Mirror) -> Vec<Texel> {
        let eye = Eye::of(&self.bench, camera);
        let texel = |(x, y)| {
            let (from, ray) = eye.ray(x, y);
            mirror.meet(from, ray).map_or([0; 4], |(place, n)| packed([pack_normal(n), word(eye.project(place)[2])]))
        };
        self.bench.pixels().map(texel).collect()
    }

    /// The distance as the pass reads it.
    fn distance(&self, place: V, normal: V, d: V) -> f64 {
        unpack_unsigned(pack_unsigned((self.distance)(place, reflected(d, normal))))
    }

    /// The motions of the surface and of the reflection that the pass finds.
    fn run(&self) -> Vec<(V, V)> {
        let seen: Vec<_> = self.bench.pixels().map(|(x, y)| self.seen_at(x, y)).collect();
        let motion = self.bench.pixels().zip(&seen).map(|((x, y), seen)| {
            seen.map_or([0; 2], |(place, ..)| pack_motion(self.motion(x, y, self.way.place(place, 1.0))))
        });
        let motion: Vec<_> = motion.collect();
        let distances: Vec<f64> =
            seen.iter().map(|s| s.map_or(0.0, |(place, normal, d)| self.distance(place, normal, d))).collect();
        let displaced = displacement_code(self.own);
        let inputs = [
            ("guide", self.guide(self.bench.camera, self.mirror)),
            ("guide_previous", self.guide(self.bench.previous, self.mirror.moved(self.way, 1.0))),
            ("motion", motion.iter().map(|&m| packed(m)).collect()),
            ("gloss", distances.iter().map(|&h| [gloss(0.1, h), 0, 0, 0]).collect()),
            ("specular_radiance", distances.iter().map(|&h| [0, 0, word(h), displaced]).collect()),
        ];
        let out = self.bench.run(&Step::new(&reflection::PASS, Features::of(&[Feature::Instanced])), &inputs);
        let reflections = out["reflection_out"].iter().map(|t| unpack_reflection([t[0], t[1]]));
        motion.into_iter().map(unpack_motion).zip(reflections).collect()
    }

    /// The true motion of a pixel's reflection; `None` if the last frame did not show it.
    fn truth(&self, x: i32, y: i32) -> Option<V> {
        let (mut place, normal, d) = self.seen_at(x, y)?;
        let reflects = add(place, scale(reflected(d, normal), self.distance(place, normal, d)));
        const PARTS: i32 = 8;
        for i in 1..=PARTS {
            let part = f64::from(i) / f64::from(PARTS);
            let eye = Eye::of(&self.bench, Eye::between(&self.bench.camera, &self.bench.previous, part));
            let mirror = self.mirror.moved(self.way, part);
            place = stationary(mirror, &eye, add(reflects, scale(self.own, part)), mirror.nearest(place))?;
        }
        let mirror = self.mirror.moved(self.way, 1.0);
        let eye = Eye::of(&self.bench, self.bench.previous);
        let was = self.motion(x, y, place);
        let [qx, qy] = [f64::from(x) + was[0], f64::from(y) + was[1]].map(|q| q.round() as i32);
        self.bench.at(qx, qy)?;
        // It must be the point that the eye sees there.
        let (from, ray) = eye.ray(qx, qy);
        mirror.meet(from, ray)?;
        (dot(mirror.normal(place), eye.to_eye(place)) > 0.0 && was[2] > 0.0).then_some(was)
    }

    /// Checks the median and the 95th percentile of the error over all pixels with a reflection that the last frame showed, in pixels.
    fn check(&self, what: &str, allowed: [f64; 2]) {
        let (mut errors, mut slid) = (Vec::new(), Vec::new());
        for ((x, y), (surface, motion)) in self.bench.pixels().zip(self.run()) {
            let Some(truth) = self.truth(x, y) else { continue };
            errors.push((motion[0] - truth[0]).hypot(motion[1] - truth[1]));
            slid.push((surface[0] - truth[0]).hypot(surface[1] - truth[1]));
        }
        for list in [&mut errors, &mut slid] {
            list.sort_by(f64::total_cmp);
        }
        let at = |list: &[f64], part: f64| list[((list.len() - 1) as f64 * part) as usize];
        let found = [0.5, 0.95].map(|part| at(&errors, part));
        println!(
            "{what}: median {:.3}, 95 % {:.3}, most {:.2} of {} pixels; the surface's motion is {:.2} off",
            found[0],
            found[1],
            at(&errors, 1.0),
            errors.len(),
            at(&slid, 0.5),
        );
        assert!(errors.len() > 4000 && found[0] <= allowed[0] && found[1] <= allowed[1], "{what}: {found:?}");
    }
}

const SIZE: [u32; 2] = [160, 120];

fn bench() -> Bench {
    Bench::new(SIZE, Settings::adaptive())
}

/// The bench's camera is at (0.2, 0.3, 4) and looks at (0.1, 0, 0).
fn moved_eye(bench: Bench) -> Bench {
    let mut bench = bench;
    bench.previous.eye = add(bench.camera.eye, [0.1, -0.06, 0.08]);
    (bench.camera.jitter, bench.previous.jitter) = ([0.4, -0.3], [-0.4, 0.2]);
    bench
}

const PLANE: Mirror = Mirror::Plane { point: [0.1, 0.0, 0.0], normal: [0.6, 0.0, 0.8] };
const BALL: Mirror = Mirror::Sphere { center: [0.1, 0.0, 0.0], radius: 1.2, inside: false };
/// A bowl that the camera looks into.
const BOWL: Mirror = Mirror::Sphere { center: [0.1, 0.0, 5.0], radius: 6.0, inside: true };

/// Distance to the walls of a large room.
fn room(from: V, d: V) -> f64 {
    let d = unit(d);
    [0, 1, 2].map(|i| (8.0_f64.copysign(d[i]) - from[i]) / d[i]).into_iter().fold(f64::INFINITY, f64::min)
}

/// Distance to the walls of a small room, from one of them.
fn other_walls(from: V, d: V) -> f64 {
    let d = unit(d);
    let walls = [0, 1, 2].map(|i| (ROOM[i].copysign(d[i]) - from[i]) / d[i]);
    walls.into_iter().filter(|&t| t > 1e-9).fold(f64::INFINITY, f64::min)
}

const ROOM: V = [2.0, 1.5, 1.7];
const DISTANCES: [(&str, Distance); 4] = [("½", |_, _| 0.5), ("2", |_, _| 2.0), ("30", |_, _| 30.0), ("a room", room)];
const SHIFTED: Way = Way { shift: [0.05, 0.03, -0.04], ..REST };
/// A displacement that its format holds exactly.
const OWN: V = [20.0 / 255.0, -10.0 / 255.0, 25.0 / 255.0];

fn turning(pivot: V, angle: f64) -> Way {
    Way { pivot, axis: unit([0.2, 1.0, 0.1]), angle, ..REST }
}

/// Checks the median and the 95th percentile of the errors, in pixels, for everything that may move but what turns.
fn check_moving(name: &str, mirror: Mirror, distances: &[(&str, Distance)], allowed: [f64; 2]) {
    let (still, walk) = (bench(), moved_eye(bench()));
    let orthographic = Bench { half_height: Some(1.4), ..walk.clone() };
    for &(far, distance) in distances {
        let rest = Case { bench: walk.clone(), mirror, way: REST, distance, own: [0.0; 3] };
        let cases = [
            ("the camera moves", Case { ..rest.clone() }),
            ("an orthographic camera moves", Case { bench: orthographic.clone(), ..rest.clone() }),
            ("the mirror moves", Case { bench: still.clone(), way: SHIFTED, ..rest.clone() }),
            ("the reflected thing moves", Case { bench: still.clone(), own: OWN, ..rest.clone() }),
            ("all moves", Case { way: SHIFTED, own: OWN, ..rest }),
        ];
        for (moves, case) in cases {
            case.check(&format!("{name}, {far} away, {moves}"), allowed);
        }
    }
}

#[test]
fn flat_mirrors() {
    check_moving("plane", PLANE, &DISTANCES, [0.02, 0.02]);
}

#[test]
fn convex_mirrors() {
    check_moving("ball", BALL, &DISTANCES, [0.1, 0.5]);
}

#[test]
fn concave_mirrors_that_show_virtual_images() {
    check_moving("bowl", BOWL, &DISTANCES[..1], [0.1, 0.5]);
}

/// Real images, between the mirror and the eye, are as far from paraxial as images get.
#[test]
fn concave_mirrors_that_show_real_images() {
    check_moving("bowl", BOWL, &DISTANCES[2..3], [0.75, 1.5]);
}

/// Normals have 10 bits, so a mirror that turns by 0.1° may as well rest; the image of what is far turns by twice the angle.
#[test]
fn mirrors_that_turn() {
    for (far, distance) in DISTANCES {
        for (name, mirror, center) in [("plane", PLANE, [0.1, 0.0, 0.0]), ("ball", BALL, [0.1, 0.0, 0.0])] {
            let rest = Case { bench: bench(), mirror, way: REST, distance, own: [0.0; 3] };
            for (angle, allowed) in [(0.002, [0.55, 0.65]), (0.01, [0.25, 0.5]), (0.05, [0.25, 0.5])] {
                let case = Case { way: turning(center, angle), ..rest.clone() };
                case.check(&format!("{name}, {far} away, turns by {angle}"), allowed);
            }
            let way = turning(add(center, [0.5, 0.0, 0.2]), 0.03);
            let case = Case { bench: moved_eye(bench()), way, ..rest };
            case.check(&format!("{name}, {far} away, turns beside its centre while the camera moves"), [0.5, 0.6]);
        }
    }
}

#[test]
fn a_camera_inside_a_mirrored_box() {
    let mut bench = moved_eye(bench());
    (bench.camera.eye, bench.camera.target) = ([0.2, 0.3, 0.5], [1.0, 0.1, -1.5]);
    (bench.previous.eye, bench.previous.target) = ([0.25, 0.28, 0.46], [1.0, 0.1, -1.5]);
    let mirror = Mirror::Room { half: ROOM };
    Case { bench, mirror, way: REST, distance: other_walls, own: [0.0; 3] }.check("inside a box", [0.02, 0.05]);
}
