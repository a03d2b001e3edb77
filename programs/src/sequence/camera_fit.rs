//! Fit of a camera to normals and depths, for files without any camera.
//!
//! The pixel at the image point (x, y) sees, at depth z and relative to the eye, the point z·(c + x·a + y·b) in a
//! perspective, and z·c + x·a + y·b in an orthographic view. Two points p and q of a plane with the normal n satisfy
//! n·(p − q) = 0. The fit minimizes the sum of the squares of that over many pairs (Levenberg 1944). Its unknowns are
//! four numbers: the camera's directions and its field of view. It uses only normals and depths, so the camera is in
//! the normals' own space, and its position remains unknown. If no plane determines a direction, any is as good as
//! another. If no plane determines the field of view, it is reported as undetermined: a plane seen squarely, for
//! example, does not.

use crate::sequence::camera::{Camera, Lens, Raster, dot};

/// Approximate number of pixels of an image to use.
const PIXELS: usize = 30_000;

/// Fewest pairs to trust.
const ENOUGH: usize = 200;

/// Largest part of the squared distances between the points that may remain as squared distances from their planes.
pub const RESIDUAL: f64 = 1e-3;

/// Part of the surfaces that must face the camera.
const FACING: f64 = 0.98;

/// Squared distance from the planes that a zoom by a factor e must add, over that between the points, for the field of
/// view to be determined.
const DETERMINED: f64 = 1e-3;

/// Ratio of slanted pairs on planes, orthographic to perspective, above which a view is orthographic.
const FLATTER: f64 = 1.3;

/// Difference of two depths, in parts of them, from which on a pair is slanted: four times a plane's tolerance.
const SLANTED: f64 = 4e-3;

/// Tangents of half a field of view that a camera may have: 1° to 174°.
const SLOPES: std::ops::Range<f64> = 0.01..20.0;

/// Vertical field of view, in radians, for the derivation of the directions if it is undetermined.
const ASSUMED_FOV_Y: f64 = std::f64::consts::FRAC_PI_4;

/// Residual that counts as rounding.
const NOTHING: f64 = 1e-9;

/// Number of slopes in the search for that of distances along the rays.
const TRIED_SLOPES: i32 = 48;

/// The vectors c, a and b, nine numbers.
type Rays = [f64; 9];

/// A fitted camera.
#[derive(Clone, Copy, Debug)]
pub struct Fit {
    pub camera: Camera,
    /// True if the image determines the field of view.
    pub determined: bool,
    /// Squared distances from the planes over those between the points.
    residual: f64,
}

/// Data of a view before the fit.
#[derive(Clone, Copy)]
struct View {
    raster: Raster,
    orthographic: bool,
    /// Slope of a field of view that the fit must keep.
    slope: Option<f64>,
    /// Shift of the lens against the picture.
    shift: [f64; 2],
}

/// Conditions on the rays from pairs of points.
struct Planes {
    view: View,
    /// Squared distances from the planes, as a quadratic form.
    apart: [[f64; 9]; 9],
    /// Squared distances between the points, as a quadratic form.
    between: [[f64; 3]; 3],
    /// Normals, and their places in the image.
    seen: Vec<([f64; 3], [f64; 3])>,
    /// Number of pairs with different depths: a plane seen squarely is a plane in either kind of view.
    slanted: usize,
}

/// Directions to the right, up and forward, and the tangent of half the field of view.
#[derive(Clone, Copy)]
struct Guess([[f64; 3]; 3], f64);

/// Fits a camera to the normals and depths of an image; `None` if they do not determine one. Depths may be distances
/// along the rays. A given slope is kept.
pub fn fit(normals: &[f32], depths: &[f32], raster: Raster, along_ray: bool, slope: Option<f64>) -> Option<Fit> {
    let view = View { raster, orthographic: false, slope, shift: [0.0; 2] };
    if along_ray {
        return fit_distances(normals, depths, view);
    }
    let depths: Vec<f64> = depths.iter().map(|&z| z.into()).collect();
    let planes = Planes::new(normals, &depths, view);
    let parallel = Planes::new(normals, &depths, View { orthographic: true, slope: None, ..view });
    if parallel.slanted as f64 > FLATTER * planes.slanted as f64 {
        return parallel.fit().filter(|fit| fit.determined);
    }
    // If a zoom changes nothing, a guess drifts along it: a second fit then keeps the slope.
    planes.fit().filter(|fit| fit.determined || slope.is_some()).or_else(|| {
        let kept = Planes { view: View { slope: Some(raster.slope_of(ASSUMED_FOV_Y)), ..view }, ..planes };
        kept.fit().map(|fit| Fit { determined: false, ..fit })
    })
}

