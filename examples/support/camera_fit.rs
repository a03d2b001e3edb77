//! A camera from what it saw, where nobody wrote it down.
//!
//! The ray of an image point (x, y) is c + x·a + y·b. Two points p and q of a plane with the normal n satisfy
//! n·(z_q·ray_q − z_p·ray_p) = 0. The camera's directions and its field of view, four numbers, are fitted so that the squares of
//! that over many pairs are least (Levenberg 1944). Only normals and depths are used: it is a camera in the normals' own space,
//! whatever that is, and where it stands remains unknown. Directions that no plane tells are as good as any.

use crate::camera::{Camera, dot};

/// About how many pixels of an image are looked at.
const PIXELS: usize = 30_000;

/// Fewest pairs to trust.
const ENOUGH: usize = 200;

/// Largest part of the squared distances between the points that may be left out of their planes.
const RESIDUAL: f64 = 1e-3;

/// The part of the surfaces that must face the camera.
const FACING: f64 = 0.98;

/// c, a and b, nine numbers.
type Rays = [f64; 9];

/// What pairs of points ask of the rays.
struct Planes {
    /// Of the squared distances from the planes, as a quadratic form.
    apart: [[f64; 9]; 9],
    /// Of the squared distances between the points.
    between: [[f64; 3]; 3],
    /// Normals, and where they were seen.
    seen: Vec<([f64; 3], [f64; 3])>,
    /// Height over width of the image.
    aspect: f64,
}

/// Directions to the right, up and forward, and the tangent of half the field of view.
#[derive(Clone, Copy)]
struct Guess([[f64; 3]; 3], f64);

/// Fits a camera to the normals and depths of an image; `None` where they do not tell.
pub fn fit(normals: &[f32], depths: &[f32], size: [u32; 2]) -> Option<Camera> {
    let planes = Planes::new(normals, depths, size);
    let fitted = starts().map(|guess| planes.refine(guess));
    let fitting =
        fitted.flat_map(|Guess(axes, slope)| [axes, axes.map(|a| a.map(|x| -x))].map(|axes| Guess(axes, slope)));
    let fitting = fitting.filter(|guess| planes.seen.len() >= ENOUGH && planes.facing(guess) >= FACING);
    let (residual, Guess([right, up, forward], slope)) =
        fitting.map(|guess| (planes.residual(&guess), guess)).min_by(|a, b| a.0.total_cmp(&b.0))?;
    (residual <= RESIDUAL).then_some(Camera { eye: [0.0; 3], forward, right, up, slope, jitter: [0.0; 2] })
}

impl Planes {
    fn new(normals: &[f32], depths: &[f32], [width, height]: [u32; 2]) -> Self {
        let (width, height) = (width as usize, height as usize);
        let normal = |i: usize| [normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]].map(f64::from);
        let aspect = height as f64 / width as f64;
        let mut planes = Self { apart: [[0.0; 9]; 9], between: [[0.0; 3]; 3], seen: Vec::new(), aspect };
        // Far enough apart that the rounding of depths does not count, and near enough to be of one plane.
        let span = 2 * (width.min(height) / 36).max(4);
        // Odd, so that all columns have their turn.
        let every = (width * height / PIXELS) | 1;
        for (p, step) in (0..width * height).step_by(every).flat_map(|p| [(p, 1), (p, width)]) {
            let within = if step == 1 { p % width + span < width } else { p / width + span < height };
            let q = p + span * step;
            if !within || !is_plane([p, p + span / 2 * step, q], &normal, depths) {
                continue;
            }
            let n = normal(p);
            let [z_p, z_q] = [p, q].map(|i| f64::from(depths[i]));
            let [at_p, at_q] = [p, q].map(|i| point(i, width, height));
            // In parts of the depth, so that what is far does not count more.
            let offset: [f64; 3] = std::array::from_fn(|k| (z_q * at_q[k] - z_p * at_p[k]) * 2.0 / (z_p + z_q));
            let row: Rays = std::array::from_fn(|i| offset[i / 3] * n[i % 3]);
            planes.apart.iter_mut().zip(row).for_each(|(sums, x)| add(sums, row.map(|y| x * y)));
            planes.between.iter_mut().zip(offset).for_each(|(sums, x)| add(sums, offset.map(|y| x * y)));
            planes.seen.push((n, at_p));
        }
        planes
    }

    fn rays(&self, &Guess([right, up, forward], slope): &Guess) -> Rays {
        let scaled = |v: [f64; 3], s: f64| v.map(|x| x * s);
        let rays = [forward, scaled(right, slope), scaled(up, slope * self.aspect)];
        std::array::from_fn(|i| rays[i / 3][i % 3])
    }

    fn times(&self, rays: &Rays) -> Rays {
        std::array::from_fn(|i| self.apart[i].iter().zip(rays).map(|(m, x)| m * x).sum())
    }

    /// The squared distances from the planes over those between the points.
    fn residual(&self, guess: &Guess) -> f64 {
        let rays = self.rays(guess);
        let apart = inner(&rays, &self.times(&rays));
        let ray = |k: usize| [rays[3 * k], rays[3 * k + 1], rays[3 * k + 2]];
        let pairs = (0..3).flat_map(|k| (0..3).map(move |l| (k, l)));
        apart / pairs.map(|(k, l)| self.between[k][l] * dot(ray(k), ray(l))).sum::<f64>().max(1e-300)
    }

    /// The part of the surfaces whose normals point towards the camera.
    fn facing(&self, guess: &Guess) -> f64 {
        let rays = self.rays(guess);
        let towards =
            |(n, at): &&([f64; 3], [f64; 3])| (0..9).map(|i| rays[i] * at[i / 3] * n[i % 3]).sum::<f64>() < 0.0;
        self.seen.iter().filter(towards).count() as f64 / self.seen.len().max(1) as f64
    }

    /// Turns and zooms a guess for as long as that leaves less.
    fn refine(&self, mut guess: Guess) -> Guess {
        let mut damping = 1e-2;
        for _ in 0..60 {
            let rays = self.rays(&guess);
            let parts = |k: usize| [rays[3 * k], rays[3 * k + 1], rays[3 * k + 2]];
            // By a turn about each axis, and by a zoom.
            let slopes: [Rays; 4] = std::array::from_fn(|k| match k {
                3 => std::array::from_fn(|i| if i < 3 { 0.0 } else { rays[i] }),
                _ => std::array::from_fn(|i| turned(k, parts(i / 3))[i % 3]),
            });
            let push = self.times(&rays);
            let curved = slopes.map(|slope| self.times(&slope));
            let equations: [[f64; 5]; 4] = std::array::from_fn(|i| {
                std::array::from_fn(|j| match j {
                    4 => -inner(&slopes[i], &push),
                    _ => inner(&slopes[i], &curved[j]) * if i == j { 1.0 + damping } else { 1.0 },
                })
            });
            let Some([x, y, z, zoom]) = solve(equations) else { break };
            let Guess(axes, slope) = guess;
            let next = Guess(right_angled(axes.map(|a| moved(a, [x, y, z]))), slope * zoom.clamp(-1.0, 1.0).exp());
            if self.residual(&next) < self.residual(&guess) {
                (guess, damping) = (next, damping / 4.0);
            } else {
                damping *= 4.0;
            }
        }
        guess
    }
}

