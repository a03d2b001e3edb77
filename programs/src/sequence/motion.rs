//! Checks of motion: finds a wrong sign, axis or unit, and frames that do not follow the one before at all.

use super::Pixels;
use super::layers::Layer;
use crate::sequence::camera::{Raster, dot};

/// Deviations of a file's vectors from the format's, and the words of the complaint.
pub const READINGS: [(&str, [f32; 4]); 9] = [
    ("its y points up: say --map motion=NAME:up", [1.0, 0.0, 0.0, -1.0]),
    ("it leads to the next frame instead of the last: both signs are turned over", [-1.0, 0.0, 0.0, -1.0]),
    ("its x points left, or it leads to the next frame with y up", [-1.0, 0.0, 0.0, 1.0]),
    ("x and y are exchanged", [0.0, 1.0, 1.0, 0.0]),
    (
        "it is half of the way: it is of every frame, and every second one was rendered, or its unit is half a pixel",
        [2.0, 0.0, 0.0, 2.0],
    ),
    ("it is twice the way", [0.5, 0.0, 0.0, 0.5]),
    ("its unit is the picture's size, not a pixel", [f32::NAN, 0.0, 0.0, f32::NAN]),
    ("its unit is half the picture's size, not a pixel", [f32::INFINITY, 0.0, 0.0, f32::INFINITY]),
    (
        "its unit is half the picture's size, not a pixel, and its y points up",
        [f32::INFINITY, 0.0, 0.0, f32::NEG_INFINITY],
    ),
];

/// Numbers of compared pixels of two frames, and of those that show the same surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Matches {
    pub compared: usize,
    pub same: usize,
    /// Number of pixels that were considered.
    pub of: usize,
}

impl Matches {
    pub fn add(&mut self, other: Self) {
        self.compared += other.compared;
        self.same += other.same;
        self.of += other.of;
    }

    /// True if the compared part of the image is large enough to represent it: a bird in the sky is no shot.
    pub fn tells(self) -> bool {
        self.compared > 0 && 20 * self.compared >= self.of
    }

    /// Returns the part of the compared surfaces that were not found, 0 if none were compared.
    pub fn lost(self) -> f64 {
        if self.compared == 0 { 0.0 } else { 1.0 - self.same as f64 / self.compared as f64 }
    }
}

/// Approximate number of pixels to compare.
const PIXELS: usize = 20_000;

/// Compares surfaces along the motion, for each reading, in pixels that move by a pixel or more by any reading;
/// compares nothing if nothing moves. The first reading is the format's own.
pub fn readings(now: &Pixels, before: &Pixels, motion: &[f32], raster: Raster) -> Vec<Matches> {
    let moved = |m: [f32; 2]| m[0].abs().max(m[1].abs());
    let own = [1.0, 0.0, 0.0, 1.0];
    let matrices = std::iter::once(own).chain(READINGS.map(|(_, matrix)| in_pixels(matrix, raster)));
    matrices
        .map(|[a, b, c, d]| {
            let reading = |m: [f32; 2]| [a * m[0] + b * m[1], c * m[0] + d * m[1]];
            // All readings compare the same pixels: those in which the farthest reading leads somewhere else.
            matches(now, before, raster, true, |i| {
                let m = [motion[2 * i], motion[2 * i + 1]];
                let scaled = [m[0] * raster.size[0] as f32, m[1] * raster.size[1] as f32];
                (moved(m) >= 1.0 || (moved(m) < 0.5 && moved(scaled) >= 4.0)).then(|| reading(m))
            })
        })
        .collect()
}

/// Puts the picture's units into a reading's matrix.
fn in_pixels(matrix: [f32; 4], raster: Raster) -> [f32; 4] {
    let [width, height] = raster.picture.map(|side| side as f32);
    let unit = |x: f32, side: f32| match x {
        x if x.is_nan() => side,
        x if x.is_infinite() => x.signum() * side / 2.0,
        x => x,
    };
    [unit(matrix[0], width), matrix[1], matrix[2], unit(matrix[3], height)]
}

