//! Camera from the attributes that a renderer wrote into a file.
//!
//! `worldToCamera` and `worldToNDC` are matrices for row vectors, p' = p·M, as Arnold, pbrt and RenderMan write them.
//! Programs differ in the signs and the ranges of camera space and of the picture's coordinates, but all have y up in
//! camera space; the rest follows from the matrices themselves.

use crate::sequence::camera::{Camera, Lens, Raster, dot};
use asvgf::image_io::{Attribute, ExrFile};

type Matrix = [[f64; 4]; 4];

/// Returns the camera of a file, if its attributes describe one.
pub fn of(file: &ExrFile, raster: Raster) -> Option<Camera> {
    let matrix = |name: &str| match file.attribute(name) {
        Some(Attribute::Matrix(m)) if m.iter().flatten().all(|x| x.is_finite()) => Some(m),
        _ => None,
    };
    let number = |name: &str| match file.attribute(name) {
        Some(Attribute::Number(x)) if x.is_finite() && x > 0.0 => Some(x),
        _ => None,
    };
    let world_to_camera = matrix("worldToCamera")?;
    if let Some(world_to_ndc) = matrix("worldToNDC") {
        return from_matrices(&world_to_camera, &world_to_ndc, raster);
    }
    // Degrees, as in the standard.
    let horizontal = number("fieldOfViewHorizontal").map(|degrees| (degrees.to_radians() / 2.0).tan());
    let vertical = number("fieldOfViewVertical").map(|degrees| raster.slope_of(degrees.to_radians()));
    // Programs that do not know the width write 1.
    let window = number("screenWindowWidth").filter(|width| *width != 1.0).map(|width| width / 2.0);
    let slope = horizontal.or(vertical).or(window)?;
    // The camera looks along −Z, as in OpenEXR's own documents and in Arnold.
    axes(&world_to_camera, -1.0)
        .map(|(eye, directions)| Camera { eye, ..Camera::looking(directions, Lens::Perspective(slope)) })
}

/// Returns the eye of a matrix without scale, and the directions to the right, up and forward.
fn axes(m: &Matrix, forward: f64) -> Option<([f64; 3], [[f64; 3]; 3])> {
    let column = |c: usize| [m[0][c], m[1][c], m[2][c]];
    let [x, y, z] = [column(0), column(1), column(2)];
    let unit = |v: [f64; 3]| (dot(v, v).sqrt() - 1.0).abs() < 1e-3;
    let square = [dot(x, y), dot(y, z), dot(z, x)].iter().all(|d| d.abs() < 1e-3);
    if !(unit(x) && unit(y) && unit(z) && square) {
        return None;
    }
    // p·M = 0: the eye is −t·Rᵀ.
    let eye = std::array::from_fn(|i| -(m[3][0] * x[i] + m[3][1] * y[i] + m[3][2] * z[i]));
    Some((eye, [x, y, z.map(|a| a * forward)]))
}

/// Derives the camera from the images, under the picture's matrix, of points in front of it.
fn from_matrices(world_to_camera: &Matrix, world_to_ndc: &Matrix, raster: Raster) -> Option<Camera> {
    let orthographic = (0..3).all(|row| world_to_ndc[row][3].abs() < 1e-9);
    [-1.0, 1.0].into_iter().find_map(|sign| {
        let (eye, [right, up, forward]) = axes(world_to_camera, sign)?;
        let at = |u: f64, v: f64| {
            let p: [f64; 3] = std::array::from_fn(|i| eye[i] + forward[i] + u * right[i] + v * up[i]);
            let clip = |c: usize| {
                p[0] * world_to_ndc[0][c] + p[1] * world_to_ndc[1][c] + p[2] * world_to_ndc[2][c] + world_to_ndc[3][c]
            };
            (clip(3) > 0.0).then(|| [clip(0) / clip(3), clip(1) / clip(3), clip(2) / clip(3)])
        };
        let (middle, side, above) = (at(0.0, 0.0)?, at(1.0, 0.0)?, at(0.0, 1.0)?);
        // In a parallel view, the depth grows along the view direction.
        let before: f64 = (0..3).map(|i| eye[i] * world_to_ndc[i][2]).sum::<f64>() + world_to_ndc[3][2];
        if orthographic && middle[2] < before {
            return None;
        }
        // The picture spans −1…1, unless its middle is nearer to that of 0…1.
        let from_zero = middle[0] > 0.25 && middle[1].abs() > 0.25;
        let (dx, dy) = ((side[0] - middle[0]).abs(), (above[1] - middle[1]).abs());
        let range = if from_zero { 1.0 } else { 2.0 };
        let slope = range / 2.0 / dx;
        // Some programs scale both axes by the width, or pad the picture's window.
        let vertical = range / 2.0 / dy;
        let plausible = slope.is_finite() && slope > 0.0 && vertical.is_finite();
        let lens = if orthographic { Lens::Orthographic(slope) } else { Lens::Perspective(slope) };
        let centre = if from_zero { 0.5 } else { 0.0 };
        // Offset of the picture's middle from the axis, in halves of its width.
        let shift = [-(middle[0] - centre) * 2.0 / range * (side[0] - middle[0]).signum(), {
            let up = (middle[1] - centre) * 2.0 / range * (above[1] - middle[1]).signum();
            -up * vertical / slope
        }];
        let shift = shift.map(|s| if s.abs() < 1e-4 { 0.0 } else { s });
        let directions = [right.map(|x| x * (side[0] - middle[0]).signum()), up, forward];
        let fits = (vertical / slope / raster.height_over_width() - 1.0).abs() < 0.02;
        (plausible && fits).then_some(Camera { eye, shift, ..Camera::looking(directions, lens) })
    })
}
