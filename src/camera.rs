//! The camera, and how it reaches the shaders.

use crate::Error;
use bytemuck::{Pod, Zeroable};

/// A perspective camera in a right-handed world. Depth is linear, along `forward`; pixels count from the upper left corner,
/// x right, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where it is. In double precision, so that it moves smoothly however far it is from the origin.
    pub eye: [f64; 3],
    /// A point that it looks at, not `eye` itself.
    pub target: [f64; 3],
    /// A direction that shall point up in the image, not along the view.
    pub up: [f32; 3],
    /// Vertical field of view in radians, 0 < fov < π.
    pub fov_y: f32,
    /// Where the ray of a pixel goes through it, from its centre, in pixels: −½…½. The same for all pixels of a frame.
    pub jitter: [f32; 2],
}

impl Default for Camera {
    fn default() -> Self {
        Self { eye: [0.0; 3], target: [0.0, 0.0, -1.0], up: [0.0, 1.0, 0.0], fov_y: 0.8, jitter: [0.0; 2] }
    }
}

/// A perspective or orthographic camera as renderers have it. Matrices are arrays of columns: `m[column][row]`, as glam's `to_cols_array_2d` gives
/// them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrices {
    /// World space to view space: a rotation and a translation, without scale. Right- or left-handed.
    pub view: [[f32; 4]; 4],
    /// View space to clip space, x right and y up, **without** the jitter. Any depth range: reversed and infinite ones too, because
    /// depth is not read from it. It may be off-centre (shifted lenses, crops). An orthographic one looks to where its depth grows; it counts as
    /// reversed if the eye itself has a depth above ½. Surfaces must lie in front of the eye, at depths above 0.
    pub projection: [[f32; 4]; 4],
    /// Where the ray of a pixel goes through it, from its centre, in pixels, x right, y **down**: −½…½. The same for all pixels of a
    /// frame.
    pub jitter: [f32; 2],
}

/// Where a frame is seen from. [`Camera`] and [`Matrices`] convert into it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewpoint {
    /// Given by where it is and what it looks at.
    Camera(Camera),
    /// Given by its matrices.
    Matrices(Matrices),
    /// Given by its matrices in a space that moves along, as renderers of large worlds have it: often the view matrix has no translation
    /// at all.
    Relative {
        /// The camera in that space.
        matrices: Matrices,
        /// Where in the world that space has its origin, in this frame.
        origin: [f64; 3],
    },
}

impl From<Camera> for Viewpoint {
    fn from(camera: Camera) -> Self {
        Self::Camera(camera)
    }
}

impl From<Matrices> for Viewpoint {
    fn from(matrices: Matrices) -> Self {
        Self::Matrices(matrices)
    }
}

impl Viewpoint {
    pub(crate) fn placed(&self, size: [u32; 2]) -> Result<PlacedCamera, Error> {
        match self {
            Self::Camera(camera) => camera.placed(size),
            Self::Matrices(matrices) => matrices.placed(size),
            Self::Relative { origin, .. } if !origin.iter().all(|x| x.is_finite()) => {
                Err(Error::Camera { element: "origin", reason: "is not finite" })
            }
            Self::Relative { matrices, origin } => {
                let placed = matrices.placed(size)?;
                Ok(PlacedCamera { eye: add(placed.eye, *origin), ..placed })
            }
        }
    }

    /// Where in the world the host's coordinates count from.
    pub(crate) fn origin(&self) -> [f64; 3] {
        match self {
            Self::Camera(_) | Self::Matrices(_) => [0.0; 3],
            Self::Relative { origin, .. } => *origin,
        }
    }
}

