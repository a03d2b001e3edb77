//! Cameras of all kinds, by the rays that they give.

#[cfg(feature = "path-tracer")]
use super::vector::narrow;
use super::{Camera, CameraUniform, Matrices, PlacedCamera, Viewpoint};
use crate::Error;

/// The camera alone, in the world.
fn alone(placed: PlacedCamera) -> CameraUniform {
    placed.uniform([0.0; 3], &placed)
}

fn along(u: &CameraUniform, x: f64, y: f64) -> [f64; 3] {
    let part = |i: usize| f64::from(u.corner[i]) + x * f64::from(u.du[i]) + y * f64::from(u.dv[i]);
    [part(0), part(1), part(2)]
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
fn the_camera_lies_where_the_shader_reads_it() {
    use crate::twins::layout::{assert_layout, fields};
    let fields = fields!(CameraUniform: eye, jitter_x, forward, jitter_y, corner, orthographic, du, inverse_du, dv, inverse_dv, offset);
    assert_layout("Camera", fields, size_of::<CameraUniform>());
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

/// The image points of matrices against the rays there, for frusta and worlds that no [`Camera`] describes.
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
    // The world is left-handed itself.
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

/// Parallel views of every convention, off-centre too, against the image points of glam.
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
