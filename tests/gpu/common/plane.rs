//! A camera and planes in f64: an independent computation of the expected image.

use asvgf::Camera;

pub type V = [f64; 3];

pub fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn scale(a: V, s: f64) -> V {
    a.map(|x| x * s)
}

pub fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn length(a: V) -> f64 {
    dot(a, a).sqrt()
}

pub fn unit(a: V) -> V {
    scale(a, 1.0 / length(a))
}

/// A pinhole camera by angles: pixel (x, y) of an image of `size` has tan-space coordinates in units of the half height.
pub struct Pinhole {
    pub eye: V,
    right: V,
    up: V,
    forward: V,
    half: f64,
    size: [f64; 2],
}

impl Pinhole {
    pub fn new(camera: &Camera, size: [u32; 2]) -> Self {
        let eye = camera.eye;
        let forward = unit(sub(camera.target, eye));
        let right = unit(cross(forward, camera.up.map(f64::from)));
        let up = cross(right, forward);
        Self { eye, right, up, forward, half: (f64::from(camera.fov_y) / 2.0).tan(), size: size.map(f64::from) }
    }

    /// Direction through an image point in pixels, with unit depth.
    pub fn ray(&self, x: f64, y: f64) -> V {
        let across = (2.0 * x - self.size[0]) / self.size[1] * self.half;
        let up = (self.size[1] - 2.0 * y) / self.size[1] * self.half;
        add(self.forward, add(scale(self.right, across), scale(self.up, up)))
    }

    /// Image point in pixels, and depth.
    pub fn project(&self, point: V) -> V {
        let offset = sub(point, self.eye);
        let depth = dot(offset, self.forward);
        let across = dot(offset, self.right) / depth / self.half;
        let up = dot(offset, self.up) / depth / self.half;
        [(across * self.size[1] + self.size[0]) / 2.0, (1.0 - up) * self.size[1] / 2.0, depth]
    }
}
