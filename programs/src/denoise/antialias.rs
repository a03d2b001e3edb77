//! Edges and textures as a pixel's whole area shows them, from frames that see only points of it.
//!
//! Failure: at one sample per pixel, the stripes of a wall were jagged and crawled, although the renderer's own image
//! of many samples is smooth; that was half of the whole error of a sequence. Reason: each frame's guides belong to one
//! point of each pixel, and the filter keeps to them. Rule: at an edge of the guides, a pixel is the mean of its
//! colours in this frame and in two frames to each side, followed along the motion (Korein and Badler 1983), with the
//! weights of a tent. A colour from another frame is clamped to the range of the colours around the pixel (Karis
//! 2014), and counts less the more the clamp changes it.

use crate::denoise::grid::{around, bilinear};
use crate::denoise::inverted_motion::inverted;
use crate::denoise::parallel;
use crate::sequence::Pixels;
use crate::sequence::layers::Layer;
use std::collections::VecDeque;

/// Weights of this frame and of its neighbours in time.
const TENT: [f32; 3] = [3.0, 2.0, 1.0];

/// Frames to each side.
const REACH: usize = TENT.len() - 1;

/// Relative contrasts of albedo and of depth, and 1 − cosine of normals, that make an edge a whole one.
const CONTRAST: f32 = 0.2;
const STEP: f32 = 0.1;
const BEND: [f32; 2] = [0.1, 0.3];

/// A frame that waits for later ones.
pub struct Held {
    /// Its place in the sequence.
    pub index: usize,
    pub image: Vec<[f32; 3]>,
    /// Guides of the filter for this image.
    pub pixels: Pixels,
    /// Motion to the frame before it, in pixels.
    pub motion: Vec<f32>,
    /// True if it has no frame before it.
    pub begins: bool,
}

/// Queue of the frames that wait.
pub struct Antialias {
    size: [usize; 2],
    held: VecDeque<Held>,
    /// Index of the next frame that leaves the queue.
    next: usize,
}

impl Antialias {
    pub fn new(size: [u32; 2]) -> Self {
        Self { size: size.map(|side| side as usize), held: VecDeque::new(), next: 0 }
    }

    /// Takes a frame, and returns those that need not wait any longer.
    pub fn push(&mut self, frame: Held) -> Vec<(usize, Vec<[f32; 3]>)> {
        self.held.push_back(frame);
        let mut finished = Vec::new();
        while self.next + REACH < self.held.len() {
            finished.push(self.leave());
        }
        finished
    }

    /// Returns the rest.
    pub fn finish(&mut self) -> Vec<(usize, Vec<[f32; 3]>)> {
        let mut finished = Vec::new();
        while self.next < self.held.len() {
            finished.push(self.leave());
        }
        finished
    }

    fn leave(&mut self) -> (usize, Vec<[f32; 3]>) {
        let finished = (self.held[self.next].index, self.smooth(self.next));
        self.next += 1;
        if self.next > REACH {
            self.held.pop_front();
            self.next -= 1;
        }
        finished
    }

    fn smooth(&self, at: usize) -> Vec<[f32; 3]> {
        let now = &self.held[at];
        // Follows the pixels' places to each side, frame by frame.
        let sides = [self.paths(at, false), self.paths(at, true)];
        if sides.iter().all(Vec::is_empty) {
            return now.image.clone();
        }
        parallel::map(now.image.len(), |i| {
            let own = now.image[i];
            let edge = self.edge(now, i);
            if edge <= 0.0 {
                return own;
            }
            let (mut low, mut high) = (own, own);
            for j in around(self.size, i, 1) {
                low = std::array::from_fn(|c| low[c].min(now.image[j][c]));
                high = std::array::from_fn(|c| high[c].max(now.image[j][c]));
            }
            let (mut sum, mut weights) = (own.map(|x| x * TENT[0]), TENT[0]);
            for (frame, places) in sides.iter().flatten() {
                let place = places[i];
                let inside = (0..2).all(|k| place[k] >= 0.0 && place[k] <= (self.size[k] - 1) as f32);
                if !inside {
                    continue;
                }
                let there = bilinear(self.size, place, |j| self.held[*frame].image[j]);
                let kept: [f32; 3] = std::array::from_fn(|c| there[c].clamp(low[c], high[c]));
                let away: f32 = (0..3).map(|c| (there[c] - kept[c]).abs()).sum();
                let whole: f32 = (0..3).map(|c| there[c].abs() + kept[c].abs()).sum();
                let weight = TENT[frame.abs_diff(at)] * (1.0 - 4.0 * away / whole.max(1e-30)).max(0.0);
                // Sky and misses yield NaN, which this test keeps out.
                if weight > 0.0 {
                    sum = std::array::from_fn(|c| sum[c] + weight * kept[c]);
                    weights += weight;
                }
            }
            std::array::from_fn(|c| own[c] + edge * (sum[c] / weights - own[c]))
        })
    }

