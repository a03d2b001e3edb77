//! A camera as the shaders read it.

use super::vector::{dot, narrow, subtract};
use bytemuck::{Pod, Zeroable};

/// A camera for an image's size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlacedCamera {
    pub(super) eye: [f64; 3],
    /// The rest, its eye at 0.
    pub(super) rays: CameraUniform,
}

impl PlacedCamera {
    /// The camera in coordinates that count from `origin`, in a frame that is seen by `now`.
    pub fn uniform(&self, origin: [f64; 3], now: &Self) -> CameraUniform {
        // f32 has steps of 3 cm at 500 km: differences have to be taken before rounding.
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
    /// 1 for an orthographic view: then the ray's spread does not grow with depth.
    pub(super) orthographic: f32,
    pub(super) du: [f32; 3],
    pub(super) inverse_du: f32,
    pub(super) dv: [f32; 3],
    pub(super) inverse_dv: f32,
    /// The eye less that of this frame's camera.
    pub(super) offset: [f32; 3],
    // WGSL rounds a struct's size up to that of a vector.
    padding: f32,
}

impl CameraUniform {
    /// Which way, and the affine map from pixel to ray: corner, du, dv.
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
