//! A camera given by its place and target.

use super::placed::{CameraUniform, PlacedCamera};
use super::vector::{cross, normalize, scale, subtract};
use crate::Error;

/// A perspective camera in a right-handed world. Depth is linear, along the view. Pixels count from the upper left corner, x right,
/// y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position, in double precision so that the camera moves smoothly however far it is from the origin.
    pub eye: [f64; 3],
    /// A point that the camera looks at, other than `eye`.
    pub target: [f64; 3],
    /// The direction that points up in the image, not along the view.
    pub up: [f32; 3],
    /// Vertical field of view in radians, 0 < fov < π.
    pub fov_y: f32,
    /// Offset of each pixel's ray from the pixel's centre, in pixels, −½…½, x right, y down. All pixels of a frame share it.
    pub jitter: [f32; 2],
}

impl Default for Camera {
    fn default() -> Self {
        Self { eye: [0.0; 3], target: [0.0, 0.0, -1.0], up: [0.0, 1.0, 0.0], fov_y: 0.8, jitter: [0.0; 2] }
    }
}

impl Camera {
    /// The affine map from pixel to ray: direction = corner + x·du + y·dv, with unit component along `forward`. It is computed in f64, so
    /// that the f32 results are as good as they can be for very narrow and very wide views.
    pub(super) fn placed(&self, size: [u32; 2]) -> Result<PlacedCamera, Error> {
        let wrong = |element, reason| Err(Error::Camera { element, reason });
        let finite = |v: &[f32]| v.iter().all(|x| x.is_finite());
        // Beyond the range of f32, a number is infinite in shaders.
        let in_range = |v: [f64; 3]| v.iter().all(|x| x.abs() <= f64::from(f32::MAX));
        if !in_range(self.eye) {
            return wrong("eye", "is not finite");
        }
        if !in_range(self.target) || !finite(&self.up) {
            return wrong("target or up", "is not finite");
        }
        if !(self.fov_y > 0.0 && self.fov_y < std::f32::consts::PI) {
            return wrong("fov_y", "must be between 0 and π, in radians");
        }
        if !finite(&self.jitter) {
            return wrong("jitter", "is not finite");
        }
        let Some(forward) = normalize(subtract(self.target, self.eye)) else {
            return wrong("target", "must differ from the eye");
        };
        let Some(right) = normalize(cross(forward, self.up.map(f64::from))) else {
            return wrong("up", "must not point along the view");
        };
        let up = cross(right, forward);
        let pixel = 2.0 * (f64::from(self.fov_y) / 2.0).tan() / f64::from(size[1]);
        let half = [f64::from(size[0]) / 2.0, f64::from(size[1]) / 2.0];
        let (du, dv) = (scale(right, pixel), scale(up, -pixel));
        let corner = subtract(subtract(forward, scale(du, half[0])), scale(dv, half[1]));
        Ok(PlacedCamera { eye: self.eye, rays: CameraUniform::new(forward, [corner, du, dv], self.jitter) })
    }
}
