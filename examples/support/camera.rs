//! The camera of a frame on disk, in `manifest.json` beside the frames.

use asvgf::{Matrices, Viewpoint};
use serde_json::{Value, json};

/// A perspective camera: the ray of an image point (x, y), −1…1, y up, is `forward + x·slope·right + y·slope·(h/w)·up`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub eye: [f64; 3],
    /// Unit vectors, at right angles.
    pub forward: [f64; 3],
    pub right: [f64; 3],
    pub up: [f64; 3],
    /// Tangent of half the horizontal field of view.
    pub slope: f64,
    /// Of the rays within their pixels, from the centre, x right, y down.
    pub jitter: [f64; 2],
}

impl Camera {
    /// At the origin, with a vertical field of view in radians, along −Z with +Y up.
    pub fn at_rest(fov_y: f64, [width, height]: [u32; 2]) -> Self {
        let slope = (fov_y / 2.0).tan() * f64::from(width) / f64::from(height);
        let [right, up, forward] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];
        Self { eye: [0.0; 3], forward, right, up, slope, jitter: [0.0; 2] }
    }

    /// From `{"o", "fw", "r", "up", "th", "jitter"}`: eye, directions, slope; the jitter may be left out. The error names the key.
    pub fn from_json(value: &Value) -> Result<Self, String> {
        let vector = |key: &str| numbers(&value[key]).ok_or_else(|| format!("{key} must be three numbers"));
        let slope = value["th"].as_f64().filter(|th| *th > 0.0).ok_or("th must be a number above 0")?;
        let jitter = match &value["jitter"] {
            Value::Null => [0.0; 2],
            given => numbers(given).ok_or("jitter must be two numbers")?,
        };
        let [eye, forward, right, up] = [vector("o")?, vector("fw")?, vector("r")?, vector("up")?];
        Ok(Self { eye, forward, right, up, slope, jitter })
    }

    pub fn to_json(self) -> Value {
        let Self { eye, forward, right, up, slope, jitter } = self;
        json!({ "o": eye, "fw": forward, "r": right, "up": up, "th": slope, "jitter": jitter })
    }

    /// The same for the denoiser.
    pub fn viewpoint(&self, [width, height]: [u32; 2]) -> Viewpoint {
        let rows = [self.right, self.up, self.forward];
        let column = |axis: usize| [rows[0][axis], rows[1][axis], rows[2][axis], 0.0].map(|x| x as f32);
        let [x, y, z] = rows.map(|row| -dot(row, self.eye) as f32);
        let scale = [1.0 / self.slope, f64::from(width) / (f64::from(height) * self.slope)].map(|s| s as f32);
        let projection =
            [[scale[0], 0.0, 0.0, 0.0], [0.0, scale[1], 0.0, 0.0], [0.0, 0.0, 1.0, 1.0], [0.0, 0.0, -1.0, 0.0]];
        let view = [column(0), column(1), column(2), [x, y, z, 1.0]];
        Matrices { view, projection, jitter: self.jitter.map(|j| j as f32) }.into()
    }

    /// Along the ray of a pixel, as far as one unit along the view axis.
    pub fn ray(&self, pixel: [u32; 2], [width, height]: [u32; 2]) -> [f64; 3] {
        let at = |axis: usize| f64::from(pixel[axis]) + 0.5 + self.jitter[axis];
        let (width, height) = (f64::from(width), f64::from(height));
        let x = (2.0 * at(0) / width - 1.0) * self.slope;
        let y = (1.0 - 2.0 * at(1) / height) * self.slope * height / width;
        std::array::from_fn(|i| self.forward[i] + x * self.right[i] + y * self.up[i])
    }

    /// How far a point at rest, seen in this pixel at this depth, was from there in another camera's image: x right, y down.
    /// NaN where it was behind that camera.
    pub fn motion_to(&self, before: &Self, pixel: [u32; 2], depth: f64, [width, height]: [u32; 2]) -> [f64; 2] {
        let ray = self.ray(pixel, [width, height]);
        let point: [f64; 3] = std::array::from_fn(|i| self.eye[i] + depth * ray[i] - before.eye[i]);
        let z = dot(point, before.forward);
        if z <= 0.0 {
            return [f64::NAN; 2];
        }
        let (width, height) = (f64::from(width), f64::from(height));
        let x = dot(point, before.right) / (z * before.slope);
        let y = dot(point, before.up) / (z * before.slope) * width / height;
        let then = [(x + 1.0) * width / 2.0, (1.0 - y) * height / 2.0];
        // Without either frame's jitter.
        std::array::from_fn(|i| then[i] - f64::from(pixel[i]) - 0.5 - self.jitter[i])
    }
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn numbers<const N: usize>(value: &Value) -> Option<[f64; N]> {
    let list: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
    list?.try_into().ok()
}