/// Compares surfaces of two frames along a motion, for pixels that have one. On request, compares their albedo too:
/// textures reveal small errors of motion, but fine ones differ in each frame.
pub fn matches(
    now: &Pixels,
    before: &Pixels,
    raster: Raster,
    by_albedo: bool,
    motion: impl Fn(usize) -> Option<[f32; 2]>,
) -> Matches {
    let [width, height] = raster.size;
    let count = (width * height) as usize;
    let get = |pixels, layer| Pixels::get(pixels, layer).unwrap_or_default();
    let (depth, depth_before) = (get(now, Layer::Depth), get(before, Layer::Depth));
    let (normal, normal_before) = (get(now, Layer::Normal), get(before, Layer::Normal));
    let ids = now.get(Layer::Id).zip(before.get(Layer::Id));
    let albedos = now.get(Layer::Albedo).zip(before.get(Layer::Albedo)).filter(|_| by_albedo);
    let three = |samples: &[f32], i: usize| [samples[3 * i], samples[3 * i + 1], samples[3 * i + 2]].map(f64::from);
    let mut matches = Matches::default();
    for i in (0..count).step_by((count / PIXELS) | 1) {
        matches.of += 1;
        let Some(m) = motion(i).filter(|_| depth[i] > 0.0 && depth[i].is_finite()) else { continue };
        let place = [(i as u32 % width) as f32 + m[0], (i as u32 / width) as f32 + m[1]].map(f32::round);
        if !(place[0] >= 0.0 && place[1] >= 0.0 && place[0] < width as f32 && place[1] < height as f32) {
            continue;
        }
        let j = place[1] as usize * width as usize + place[0] as usize;
        // On slanted surfaces, half a pixel makes another depth.
        let near = (depth_before[j] / depth[i] - 1.0).abs() < 0.1;
        let turned = dot(three(normal, i), three(normal_before, j))
            >= 0.9 * length(three(normal, i)) * length(three(normal_before, j));
        let object = ids.is_none_or(|(now, before)| now[i].to_bits() == before[j].to_bits());
        let albedo = albedos.is_none_or(|(now, before)| {
            // Ignores values that are no albedo.
            let is_one = |a: &[f32]| a.iter().all(|x| (0.0..=1.0).contains(x)) && a.iter().any(|x| *x > 0.0);
            let (now, before) = (&now[3 * i..3 * i + 3], &before[3 * j..3 * j + 3]);
            !is_one(now) || !is_one(before) || now.iter().zip(before).all(|(a, b)| (a - b).abs() <= 0.1)
        });
        matches.compared += 1;
        matches.same += usize::from(near && turned && object && albedo);
    }
    matches
}

fn length(v: [f64; 3]) -> f64 {
    dot(v, v).sqrt()
}

/// Part of the surfaces that may be lost along the motion of a sequence without a complaint.
const LOST: f64 = 0.15;

/// Part from which on a complaint follows even if no other reading fits: smaller parts may be noise of the guides.
const LOST_ANYWAY: f64 = 0.5;

/// Part of its own loss below which another reading's loss must be to be named.
const BETTER: f64 = 0.4;

/// Words the complaint about the motion of a sequence, given the matches of all readings, summed over its frames;
/// `None` if the motion is right.
pub fn complaint(readings: &[Matches]) -> Option<String> {
    let own = readings.first()?;
    if own.compared < 200 || own.lost() < LOST {
        return None;
    }
    let lost = format!("motion leads to other surfaces in {:.0} % of the pixels that move", 100.0 * own.lost());
    let others = readings[1..].iter().zip(READINGS).filter(|(matches, _)| 2 * matches.compared > own.compared);
    let best = others.min_by(|a, b| a.0.lost().total_cmp(&b.0.lost()));
    Some(match best.filter(|(matches, _)| matches.lost() < BETTER * own.lost()) {
        Some((matches, (reading, _))) => {
            format!("{lost}, and in {:.0} % if {reading}", 100.0 * matches.lost())
        }
        None if own.lost() < LOST_ANYWAY => return None,
        None => format!("{lost}: its sign, its unit or its axis is wrong, or depths, normals or ids are noisy"),
    })
}