/// Returns how far surfaces are off their planes for a camera, as squared distances over those between the points. The
/// three values take the normals in the space of the camera's position, and in its own space, looking along −Z or +Z.
/// `None` if there are too few planes.
pub fn residuals(normals: &[f32], depths: &[f32], raster: Raster, camera: &Camera) -> Option<[f64; 3]> {
    let view =
        View { raster, orthographic: camera.is_orthographic(), slope: Some(camera.slope()), shift: camera.shift };
    let depths: Vec<f64> = depths.iter().map(|&z| z.into()).collect();
    let planes = Planes::new(normals, &depths, view);
    let own = |sign: f64| [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, sign]];
    let guesses = [[camera.right, camera.up, camera.forward], own(-1.0), own(1.0)];
    // A space in which surfaces face away is impossible.
    let residual = |axes| {
        let guess = Guess(axes, camera.slope());
        if planes.facing(&guess) >= FACING { planes.residual(&guess) } else { f64::MAX }
    };
    (planes.seen.len() >= ENOUGH).then(|| guesses.map(residual))
}

/// Fits a camera as [`fit`] does. Depths follow from distances and a field of view: the search takes the one with most
/// pairs on planes, and among its neighbours the one with the least residual.
fn fit_distances(normals: &[f32], distances: &[f32], view: View) -> Option<Fit> {
    let planes_with = |slope: f64| {
        let depth = |(i, &d): (usize, &f32)| {
            let pixel = [i as u32 % view.raster.size[0], i as u32 / view.raster.size[0]];
            f64::from(d) / Camera::looking(IDENTITY, Lens::Perspective(slope)).ray_length(pixel, view.raster)
        };
        let depths: Vec<f64> = distances.iter().enumerate().map(depth).collect();
        Planes::new(normals, &depths, View { slope: Some(slope), ..view })
    };
    if let Some(slope) = view.slope {
        return planes_with(slope).fit();
    }
    // 0.05…5, evenly in the logarithm.
    let slope_at = |step: f64| 0.05 * 100_f64.powf(step / f64::from(TRIED_SLOPES));
    let count = |step: f64| planes_with(slope_at(step)).seen.len();
    let best = (0..=TRIED_SLOPES).max_by_key(|&step| count(step.into()))?;
    let residual = |step: f64| planes_with(slope_at(step)).fit().map_or(f64::MAX, |fit| fit.residual);
    // The least residual lies between the neighbours of the best.
    let (mut low, mut high) = (f64::from(best) - 1.0, f64::from(best) + 1.0);
    for _ in 0..24 {
        let thirds = [low + (high - low) / 3.0, high - (high - low) / 3.0];
        if residual(thirds[0]) < residual(thirds[1]) { high = thirds[1] } else { low = thirds[0] }
    }
    let fit = planes_with(slope_at(0.5 * (low + high))).fit()?;
    // Other slopes have fewer pairs on planes; if they do not, the field of view is undetermined.
    let beside = count((best + 8).into()).max(count((best - 8).into()));
    Some(Fit { determined: 2 * beside < planes_with(fit.camera.slope()).seen.len(), ..fit })
}

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];

