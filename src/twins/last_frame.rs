//! The last frame's images, which reprojection reads, and a surface's history in them, in f64.

use super::bench::{Bench, Texel};
use super::codec::{
    Kept, depth, luminance, pack_history, pack_motion, pack_rgb, radiance, unpack_history, unpack_motion,
    unpack_normal, unpack_rgb, word,
};
use super::outliers;
use super::plane::{Pinhole, V, add, dot, scale, sub};
use super::random::Random;
use crate::Settings;
use crate::passes::temporal;
use crate::plan::{Feature, Features, Step};

/// All inputs of the pass.
pub(super) struct Given {
    pub(super) bench: Bench,
    pub(super) features: Features,
    pub(super) guide: Vec<[u32; 2]>,
    pub(super) guide_before: Vec<[u32; 2]>,
    pub(super) motion: Vec<V>,
    pub(super) object: Vec<u32>,
    pub(super) object_before: Vec<u32>,
    pub(super) radiance: Vec<Texel>,
    pub(super) history: Vec<Kept>,
    pub(super) feedback: Vec<Texel>,
    pub(super) output: Vec<Texel>,
    pub(super) samples: Vec<Texel>,
    pub(super) gradient: Vec<Texel>,
    pub(super) ratio: Vec<Texel>,
    pub(super) external: Vec<Texel>,
    pub(super) limit: Vec<Texel>,
}

/// Notes taken on the way, see [`Blended`].
#[derive(Default)]
pub(super) struct Notes {
    pub(super) unsure: bool,
    pub(super) largest: f64,
}

/// A reprojected history.
#[derive(Default)]
pub(super) struct Before {
    pub(super) color: V,
    pub(super) mean: f64,
    pub(super) square: f64,
    pub(super) variance: f64,
    pub(super) length: f64,
    pub(super) weight: f64,
    /// Weight of all taps on the surface, with or without a history.
    pub(super) surface: f64,
    pub(super) output: V,
}

impl Before {
    /// The weighted mean of the taps; `None` if they weigh next to nothing.
    fn mean(self) -> Option<Self> {
        (self.weight > 0.01).then(|| {
            let s = 1.0 / self.weight;
            let mean = self.mean * s;
            let variance = self.variance * s + (self.square * s - mean * mean).max(0.0);
            let [color, output] = [self.color, self.output].map(|c| scale(c, s));
            Self { color, mean, variance, length: self.length * s, output, ..self }
        })
    }
}

/// The texel of a missing radiance, and the mark of an infinite one.
pub(super) const NO_SAMPLE: Texel = [0, 1 << 22, 0, 0];
pub(super) const INFINITE: u32 = 1 << 31;

fn pack_guide(g: &[u32; 2]) -> Texel {
    [g[0], g[1], 0, 0]
}

impl Given {
    pub(super) fn new(size: [u32; 2], features: &[Feature], settings: Settings, moving: bool) -> Self {
        let mut bench = Bench { lambda_block: if moving { 3 } else { 1 }, ..Bench::new(size, settings) };
        if moving {
            bench.previous.eye[0] += 0.05;
            bench.previous.jitter = [-0.4, 0.1];
        }
        let features = temporal::PASS.features_of(Features::of(features));
        let mut random = Random(u64::from(size[0]) + u64::from(moving));
        let guide = bench.guide(&mut random);
        let now = bench.clone();
        // The last frame saw the same planes.
        let was = Bench { camera: bench.previous, ..bench.clone() };
        let guide_before = was.guide(&mut Random(99));
        let motion =
            bench.pixels().map(|(x, y)| now.motion(x, y, depth(guide[now.at(x, y).unwrap()]), &mut random)).collect();
        let count = guide.len();
        let mut each =
            |f: &mut dyn FnMut(&mut Random) -> Texel| -> Vec<Texel> { (0..count).map(|_| f(&mut random)).collect() };
        let color = |r: &mut Random| {
            let [a, b] = pack_rgb(radiance(r));
            [a, b, 0, 0]
        };
        let gaps = features.has(Feature::MissingSamples);
        let radiance_now = each(&mut |r| match if gaps { r.below(12) } else { 12 } {
            0 | 1 => NO_SAMPLE,
            2 => {
                let [a, b, ..] = color(r);
                [a, b | INFINITE, 0, 0]
            }
            _ => color(r),
        });
        let feedback = each(&mut |r| color(r));
        let output = each(&mut |r| color(r));
        let history = (0..count)
            .map(|_| {
                let length = if gaps && random.below(4) == 0 { 0.0 } else { 1.0 + 20.0 * random.unit().powi(2) };
                let color = if features.has(Feature::Feedback) { [random.unit(); 3] } else { radiance(&mut random) };
                // Take the numbers as the texture holds them.
                unpack_history(pack_history(Kept { color, variance: random.unit().powi(4), length }))
            })
            .collect();
        let mut each =
            |f: &mut dyn FnMut(&mut Random) -> Texel| -> Vec<Texel> { (0..count).map(|_| f(&mut random)).collect() };
        let object = each(&mut |r| [u32::from(r.unit() < 0.1); 4]).iter().map(|t| t[0]).collect();
        let object_before = each(&mut |r| [u32::from(r.unit() < 0.1); 4]).iter().map(|t| t[0]).collect();
        let samples = bench.records(&guide, &mut random);
        let signed = bench.settings.filter.gradient_signed;
        let gradient = samples
            .iter()
            .map(|_| match random.below(5) {
                // The cases are nothing to compare, no change, a complete change, and more than that.
                0 => [0; 4],
                1 => [0, word(0.7), 0, 0],
                2 => [word(1.1), word(1.0), 0, 0],
                // The numerator may be negative if the differences have a sign.
                3 if signed => [word(-0.6 * random.unit()), word(1.0), 0, 0],
                _ => [word(0.6 * random.unit()), word(1.0), 0, 0],
            })
            .collect();
        let [across, down] = size.map(|s| s.div_ceil(bench.lambda_block));
        // Texels are λ, or numbers that are no λ: none of the latter may come through.
        let external = (0..across * down)
            .map(|_| match random.below(8) {
                0 => [f32::NAN.to_bits(); 4],
                1 => [f32::INFINITY.to_bits(); 4],
                2 => [word(-0.5); 4],
                3 => [word(1.5); 4],
                _ => [word(random.unit()); 4],
            })
            .collect();
        let limit = outliers::limits(&bench, &mut Random(4));
        let ratio = samples.iter().map(|_| [0; 4].map(|_| word(random.between(0.25, 4.0)))).collect();
        Self {
            bench,
            features,
            guide,
            guide_before,
            motion,
            object,
            object_before,
            radiance: radiance_now,
            history,
            feedback,
            output,
            samples,
            gradient,
            ratio,
            external,
            limit,
        }
    }

