//! A camera as the shaders read it.

use super::vector::{dot, narrow, subtract};
use bytemuck::{Pod, Zeroable};

/// A camera for an image of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlacedCamera {
    pub(super) eye: [f64; 3],
    /// All the rest, with the eye at 0.
    pub(super) rays: CameraUniform,
}

impl PlacedCamera {
    /// The uniform in coordinates relative to `origin`, for a frame whose own camera is `now`.
    pub fn uniform(&self, origin: [f64; 3], now: &Self) -> CameraUniform {
        // f32 has steps of 3 cm at 500 km, so differences are taken before rounding.
        CameraUniform {
            eye: narrow(subtract(self.eye, origin)),
            offset: narrow(subtract(self.eye, now.eye)),
            ..self.rays
        }
    }
}

/// `Camera` of shaders/shared/frame.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct CameraUniform {
    pub(super) eye: [f32; 3],
    pub(super) jitter_x: f32,
    pub(super) forward: [f32; 3],
    pub(super) jitter_y: f32,
    pub(super) corner: [f32; 3],
    /// 1 for an orthographic view, in which the spread of a ray does not grow with depth.
    pub(super) orthographic: f32,
    pub(super) du: [f32; 3],
    pub(super) inverse_du: f32,
    pub(super) dv: [f32; 3],
    pub(super) inverse_dv: f32,
    /// This eye minus the eye of the frame's own camera.
    pub(super) offset: [f32; 3],
    // WGSL rounds the size of a struct up to that of a vector.
    pub(super) padding: f32,
}

impl CameraUniform {
    /// The rays from a direction of view and the affine map from pixel to ray: corner, du, dv.
    pub(super) fn new(forward: [f64; 3], [corner, du, dv]: [[f64; 3]; 3], jitter: [f32; 2]) -> Self {
        Self {
            eye: [0.0; 3],
            jitter_x: jitter[0],
            forward: narrow(forward),
            jitter_y: jitter[1],
            corner: narrow(corner),
            orthographic: 0.0,
            du: narrow(du),
            inverse_du: (1.0 / dot(du, du)) as f32,
            dv: narrow(dv),
            inverse_dv: (1.0 / dot(dv, dv)) as f32,
            offset: [0.0; 3],
            padding: 0.0,
        }
    }
}