impl Planes {
    fn new(normals: &[f32], depths: &[f64], view: View) -> Self {
        let [width, height] = view.raster.size.map(|side| side as usize);
        let normal = |i: usize| [normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]].map(f64::from);
        let point = |i: usize| {
            let [x, y] = view.raster.point([(i % width) as f64 + 0.5, (i / width) as f64 + 0.5]);
            [1.0, x + view.shift[0], y + view.shift[1]]
        };
        let mut planes = Self { view, apart: [[0.0; 9]; 9], between: [[0.0; 3]; 3], seen: Vec::new(), slanted: 0 };
        // The span is wide enough to exceed the rounding of depths, and narrow enough to stay within one plane.
        let span = 2 * (width.min(height) / 36).max(4);
        // The step is odd, so that it visits all columns.
        let every = (width * height / PIXELS) | 1;
        for (p, step) in (0..width * height).step_by(every).flat_map(|p| [(p, 1), (p, width)]) {
            let within = if step == 1 { p % width + span < width } else { p / width + span < height };
            let q = p + span * step;
            if !within || !is_plane([p, p + span / 2 * step, q], &normal, depths, view.orthographic) {
                continue;
            }
            let n = normal(p);
            let [z_p, z_q] = [p, q].map(|i| depths[i]);
            let [at_p, at_q] = [p, q].map(point);
            // In parts of the depth, so that distant points do not count more.
            let offset: [f64; 3] = if view.orthographic {
                std::array::from_fn(|k| if k == 0 { z_q - z_p } else { at_q[k] - at_p[k] })
            } else {
                std::array::from_fn(|k| (z_q * at_q[k] - z_p * at_p[k]) * 2.0 / (z_p + z_q))
            };
            let row: Rays = std::array::from_fn(|i| offset[i / 3] * n[i % 3]);
            planes.apart.iter_mut().zip(row).for_each(|(sums, x)| add(sums, row.map(|y| x * y)));
            planes.between.iter_mut().zip(offset).for_each(|(sums, x)| add(sums, offset.map(|y| x * y)));
            planes.seen.push((n, at_p));
            planes.slanted += usize::from((z_q / z_p - 1.0).abs() > SLANTED);
        }
        planes
    }

    /// Returns the camera that fits best.
    fn fit(&self) -> Option<Fit> {
        let fitted = starts(self.view.slope.unwrap_or(0.5)).map(|guess| self.refine(guess));
        let fitting =
            fitted.flat_map(|Guess(axes, slope)| [axes, axes.map(|a| a.map(|x| -x))].map(|axes| Guess(axes, slope)));
        let fitting = fitting.filter(|guess| self.seen.len() >= ENOUGH && self.facing(guess) >= FACING);
        // Walls without a floor look the same in a mirror: an image that is not mirrored is likelier.
        let cost = |guess: &Guess| (self.residual(guess) + NOTHING) * if is_mirrored(guess) { 2.0 } else { 1.0 };
        let guess = fitting.min_by(|a, b| cost(a).total_cmp(&cost(b)))?;
        let residual = self.residual(&guess);
        let Guess(axes, slope) = guess;
        let lens = if self.view.orthographic { Lens::Orthographic(slope) } else { Lens::Perspective(slope) };
        let determined = self.zoom(&guess) >= DETERMINED;
        // If all rays coincide, all points lie on planes.
        let spreads = self.view.orthographic || SLOPES.contains(&slope);
        (residual <= RESIDUAL && spreads).then(|| Fit { camera: Camera::looking(axes, lens), determined, residual })
    }

    fn rays(&self, &Guess([right, up, forward], slope): &Guess) -> Rays {
        let scaled = |v: [f64; 3], s: f64| v.map(|x| x * s);
        let rays = [forward, scaled(right, slope), scaled(up, slope)];
        std::array::from_fn(|i| rays[i / 3][i % 3])
    }

    fn times(&self, rays: &Rays) -> Rays {
        std::array::from_fn(|i| self.apart[i].iter().zip(rays).map(|(m, x)| m * x).sum())
    }

    /// Returns the squared distances from the planes over those between the points.
    fn residual(&self, guess: &Guess) -> f64 {
        let rays = self.rays(guess);
        inner(&rays, &self.times(&rays)) / self.between(&rays)
    }

    /// Returns the squared distances between the points.
    fn between(&self, rays: &Rays) -> f64 {
        let ray = |k: usize| [rays[3 * k], rays[3 * k + 1], rays[3 * k + 2]];
        let pairs = (0..3).flat_map(|k| (0..3).map(move |l| (k, l)));
        pairs.map(|(k, l)| self.between[k][l] * dot(ray(k), ray(l))).sum::<f64>().max(1e-300)
    }

    /// Returns the part of the surfaces whose normals point towards the camera.
    fn facing(&self, guess: &Guess) -> f64 {
        let rays = self.rays(guess);
        // Rays of an orthographic view all point forward.
        let terms = if self.view.orthographic { 3 } else { 9 };
        let towards =
            |(n, at): &&([f64; 3], [f64; 3])| (0..terms).map(|i| rays[i] * at[i / 3] * n[i % 3]).sum::<f64>() < 0.0;
        self.seen.iter().filter(towards).count() as f64 / self.seen.len().max(1) as f64
    }

    /// Returns the derivatives of the rays by a turn about each axis, and by a zoom.
    fn slopes(&self, rays: &Rays) -> [Rays; 4] {
        let parts = |k: usize| [rays[3 * k], rays[3 * k + 1], rays[3 * k + 2]];
        std::array::from_fn(|k| match k {
            3 => std::array::from_fn(|i| if i < 3 { 0.0 } else { rays[i] }),
            _ => std::array::from_fn(|i| turned(k, parts(i / 3))[i % 3]),
        })
    }

    /// Returns the part of a zoom's squared distances from the planes that no turn compensates, over those between the
    /// points.
    fn zoom(&self, guess: &Guess) -> f64 {
        let rays = self.rays(guess);
        let slopes = self.slopes(&rays);
        let curved = slopes.map(|slope| self.times(&slope));
        let form = |i: usize, j: usize| inner(&slopes[i], &curved[j]);
        // A small term is added to the turns, because a turn that changes nothing has no inverse.
        let least = 1e-12 * (form(0, 0) + form(1, 1) + form(2, 2)) + 1e-300;
        let equations: [[f64; 5]; 4] = std::array::from_fn(|i| {
            std::array::from_fn(|j| match (i, j) {
                (3, 3) => 1.0,
                (3, _) | (_, 3) => 0.0,
                (_, 4) => form(i, 3),
                _ => form(i, j) + if i == j { least } else { 0.0 },
            })
        });
        let turns = solve(equations).unwrap_or_default();
        let zoom = form(3, 3) - (0..3).map(|i| turns[i] * form(i, 3)).sum::<f64>();
        zoom / self.between(&rays)
    }

    /// Turns and zooms a guess as long as the residual decreases.
    fn refine(&self, mut guess: Guess) -> Guess {
        let mut damping = 1e-2;
        for _ in 0..60 {
            let rays = self.rays(&guess);
            let slopes = self.slopes(&rays);
            let push = self.times(&rays);
            let curved = slopes.map(|slope| self.times(&slope));
            let kept = self.view.slope.is_some();
            // A turn that changes nothing, such as that about the normal of the only plane, is left alone.
            let least = 1e-9 * (0..4).map(|i| inner(&slopes[i], &curved[i])).sum::<f64>();
            let equations: [[f64; 5]; 4] = std::array::from_fn(|i| {
                std::array::from_fn(|j| match j {
                    _ if kept && (i == 3 || j == 3) => f64::from(u8::from(i == j)),
                    4 => -inner(&slopes[i], &push),
                    _ if i == j => inner(&slopes[i], &curved[j]) * (1.0 + damping) + least,
                    _ => inner(&slopes[i], &curved[j]),
                })
            });
            let Some([x, y, z, zoom]) = solve(equations) else { break };
            let Guess(axes, slope) = guess;
            let zoom = if kept { 0.0 } else { zoom.clamp(-1.0, 1.0) };
            let next = Guess(right_angled(axes.map(|a| moved(a, [x, y, z]))), slope * zoom.exp());
            if self.residual(&next) < self.residual(&guess) {
                (guess, damping) = (next, damping / 4.0);
            } else {
                damping *= 4.0;
            }
        }
        guess
    }
}