    /// The images behind a step's bindings.
    pub(super) fn inputs(&self, step: &Step) -> Vec<(&'static str, Vec<Texel>)> {
        let all = [
            ("guide", self.guide.iter().map(pack_guide).collect()),
            ("guide_previous", self.guide_before.iter().map(pack_guide).collect()),
            ("motion", self.motion.iter().map(|&m| pack_guide(&pack_motion(m))).collect()),
            ("object", self.object.iter().map(|&o| [o; 4]).collect()),
            ("object_previous", self.object_before.iter().map(|&o| [o; 4]).collect()),
            ("radiance", self.radiance.clone()),
            ("history_previous", self.history.iter().map(|&h| pack_guide(&pack_history(h))).collect()),
            ("feedback_previous", self.feedback.clone()),
            ("output_previous", self.output.clone()),
            ("samples", self.samples.clone()),
            ("gradient", self.gradient.clone()),
            ("ratio", self.ratio.clone()),
            ("external_lambda", self.external.clone()),
            ("limit", self.limit.clone()),
        ];
        all.into_iter()
            .filter(|(n, _): &(&str, Vec<Texel>)| step.bindings.iter().any(|bound| bound.name == *n))
            .collect()
    }

    /// A pixel's sample; `None` if it has none.
    pub(super) fn sample(&self, i: usize) -> Option<V> {
        let texel = self.radiance[i];
        (texel != NO_SAMPLE && texel[1] & INFINITE == 0).then(|| unpack_rgb([texel[0], texel[1]]))
    }

    /// Colour, variance and length of the history under the four nearest taps, if there is one; and true if a threshold was near.
    pub(super) fn bilinear_history(&self, i: usize, x: i32, y: i32) -> (Option<(V, f64, f64)>, bool) {
        let mut notes = Notes::default();
        let (sum, ..) = self.bilinear(i, x, y, &mut notes);
        notes.unsure |= (sum.weight - 0.01).abs() < 1e-4;
        let found = sum.mean().map(|h| (h.color, h.variance, h.length));
        (found, notes.unsure)
    }

    pub(super) fn has(&self, feature: Feature) -> bool {
        self.features.has(feature)
    }

    pub(super) fn object_at(&self, objects: &[u32], i: usize) -> u32 {
        if self.has(Feature::Objects) { objects[i] } else { 0 }
    }

    /// Adds a tap of the history if it shows the same surface: within 1 % of the depth of its plane, 5 % away, 26° turned.
    fn add_tap(&self, sum: &mut Before, here: usize, origin: V, [x, y]: [i32; 2], w: f64, notes: &mut Notes) {
        let bench = &self.bench;
        notes.unsure |= (w - 1e-4).abs() < 2e-5;
        let Some(q) = bench.at(x, y).filter(|_| w >= 1e-4) else { return };
        let z = depth(self.guide_before[q]);
        if z == 0.0 || self.object_at(&self.object_before, q) != self.object_at(&self.object, here) {
            return;
        }
        let previous = Bench { camera: bench.previous, ..bench.clone() };
        let offset = sub(origin, previous.position(x, y, z));
        let normal = unpack_normal(self.guide_before[q][0]);
        let tests = [
            0.01 - dot(normal, offset).abs() / z,
            0.05 - dot(offset, offset).sqrt() / z,
            dot(normal, unpack_normal(self.guide[here][0])) - 0.9,
        ];
        notes.unsure |= tests.iter().any(|t| t.abs() < 1e-5);
        if tests.iter().any(|&t| t < 0.0) {
            return;
        }
        sum.surface += w;
        let h = self.history[q];
        if h.length == 0.0 {
            return;
        }
        let (color, mean) = self.stored(q);
        notes.largest = color.into_iter().fold(notes.largest.max(mean), f64::max).max(h.variance.sqrt());
        sum.color = add(sum.color, scale(color, w));
        sum.output = add(sum.output, scale(self.output_at(q), w));
        sum.mean += w * mean;
        sum.square += w * mean * mean;
        sum.variance += w * h.variance;
        sum.length += w * h.length;
        sum.weight += w;
    }

