//! A camera given by its matrices.

use super::placed::{CameraUniform, PlacedCamera};
use super::vector::{dot, scale, subtract};
use crate::Error;

/// A perspective or orthographic camera as renderers have it. A matrix is an array of columns, `m[column][row]`, as glam's
/// `to_cols_array_2d` returns it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrices {
    /// World space to view space: a rotation and a translation, without scale. Right- or left-handed.
    pub view: [[f32; 4]; 4],
    /// View space to clip space, x right and y up, **without** the jitter. Any depth range will do, reversed and infinite ones too,
    /// because depth is not read from it. It may be off-centre (shifted lenses, crops). An orthographic projection looks in the
    /// direction in which its depth grows; it counts as reversed if the eye itself has a depth above ½. Surfaces must lie in front of
    /// the eye, at depths above 0.
    pub projection: [[f32; 4]; 4],
    /// Offset of each pixel's ray from the pixel's centre, in pixels, −½…½, x right, y **down**. All pixels of a frame share it.
    pub jitter: [f32; 2],
}

impl Matrices {
    /// Matrices without jitter.
    pub fn new(view: [[f32; 4]; 4], projection: [[f32; 4]; 4]) -> Self {
        Self { view, projection, jitter: [0.0; 2] }
    }
}

impl Matrices {
    /// The affine map from pixel to ray, as `Camera::placed` has it.
    ///
    /// A point v of view space has the linear depth z = s·v_z, with s = ±1 by handedness, and the image point
    /// ndc = A·(v_xy/z) + s·(P₂₀, P₂₁). Here A is the upper left 2×2 of the projection P, divided by |P₂₃|. Solved for v_xy/z and turned
    /// into world space, this gives the ray of an image point, affine in the point. In an orthographic view, divided by P₃₃,
    /// ndc = A·v_xy + (P₃₀, P₃₁): there the origin of the ray is affine in the image point, instead of its direction.
    pub(super) fn placed(&self, size: [u32; 2]) -> Result<PlacedCamera, Error> {
        let wrong = |element, reason| Err(Error::Camera { element, reason });
        let finite = |m: &[[f32; 4]; 4]| m.iter().flatten().all(|x| x.is_finite());
        if !finite(&self.view) || self.view.map(|c| c[3]) != [0.0, 0.0, 0.0, 1.0] {
            return wrong("view", "is not an affine matrix of finite numbers: its last row must be 0 0 0 1");
        }
        if !finite(&self.projection) {
            return wrong("projection", "is not finite");
        }
        if !self.jitter.iter().all(|x| x.is_finite()) {
            return wrong("jitter", "is not finite");
        }
        let [x, y, z, translation] = self.view.map(|c| [c[0], c[1], c[2]].map(f64::from));
        let products = [dot(x, x) - 1.0, dot(y, y) - 1.0, dot(z, z) - 1.0, dot(x, y), dot(y, z), dot(z, x)];
        if products.iter().any(|p| p.abs() > 1e-3) {
            return wrong(
                "view",
                "is not a rotation and a translation: depth is measured in the world's unit, so it may not scale",
            );
        }
        let p = self.projection.map(|c| c.map(f64::from));
        let along = p[2][3].abs();
        let orthographic = along == 0.0 && p[3][3].abs() >= 1e-30;
        if p[0][3] != 0.0 || p[1][3] != 0.0 || (p[3][3] != 0.0 && !orthographic) || (along < 1e-30 && !orthographic) {
            return wrong(
                "projection",
                "is neither a perspective one, with a last row of 0 0 ±1 0, nor an orthographic one, with 0 0 0 1",
            );
        }
        let p = p.map(|c| c.map(|e| e / if orthographic { p[3][3] } else { along }));
        let side = if orthographic {
            // Depth grows away from the eye, unless it is reversed.
            if p[2][2] == 0.0 {
                return wrong("projection", "is orthographic and has no depth: which way it looks is unknown");
            }
            if p[3][2] > 0.5 { -p[2][2].signum() } else { p[2][2].signum() }
        } else {
            p[2][3].signum()
        };
        // The image point of the middle of the view.
        let middle = if orthographic { [p[3][0], p[3][1]] } else { [side * p[2][0], side * p[2][1]] };
        let determinant = p[0][0] * p[1][1] - p[1][0] * p[0][1];
        let other = if orthographic { [p[2][0], p[2][1]] } else { [p[3][0], p[3][1]] };
        if determinant.abs() < 1e-12 || other != [0.0; 2] {
            return wrong("projection", "does not map directions to image points one to one");
        }
        // v_xy/z, or v_xy, of a point of the image plane, −1…1.
        let slope = |x: f64, y: f64| {
            let (x, y) = (x - middle[0], y - middle[1]);
            [(p[1][1] * x - p[1][0] * y) / determinant, (p[0][0] * y - p[0][1] * x) / determinant]
        };
        // View to world: the transpose of the rotation.
        let world = |v: [f64; 3]| [dot(x, v), dot(y, v), dot(z, v)];
        let ray = |[x, y]: [f64; 2]| world([x, y, side]);
        let corner = ray(slope(-1.0, 1.0));
        let du = scale(subtract(ray(slope(1.0, 1.0)), corner), 1.0 / f64::from(size[0]));
        let dv = scale(subtract(ray(slope(-1.0, -1.0)), corner), 1.0 / f64::from(size[1]));
        if dot(du, dv).abs() > 1e-4 * (dot(du, du) * dot(dv, dv)).sqrt() {
            return wrong("projection", "shears the image");
        }
        let eye = scale(world(translation), -1.0);
        let rays = CameraUniform::new(world([0.0, 0.0, side]), [corner, du, dv], self.jitter);
        Ok(PlacedCamera { eye, rays: CameraUniform { orthographic: f32::from(u8::from(orthographic)), ..rays } })
    }
}