fn is_mirrored(&Guess([right, up, forward], _): &Guess) -> bool {
    dot(cross(right, up), forward) > 0.0
}

/// Returns cameras along and between all axes, from which the fit descends.
fn starts(slope: f64) -> impl Iterator<Item = Guess> {
    let axes = (0..6).map(|i| {
        let mut axis = [0.0; 3];
        axis[i / 2] = if i % 2 == 0 { 1.0 } else { -1.0 };
        axis
    });
    let pairs = axes.clone().flat_map(move |right| axes.clone().map(move |up| (right, up)));
    let square = pairs.filter(|(right, up)| dot(*right, *up) == 0.0);
    square.flat_map(move |(right, up)| {
        let axes = [right, up, cross(up, right)];
        [axes, right_angled(axes.map(|a| moved(a, [0.5, 0.5, 0.5])))].map(|axes| Guess(axes, slope))
    })
}

/// True if three pixels in a row belong to one plane: they have one normal, and 1/z is linear in the image, or z in an
/// orthographic view.
fn is_plane([p, m, q]: [usize; 3], normal: &impl Fn(usize) -> [f64; 3], depths: &[f64], orthographic: bool) -> bool {
    let z = [p, m, q].map(|i| depths[i]);
    let n = normal(p);
    let alike = |i: usize| dot(n, normal(i)) > 0.9995;
    let hit = z.iter().all(|z| *z > 0.0 && *z < 1e9) && (dot(n, n) - 1.0).abs() < 0.01;
    // The slope counts, so that a wall seen squarely favours neither.
    let off = if orthographic { 0.5 * (z[0] + z[2]) / z[1] - 1.0 } else { z[1] * (0.5 / z[0] + 0.5 / z[2]) - 1.0 };
    hit && alike(m) && alike(q) && off.abs() < 1e-3
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

/// Returns the derivative of a vector by a turn about an axis.
fn turned(axis: usize, v: [f64; 3]) -> [f64; 3] {
    let mut about = [0.0; 3];
    about[axis] = 1.0;
    cross(about, v)
}

/// Turns a vector by a small angle.
fn moved(v: [f64; 3], by: [f64; 3]) -> [f64; 3] {
    let turn = cross(by, v);
    std::array::from_fn(|i| v[i] + turn[i])
}

/// Makes right and up perpendicular and of length 1, and gives forward the handedness of the starts.
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