    fn output_at(&self, q: usize) -> V {
        unpack_rgb([self.output[q][0], self.output[q][1]])
    }

    /// Colour and mean luminance of a texel of the history.
    pub(super) fn stored(&self, q: usize) -> (V, f64) {
        let color = self.history[q].color;
        if self.has(Feature::Feedback) {
            (unpack_rgb([self.feedback[q][0], self.feedback[q][1]]), color[0])
        } else {
            (color, luminance(color))
        }
    }

    /// The history of a pixel: bilinear, or else from a Gaussian over 4×4; its own if nothing moves.
    pub(super) fn before(&self, i: usize, x: i32, y: i32, notes: &mut Notes) -> Option<Before> {
        if self.has(Feature::Still) {
            let (color, mean) = self.stored(i);
            let Kept { variance, length, .. } = self.history[i];
            if length == 0.0 {
                return None;
            }
            notes.largest = color.into_iter().fold(notes.largest.max(mean), f64::max).max(variance.sqrt());
            return Some(Before { color, mean, variance, length, output: self.output_at(i), ..Default::default() });
        }
        let (mut sum, origin, point, base) = self.bilinear(i, x, y, notes);
        notes.unsure |= [sum.weight, sum.surface].iter().any(|w| (w - 0.01).abs() < 1e-4);
        if sum.surface <= 0.01 {
            sum = Before::default();
            for (dx, dy) in (-1..=2).flat_map(|dy| (-1..=2).map(move |dx| (dx, dy))) {
                let tap = [base[0] + dx, base[1] + dy];
                let squared: f64 = [0, 1].map(|a| (f64::from(tap[a]) - point[a]).powi(2)).iter().sum();
                self.add_tap(&mut sum, i, origin, tap, (-squared).exp(), notes);
            }
            notes.unsure |= (sum.weight - 0.01).abs() < 1e-4;
        }
        sum.mean()
    }

    /// The surface's former place in the world.
    pub(super) fn former_place(&self, i: usize, x: i32, y: i32) -> V {
        let m = self.motion[i];
        let [jx, jy] = self.bench.camera.jitter.map(|j| f64::from(j) + 0.5);
        let was = Pinhole::new(&self.bench.previous, self.bench.size);
        add(was.eye, scale(was.ray(f64::from(x) + m[0] + jx, f64::from(y) + m[1] + jy), m[2]))
    }

    /// The four taps around the surface's former place; that place in the world and in the image, and its upper left pixel.
    fn bilinear(&self, i: usize, x: i32, y: i32, notes: &mut Notes) -> (Before, V, [f64; 2], [i32; 2]) {
        let m = self.motion[i];
        let point = [f64::from(x) + m[0], f64::from(y) + m[1]];
        let origin = self.former_place(i, x, y);
        // A motion that is whole up to rounding errors stays on its pixel.
        let corner = point.map(|p| (p + 1e-4).floor());
        notes.unsure |= point.iter().any(|p| ((p + 1e-4) - (p + 1e-4).round()).abs() < 1e-5);
        let f = [0, 1].map(|a| (point[a] - corner[a]).max(0.0));
        let base = corner.map(|c| c as i32);
        let mut sum = Before::default();
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let along = |d: i32, f: f64| if d == 0 { 1.0 - f } else { f };
            let w = along(dx, f[0]) * along(dy, f[1]);
            self.add_tap(&mut sum, i, origin, [base[0] + dx, base[1] + dy], w, notes);
        }
        (sum, origin, point, base)
    }
}

impl Bench {
    /// Former place, in pixels, and depth of a surface that stands still; now and then it moves, or was nowhere.
    fn motion(&self, x: i32, y: i32, z: f64, random: &mut Random) -> V {
        let [jx, jy] = self.camera.jitter.map(f64::from);
        let was = Pinhole::new(&self.previous, self.size).project(self.position(x, y, z));
        let extra = match random.below(10) {
            0 => [random.between(-3.0, 3.0), random.between(-3.0, 3.0)],
            1 => [-1e9, 0.0],
            _ => [0.0; 2],
        };
        let moved = [was[0] - f64::from(x) - 0.5 - jx + extra[0], was[1] - f64::from(y) - 0.5 - jy + extra[1], was[2]];
        // Take the numbers as the texture holds them.
        unpack_motion(pack_motion(moved))
    }
}