    /// Returns the frames to one side of a frame, nearest first, and its pixels' places in them.
    fn paths(&self, at: usize, later: bool) -> Vec<(usize, Vec<[f32; 2]>)> {
        let mut paths: Vec<(usize, Vec<[f32; 2]>)> = Vec::new();
        let mut frame = at;
        for _ in 0..REACH {
            let (step, next) = if later {
                let Some(next) = self.held.get(frame + 1).filter(|next| !next.begins) else { break };
                (inverted(&next.motion, self.size.map(|side| side as u32)), frame + 1)
            } else {
                if frame == 0 || self.held[frame].begins {
                    break;
                }
                (self.held[frame].motion.clone(), frame - 1)
            };
            let nearest = self.of_nearest(&self.held[frame], &step);
            let before = paths.last().map(|(_, places)| places);
            let places = parallel::map(nearest.len(), |i| {
                let place = before.map_or([(i % self.size[0]) as f32, (i / self.size[0]) as f32], |places| places[i]);
                let [x, y] = bilinear(self.size, place, |j| nearest[j]);
                [place[0] + x, place[1] + y]
            });
            paths.push((next, places));
            frame = next;
        }
        paths
    }

    /// Takes the motion of the nearest surface, because at an edge the front surface moves and uncovers the back.
    fn of_nearest(&self, frame: &Held, motion: &[f32]) -> Vec<[f32; 2]> {
        let depth = frame.pixels.get(Layer::Depth).unwrap_or_default();
        let (motion, _) = motion.as_chunks::<2>();
        let at = |i: usize| if depth[i] > 0.0 { depth[i] } else { f32::MAX };
        let nearest = |i: usize| around(self.size, i, 1).fold(i, |near, j| if at(j) < at(near) { j } else { near });
        parallel::map(motion.len(), |i| motion[nearest(i)].map(|x| if x.is_finite() { x } else { 0.0 }))
    }

    /// Returns how much of an edge the guides have in 3×3 pixels, 0…1.
    fn edge(&self, frame: &Held, i: usize) -> f32 {
        let get = |layer| frame.pixels.get(layer);
        let depth = get(Layer::Depth).unwrap_or_default();
        let deep = |j: usize| if depth[j] > 0.0 { depth[j].min(1e9) } else { 1e9 };
        let three = |samples: &[f32], j: usize| [samples[3 * j], samples[3 * j + 1], samples[3 * j + 2]];
        let (mut near, mut far) = (deep(i), deep(i));
        let (mut low, mut high, mut cosine) = ([f32::MAX; 3], [0.0_f32; 3], 1.0_f32);
        let normals = get(Layer::Normal);
        let normal = normals.map(|n| three(n, i));
        for j in around(self.size, i, 1) {
            (near, far) = (near.min(deep(j)), far.max(deep(j)));
            if let Some(albedo) = get(Layer::Albedo) {
                let a = three(albedo, j).map(|x| if x.is_finite() { x.clamp(0.0, 1.0) } else { 1.0 });
                low = std::array::from_fn(|c| low[c].min(a[c]));
                high = std::array::from_fn(|c| high[c].max(a[c]));
            }
            if let Some((n, other)) = normal.zip(normals.map(|n| three(n, j))) {
                cosine = cosine.min((0..3).map(|c| n[c] * other[c]).sum());
            }
        }
        let most = high.into_iter().fold(0.0, f32::max);
        let contrast = (0..3).map(|c| high[c] - low[c]).fold(0.0, f32::max) / (most + 0.05);
        let bend = (1.0 - cosine - BEND[0]) / (BEND[1] - BEND[0]);
        (contrast / CONTRAST).max((far / near - 1.0) / STEP).max(bend).clamp(0.0, 1.0)
    }
}