/// A camera for an image's size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlacedCamera {
    eye: [f64; 3],
    /// The rest, its eye at 0.
    rays: CameraUniform,
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
    eye: [f32; 3],
    jitter_x: f32,
    forward: [f32; 3],
    jitter_y: f32,
    corner: [f32; 3],
    /// 1 for an orthographic view: then the ray's spread does not grow with depth.
    orthographic: f32,
    du: [f32; 3],
    inverse_du: f32,
    dv: [f32; 3],
    inverse_dv: f32,
    /// The eye less that of this frame's camera.
    offset: [f32; 3],
    // WGSL rounds a struct's size up to that of a vector.
    padding: f32,
}

impl Camera {
    /// The affine map from pixel to ray: direction = corner + x·du + y·dv, with unit component along `forward`. In f64, so
    /// that the f32 results are as good as they can be for very narrow and very wide views.
    pub(crate) fn placed(&self, size: [u32; 2]) -> Result<PlacedCamera, Error> {
        let wrong = |element, reason| Err(Error::Camera { element, reason });
        let finite = |v: &[f32]| v.iter().all(|x| x.is_finite());
        // Beyond f32's range it would be infinite in shaders.
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

impl CameraUniform {
    /// Which way, and the affine map from pixel to ray: corner, du, dv.
    fn new(forward: [f64; 3], [corner, du, dv]: [[f64; 3]; 3], jitter: [f32; 2]) -> Self {
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

impl Matrices {
    /// As [`Camera::placed`]. A point v of view space has the linear depth z = s·v_z, s = ±1 by handedness, and the image point
    /// ndc = A·(v_xy/z) + s·(P₂₀, P₂₁) with A the upper left 2×2 of the projection, divided by |P₂₃|. Solved for v_xy/z, and turned
    /// into world space, that is the ray of an image point, affine in it. In an orthographic view, divided by P₃₃,
    /// ndc = A·v_xy + (P₃₀, P₃₁), and what is affine is the place of the ray instead of its direction.
    fn placed(&self, size: [u32; 2]) -> Result<PlacedCamera, Error> {
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
        // Where the middle of the view lands in the image.
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

fn narrow(a: [f64; 3]) -> [f32; 3] {
    a.map(|x| x as f32)
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn subtract(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn scale(a: [f64; 3], s: f64) -> [f64; 3] {
    a.map(|x| x * s)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn normalize(a: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(a, a).sqrt();
    (length > 1e-30 && length.is_finite()).then(|| scale(a, 1.0 / length))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The camera alone, in the world.
    fn alone(placed: PlacedCamera) -> CameraUniform {
        placed.uniform([0.0; 3], &placed)
    }

    fn along(u: &CameraUniform, x: f64, y: f64) -> [f64; 3] {
        let part = |i: usize| f64::from(u.corner[i]) + x * f64::from(u.du[i]) + y * f64::from(u.dv[i]);
        [part(0), part(1), part(2)]
    }

    #[test]
    fn the_image_centre_looks_forward_and_the_top_edge_is_half_the_field_of_view_up() {
        let camera = Camera { eye: [1.0, 2.0, 3.0], target: [1.0, 2.0, -5.0], fov_y: 1.0, ..Default::default() };
        let u = alone(camera.placed([64, 48]).unwrap());
        let centre = along(&u, 32.0, 24.0);
        assert!(centre[0].abs() < 1e-6 && centre[1].abs() < 1e-6 && (centre[2] + 1.0).abs() < 1e-6);
        let top = along(&u, 32.0, 0.0);
        assert!((top[1] - 0.5_f64.tan()).abs() < 1e-6, "{top:?}");
        // x grows to the right: +X when looking along −Z.
        assert!(along(&u, 64.0, 24.0)[0] > 0.0);
    }

    #[test]
    #[cfg(feature = "path-tracer")]
    fn the_camera_lies_where_the_shader_reads_it() {
        use crate::twins::layout::{assert_layout, fields};
        let fields = fields!(CameraUniform: eye, jitter_x, forward, jitter_y, corner, orthographic, du, inverse_du, dv, inverse_dv, offset);
        assert_layout("Camera", fields, size_of::<CameraUniform>());
    }

    #[test]
    fn far_cameras_keep_the_small_way_between_them() {
        let far = 524_288.0;
        let now = Camera { eye: [far + 1e-3, 2.0, -far], target: [far, 2.0, 5.0 - far], ..Default::default() };
        let before = Camera { eye: [far, 2.0, -far - 2e-3], ..now };
        let [now, before] = [now, before].map(|c| c.placed([64, 48]).unwrap());
        assert_eq!(now.uniform([0.0; 3], &now).offset, [0.0; 3]);
        let offset = before.uniform([0.0; 3], &now).offset.map(f64::from);
        assert!((offset[0] + 1e-3).abs() < 1e-9 && (offset[2] + 2e-3).abs() < 1e-9, "{offset:?}");
        let eye = now.uniform([far, 0.0, -far], &now).eye.map(f64::from);
        assert!((eye[0] - 1e-3).abs() < 1e-9 && eye[2] == 0.0, "{eye:?}");
    }

    #[test]
    fn matrices_may_count_from_a_point_that_moves_along() {
        let unit = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
        let projection = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.1, 0.0]];
        let matrices = Matrices { view: unit, projection, jitter: [0.0; 2] };
        let at = |x: f64| Viewpoint::Relative { matrices, origin: [x, 0.0, 0.0] };
        let [before, now] = [6.0e6, 6.0e6 + 0.125].map(|x| at(x).placed([8, 8]).unwrap());
        let uniform = before.uniform(at(6.0e6 + 0.125).origin(), &now);
        assert_eq!((uniform.eye, uniform.offset), ([-0.125, 0.0, 0.0], [-0.125, 0.0, 0.0]));
        assert!(matches!(at(f64::NAN).placed([8, 8]), Err(Error::Camera { element: "origin", .. })));
    }

    #[test]
    fn an_impossible_camera_is_refused_by_name() {
        let named = |c: Camera| match c.placed([8, 8]) {
            Err(Error::Camera { element, .. }) => element,
            other => panic!("{other:?}"),
        };
        let c = Camera::default();
        assert_eq!(named(Camera { eye: [f64::NAN, 0.0, 0.0], ..c }), "eye");
        assert_eq!(named(Camera { target: c.eye, ..c }), "target");
        assert_eq!(named(Camera { up: [0.0, 0.0, 1.0], ..c }), "up");
        assert_eq!(named(Camera { fov_y: 3.2, ..c }), "fov_y");
        assert_eq!(named(Camera { fov_y: 0.0, ..c }), "fov_y");
    }

    /// The same view by a matrix: right-handed, looking along −Z.
    #[cfg(feature = "path-tracer")]
    fn view_rh(c: &Camera) -> glam::Mat4 {
        glam::camera::rh::view::look_at_mat4(narrow(c.eye).into(), narrow(c.target).into(), c.up.into())
    }

    #[cfg(feature = "path-tracer")]
    fn oblique() -> Camera {
        let (eye, target, up) = ([1.0, 2.5, 3.0], [-0.5, 0.4, -1.0], [0.1, 1.0, 0.2]);
        Camera { eye, target, up, fov_y: 0.9, jitter: [0.25, -0.125] }
    }

    #[cfg(feature = "path-tracer")]
    fn assert_same(found: &CameraUniform, expected: &CameraUniform, what: &str) {
        let numbers = |u: &CameraUniform| -> Vec<f32> { bytemuck::cast_slice(bytemuck::bytes_of(u)).to_vec() };
        for (i, (f, e)) in numbers(found).iter().zip(numbers(expected)).enumerate() {
            assert!((f - e).abs() <= 2e-6 * e.abs().max(1.0), "{what}: number {i} is {f}, not {e}");
        }
    }

    #[test]
    #[cfg(feature = "path-tracer")]
    fn matrices_of_every_convention_give_the_same_camera() {
        use glam::camera::{lh, rh};
        let c = oblique();
        let (size, aspect, fov) = ([64, 48], 64.0 / 48.0, c.fov_y);
        let expected = alone(c.placed(size).unwrap());
        let right = view_rh(&c);
        // The same world, looking along +Z of a view space that is its mirror image.
        let left = glam::Mat4::from_scale(glam::Vec3::new(1.0, 1.0, -1.0)) * right;
        // OpenGL's depth of −1…1, WebGPU's of 0…1, endless, reversed, and both; a projection may be scaled as a whole.
        let conventions = [
            ("rh gl", right, rh::proj::opengl::perspective(fov, aspect, 0.1, 50.0)),
            ("rh", right, rh::proj::directx::perspective(fov, aspect, 0.1, 50.0)),
            ("rh reversed", right, rh::proj::directx::perspective(fov, aspect, 50.0, 0.1)),
            ("rh endless", right, rh::proj::directx::perspective_infinite(fov, aspect, 0.1)),
            ("rh endless reversed", right, rh::proj::directx::perspective_infinite_reverse(fov, aspect, 0.1)),
            ("lh", left, lh::proj::directx::perspective(fov, aspect, 0.1, 50.0)),
            ("lh endless reversed", left, lh::proj::directx::perspective_infinite_reverse(fov, aspect, 0.1)),
            ("scaled", left, lh::proj::directx::perspective(fov, aspect, 0.1, 50.0) * 3.0),
        ];
        for (what, view, projection) in conventions {
            let (view, projection) = (view.to_cols_array_2d(), projection.to_cols_array_2d());
            let matrices = Matrices { view, projection, jitter: c.jitter };
            assert_same(&alone(matrices.placed(size).unwrap()), &expected, what);
        }
    }

    /// Where matrices put points, against the ray of that place: for frusta and worlds that no [`Camera`] describes.
    #[test]
    #[cfg(feature = "path-tracer")]
    fn points_are_seen_where_matrices_put_them() {
        use glam::camera::lh;
        use glam::{Mat4, Vec3, Vec4};
        let c = oblique();
        let size = [64.0_f32, 48.0];
        let (l, r, b, t, n) = (-0.2, 0.5, -0.1, 0.4, 0.3);
        let off_centre = Mat4::from_cols(
            Vec4::new(2.0 * n / (r - l), 0.0, 0.0, 0.0),
            Vec4::new(0.0, 2.0 * n / (t - b), 0.0, 0.0),
            Vec4::new((r + l) / (r - l), (t + b) / (t - b), -1.0, -1.0),
            Vec4::new(0.0, 0.0, -n, 0.0),
        );
        // And a world that is left-handed itself.
        let left = lh::view::look_at_mat4(narrow(c.eye).into(), narrow(c.target).into(), c.up.into());
        let views = [(view_rh(&c), off_centre), (left, lh::proj::directx::perspective(0.9, 0.7, 0.1, 50.0))];
        let points = [Vec3::new(-0.4, 0.3, -1.5), Vec3::new(0.2, -0.1, 0.3), Vec3::new(-1.5, 1.0, -4.0)];
        for ((view, projection), point) in views.into_iter().flat_map(|v| points.map(|p| (v, p))) {
            let matrices =
                Matrices { view: view.to_cols_array_2d(), projection: projection.to_cols_array_2d(), jitter: [0.0; 2] };
            let u = alone(matrices.placed([64, 48]).unwrap());
            let clip = projection * view * point.extend(1.0);
            let (x, y) = ((clip.x / clip.w + 1.0) / 2.0 * size[0], (1.0 - clip.y / clip.w) / 2.0 * size[1]);
            let d = along(&u, x.into(), y.into());
            for axis in 0..3 {
                // Linear depth is what a perspective projection divides by.
                let found = f64::from(u.eye[axis]) + f64::from(clip.w) * d[axis];
                assert!((found - f64::from(point[axis])).abs() < 1e-4, "{point}: {found} on axis {axis}");
            }
        }
    }

    /// Parallel views of every convention, off-centre too, against where glam puts points.
    #[test]
    #[cfg(feature = "path-tracer")]
    fn points_are_seen_where_orthographic_matrices_put_them() {
        use glam::camera::{lh, rh};
        use glam::{Mat4, Vec3};
        let c = oblique();
        let right = view_rh(&c);
        let left = Mat4::from_scale(Vec3::new(1.0, 1.0, -1.0)) * right;
        let conventions = [
            (right, rh::proj::directx::orthographic(-2.0, 3.0, -1.5, 1.0, 0.1, 50.0)),
            (right, rh::proj::directx::orthographic(-2.0, 3.0, -1.5, 1.0, 50.0, 0.1)),
            (right, rh::proj::opengl::orthographic(-2.0, 3.0, -1.5, 1.0, 0.1, 50.0)),
            (left, lh::proj::directx::orthographic(-2.0, 3.0, -1.5, 1.0, 0.1, 50.0)),
            (left, lh::proj::directx::orthographic(-2.0, 3.0, -1.5, 1.0, 50.0, 0.1) * 2.0),
        ];
        let points = [Vec3::new(-0.4, 0.3, -1.5), Vec3::new(0.2, -0.1, 0.3), Vec3::new(-1.5, 1.0, -4.0)];
        for ((view, projection), point) in conventions.into_iter().flat_map(|v| points.map(|p| (v, p))) {
            let matrices =
                Matrices { view: view.to_cols_array_2d(), projection: projection.to_cols_array_2d(), jitter: [0.0; 2] };
            let u = alone(matrices.placed([64, 48]).unwrap());
            assert_eq!(u.orthographic, 1.0);
            let clip = projection * view * point.extend(1.0);
            let (x, y) = ((clip.x / clip.w + 1.0) / 2.0 * 64.0, (1.0 - clip.y / clip.w) / 2.0 * 48.0);
            let depth = f64::from(-(right * point.extend(1.0)).z);
            let d = along(&u, x.into(), y.into());
            for axis in 0..3 {
                let forward = f64::from(u.forward[axis]);
                let found = f64::from(u.eye[axis]) + d[axis] - forward + depth * forward;
                assert!((found - f64::from(point[axis])).abs() < 1e-4, "{point}: {found} on axis {axis}");
            }
        }
    }

    #[test]
    fn impossible_matrices_are_refused_by_name() {
        let unit = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
        let projection = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.1, 0.0]];
        let good = Matrices { view: unit, projection, jitter: [0.0; 2] };
        assert!(good.placed([8, 8]).is_ok());
        let named = |m: Matrices| match Viewpoint::from(m).placed([8, 8]) {
            Err(Error::Camera { element, .. }) => element,
            other => panic!("{other:?}"),
        };
        let with = |matrix: [[f32; 4]; 4], column: usize, row: usize, value: f32| {
            let mut matrix = matrix;
            matrix[column][row] = value;
            matrix
        };
        for view in [with(unit, 0, 0, 2.0), with(unit, 3, 1, f32::NAN), with(unit, 1, 0, 0.5), with(unit, 0, 3, 1.0)] {
            assert_eq!(named(Matrices { view, ..good }), "view");
        }
        // Orthographic without depth, both, singular, sheared, not finite.
        let orthographic = with(with(projection, 2, 3, 0.0), 3, 3, 1.0);
        for projection in [
            orthographic,
            with(projection, 3, 3, 1.0),
            with(projection, 0, 0, 0.0),
            with(projection, 1, 0, 0.5),
            with(projection, 2, 2, f32::INFINITY),
        ] {
            assert_eq!(named(Matrices { projection, ..good }), "projection");
        }
        assert_eq!(named(Matrices { jitter: [f32::NAN, 0.0], ..good }), "jitter");
    }
}