/// Cameras along and between all axes: the fit goes downhill from them.
fn starts() -> impl Iterator<Item = Guess> {
    let axes = (0..6).map(|i| {
        let mut axis = [0.0; 3];
        axis[i / 2] = if i % 2 == 0 { 1.0 } else { -1.0 };
        axis
    });
    let pairs = axes.clone().flat_map(move |right| axes.clone().map(move |up| (right, up)));
    let square = pairs.filter(|(right, up)| dot(*right, *up) == 0.0);
    square.flat_map(|(right, up)| {
        let axes = [right, up, cross(up, right)];
        [axes, right_angled(axes.map(|a| moved(a, [0.5, 0.5, 0.5])))].map(|axes| Guess(axes, 0.5))
    })
}

/// 1, and where a pixel is in the image: −1…1, y up.
fn point(i: usize, width: usize, height: usize) -> [f64; 3] {
    let (x, y) = ((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
    [1.0, 2.0 * x / width as f64 - 1.0, 1.0 - 2.0 * y / height as f64]
}

/// Whether three pixels in a row are of one plane: one normal, and 1/z is linear in the image.
fn is_plane([p, m, q]: [usize; 3], normal: &impl Fn(usize) -> [f64; 3], depths: &[f32]) -> bool {
    let z = [p, m, q].map(|i| f64::from(depths[i]));
    let n = normal(p);
    let alike = |i: usize| dot(n, normal(i)) > 0.9995;
    let hit = z.iter().all(|z| *z > 0.0 && *z < 1e9) && (dot(n, n) - 1.0).abs() < 0.01;
    hit && alike(m) && alike(q) && (z[1] * (0.5 / z[0] + 0.5 / z[2]) - 1.0).abs() < 1e-3
}

fn add<const N: usize>(sums: &mut [f64; N], terms: [f64; N]) {
    sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
}

fn inner(a: &Rays, b: &Rays) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// How a vector changes with a turn about an axis.
fn turned(axis: usize, v: [f64; 3]) -> [f64; 3] {
    let mut about = [0.0; 3];
    about[axis] = 1.0;
    cross(about, v)
}

/// A vector turned a little.
fn moved(v: [f64; 3], by: [f64; 3]) -> [f64; 3] {
    let turn = cross(by, v);
    std::array::from_fn(|i| v[i] + turn[i])
}

/// Right and up at right angles, of length 1, and forward so that the handedness is as in the starts.
fn right_angled([right, up, _]: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let unit = |v: [f64; 3]| v.map(|x| x / dot(v, v).sqrt());
    let right = unit(right);
    let along = dot(right, up);
    let up = unit(std::array::from_fn(|i| up[i] - along * right[i]));
    [right, up, cross(up, right)]
}

/// Solves four linear equations by elimination; `None` if they are not independent.
fn solve(mut rows: [[f64; 5]; 4]) -> Option<[f64; 4]> {
    for pivot in 0..4 {
        let largest = (pivot..4).max_by(|&a, &b| rows[a][pivot].abs().total_cmp(&rows[b][pivot].abs()))?;
        rows.swap(pivot, largest);
        let leading = rows[pivot];
        if leading[pivot].abs() < 1e-12 {
            return None;
        }
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != pivot) {
            let factor = row[pivot] / leading[pivot];
            row.iter_mut().zip(leading).for_each(|(x, y)| *x -= factor * y);
        }
    }
    Some(std::array::from_fn(|i| rows[i][4] / rows[i][i]))
}
