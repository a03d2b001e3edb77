//! The camera of a frame on disk, in `manifest.json` beside the frames.

use asvgf::{Matrices, Viewpoint};
use serde_json::{Value, json};

/// Lens: the directions of the rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Rays from one point: the tangent of half the horizontal field of view.
    Perspective(f64),
    /// Rays along one direction: half the picture's width in the world.
    Orthographic(f64),
}

/// A camera. The formulas give the point of a pixel at the depth z. The pixel is at the picture's point (x, y), −1…1, y
/// up; s is the lens's number, and h/w the picture's height over its width. With u = s·(x + shift₀) and v = s·(y·h/w +
/// shift₁), the point is `eye + z·(forward + u·right + v·up)` in a perspective, and `eye + z·forward + u·right + v·up`
/// in an orthographic view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub eye: [f64; 3],
    /// Unit vectors, at right angles.
    pub forward: [f64; 3],
    pub right: [f64; 3],
    pub up: [f64; 3],
    pub lens: Lens,
    /// Shift of the lens against the picture, in halves of the picture's width: right and up.
    pub shift: [f64; 2],
    /// Jitter of the rays within their pixels, from the centre, x right, y down.
    pub jitter: [f64; 2],
}

/// Place of an image's pixels in the picture that the camera takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Raster {
    /// Columns and rows of the image.
    pub size: [u32; 2],
    /// Column and row of the image's first pixel in the picture.
    pub offset: [i32; 2],
    /// Columns and rows of the picture.
    pub picture: [u32; 2],
    /// Width over height of a pixel.
    pub aspect: f64,
}

impl Raster {
    /// Returns the whole picture, of square pixels.
    pub fn whole(size: [u32; 2]) -> Self {
        Self { size, offset: [0; 2], picture: size, aspect: 1.0 }
    }

    /// Returns the picture's height over its width.
    pub fn height_over_width(self) -> f64 {
        f64::from(self.picture[1]) / (f64::from(self.picture[0]) * self.aspect)
    }

    /// Returns the tangent of half the horizontal field of view, given the vertical field of view in radians.
    pub fn slope_of(self, fov_y: f64) -> f64 {
        (fov_y / 2.0).tan() / self.height_over_width()
    }

    /// Converts a place in pixels to (x, y·h/w), −1…1 in x, y up.
    pub fn point(self, place: [f64; 2]) -> [f64; 2] {
        let [x, y] = [0, 1].map(|i| 2.0 * (place[i] + f64::from(self.offset[i])) / f64::from(self.picture[i]) - 1.0);
        [x, -y * self.height_over_width()]
    }

    /// Converts (x, y·h/w) to a place in pixels.
    pub fn place(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let point = [x, -y / self.height_over_width()];
        [0, 1].map(|i| (point[i] + 1.0) * f64::from(self.picture[i]) / 2.0 - f64::from(self.offset[i]))
    }
}

impl Camera {
    /// Returns a camera at the origin that looks along −Z with +Y up, with a vertical field of view in radians.
    pub fn at_rest(fov_y: f64, raster: Raster) -> Self {
        Self::looking([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]], Lens::Perspective(raster.slope_of(fov_y)))
    }

    /// Returns a camera at the origin, with directions to the right, up and forward.
    pub fn looking([right, up, forward]: [[f64; 3]; 3], lens: Lens) -> Self {
        Self { eye: [0.0; 3], forward, right, up, lens, shift: [0.0; 2], jitter: [0.0; 2] }
    }

    /// Reads `{"o", "fw", "r", "up", "th", "jitter", "shift"}`: eye, directions, slope; or "ortho" instead of "th".
    /// Jitter and shift are optional. The error names the key.
    pub fn from_json(value: &Value) -> Result<Self, String> {
        let vector = |key: &str| numbers(&value[key]).ok_or_else(|| format!("{key} must be three numbers"));
        let positive = |key: &str| value[key].as_f64().filter(|x| *x > 0.0 && x.is_finite());
        let lens = match (&value["th"], &value["ortho"]) {
            (Value::Null, given) if !given.is_null() => {
                Lens::Orthographic(positive("ortho").ok_or("ortho must be a number above 0")?)
            }
            _ => Lens::Perspective(positive("th").ok_or("th must be a number above 0")?),
        };
        let pair = |key: &str| match &value[key] {
            Value::Null => Ok([0.0; 2]),
            given => numbers(given).ok_or_else(|| format!("{key} must be two numbers")),
        };
        let (jitter, shift) = (pair("jitter")?, pair("shift")?);
        let [eye, forward, right, up] = [vector("o")?, vector("fw")?, vector("r")?, vector("up")?];
        Ok(Self { eye, forward, right, up, lens, shift, jitter })
    }

    pub fn to_json(self) -> Value {
        let Self { eye, forward, right, up, lens, shift, jitter } = self;
        let mut json = json!({ "o": eye, "fw": forward, "r": right, "up": up, "jitter": jitter });
        match lens {
            Lens::Perspective(slope) => json["th"] = slope.into(),
            Lens::Orthographic(half_width) => json["ortho"] = half_width.into(),
        }
        if shift != [0.0; 2] {
            json["shift"] = json!(shift);
        }
        json
    }

    /// Returns the number of the lens.
    pub fn slope(&self) -> f64 {
        match self.lens {
            Lens::Perspective(slope) => slope,
            Lens::Orthographic(half_width) => half_width,
        }
    }

    pub fn is_orthographic(&self) -> bool {
        matches!(self.lens, Lens::Orthographic(_))
    }

    /// Returns the camera with another number of the lens.
    pub fn with_slope(self, slope: f64) -> Self {
        let lens = match self.lens {
            Lens::Perspective(_) => Lens::Perspective(slope),
            Lens::Orthographic(_) => Lens::Orthographic(slope),
        };
        Self { lens, ..self }
    }

    /// Converts the camera for the denoiser.
    pub fn viewpoint(&self, raster: Raster) -> Viewpoint {
        let rows = [self.right, self.up, self.forward];
        let column = |axis: usize| [rows[0][axis], rows[1][axis], rows[2][axis], 0.0].map(|x| x as f32);
        let [x, y, z] = rows.map(|row| -dot(row, self.eye) as f32);
        let view = [column(0), column(1), column(2), [x, y, z, 1.0]];
        // u and v at the borders of the image.
        let [left, top] = self.lateral([0.0; 2], raster);
        let [right, bottom] = self.lateral(raster.size.map(f64::from), raster);
        let scale = [2.0 / (right - left), 2.0 / (top - bottom)];
        let middle = [-(right + left) / (right - left), -(top + bottom) / (top - bottom)];
        let [sx, sy, mx, my] = [scale[0], scale[1], middle[0], middle[1]].map(|x| x as f32);
        let projection = match self.lens {
            Lens::Perspective(_) => {
                [[sx, 0.0, 0.0, 0.0], [0.0, sy, 0.0, 0.0], [mx, my, 1.0, 1.0], [0.0, 0.0, -1.0, 0.0]]
            }
            Lens::Orthographic(_) => {
                [[sx, 0.0, 0.0, 0.0], [0.0, sy, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [mx, my, 0.0, 1.0]]
            }
        };
        Matrices { view, projection, jitter: self.jitter.map(|j| j as f32) }.into()
    }

    /// Returns u and v of a place in pixels.
    fn lateral(&self, place: [f64; 2], raster: Raster) -> [f64; 2] {
        let point = raster.point(place);
        [0, 1].map(|i| self.slope() * (point[i] + self.shift[i]))
    }

    fn sampled(&self, pixel: [u32; 2], raster: Raster) -> [f64; 2] {
        self.lateral([0, 1].map(|i| f64::from(pixel[i]) + 0.5 + self.jitter[i]), raster)
    }

    /// Returns the point that a pixel sees at a depth.
    pub fn position(&self, pixel: [u32; 2], depth: f64, raster: Raster) -> [f64; 3] {
        let [u, v] = self.sampled(pixel, raster);
        let spread = if self.is_orthographic() { 1.0 } else { depth };
        std::array::from_fn(|i| self.eye[i] + depth * self.forward[i] + spread * (u * self.right[i] + v * self.up[i]))
    }

    /// Returns the distance along a pixel's ray in which the depth grows by one.
    pub fn ray_length(&self, pixel: [u32; 2], raster: Raster) -> f64 {
        let [u, v] = self.sampled(pixel, raster);
        if self.is_orthographic() { 1.0 } else { (1.0 + u * u + v * v).sqrt() }
    }

    /// Returns a point's place in pixels, and its depth. The place is NaN if the point is behind a perspective camera.
    pub fn project(&self, point: [f64; 3], raster: Raster) -> ([f64; 2], f64) {
        let offset: [f64; 3] = std::array::from_fn(|i| point[i] - self.eye[i]);
        let depth = dot(offset, self.forward);
        let spread = match self.lens {
            Lens::Orthographic(_) => 1.0,
            Lens::Perspective(_) if depth > 0.0 => depth,
            Lens::Perspective(_) => f64::NAN,
        };
        let lateral = [dot(offset, self.right) / spread, dot(offset, self.up) / spread];
        (raster.place([0, 1].map(|i| lateral[i] / self.slope() - self.shift[i])), depth)
    }

    /// Returns the motion of a point at rest, seen in this pixel at this depth, to its place in another camera's image:
    /// x right, y down. NaN if it was behind that camera.
    pub fn motion_to(&self, before: &Self, pixel: [u32; 2], depth: f64, raster: Raster) -> [f64; 2] {
        let (then, _) = before.project(self.position(pixel, depth, raster), raster);
        // Both frames' jitter is excluded.
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
