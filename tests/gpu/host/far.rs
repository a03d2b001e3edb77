//! A host's images far from the origin: blending depends on the distance between the cameras, and not on their places.

use super::{Recorded, SIZE, Uploaded, colors, denoiser, difference, recorded, target, view};
use crate::common::gpu::gpu;
use crate::common::plane::{cross, sub, unit};
use crate::common::statistics::Rgb;
use asvgf::{Camera, Matrices, Settings, Surfaces, View, Viewpoint};

/// A place so far away that an eye in f32 would stand still for some frames, and then jump by four metres.
const PLACE: [f64; 3] = [6.0e7 + 1.85, -8192.0, 524_288.0];

/// Denoises frames that are seen from elsewhere.
fn replay_from(frames: &[Recorded], elsewhere: impl Fn(&Camera) -> Viewpoint) -> (Vec<Vec<Rgb>>, Vec<Rgb>) {
    let mut denoiser = denoiser(Settings::adaptive());
    let target = target();
    let mut images = Vec::new();
    for frame in frames {
        let host = Uploaded::new(gpu(), frame);
        gpu().submit(|encoder| {
            // The denoiser computes the points' former depths from the cameras.
            let camera = elsewhere(&frame.camera);
            let surfaces = Surfaces { camera, previous_depth: None, ..host.surfaces() };
            denoiser.begin_frame(&gpu().device, encoder, &surfaces).unwrap();
            denoiser.denoise(&gpu().device, encoder, &host.shading(&target)).unwrap();
        });
        images.push(colors(&target));
    }
    (images, view(&mut denoiser, View::HistoryLength))
}

/// The camera's rotation and lens, without its place.
fn without_place(camera: &Camera) -> Matrices {
    let forward = unit(sub(camera.target, camera.eye));
    let right = unit(cross(forward, camera.up.map(f64::from)));
    let rows = [right, cross(right, forward), forward.map(|x| -x)];
    let column = |axis: usize| [rows[0][axis], rows[1][axis], rows[2][axis], 0.0].map(|x| x as f32);
    let slope = 1.0 / (camera.fov_y / 2.0).tan();
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    let projection =
        [[slope / aspect, 0.0, 0.0, 0.0], [0.0, slope, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.1, 0.0]];
    let view = [column(0), column(1), column(2), [0.0, 0.0, 0.0, 1.0]];
    Matrices { view, projection, jitter: camera.jitter }
}

fn away(at: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| at[i] + PLACE[i])
}

#[test]
fn the_same_images_give_the_same_result_wherever_the_camera_is() {
    let frames = recorded(Settings::adaptive());
    let (near, lengths) = replay_from(&frames, |c| (*c).into());
    let far = |c: &Camera| Camera { eye: away(c.eye), target: away(c.target), ..*c }.into();
    let relative = |c: &Camera| Viewpoint::Relative { matrices: without_place(c), origin: away(c.eye) };
    let far = replay_from(&frames, far);
    let relative = replay_from(&frames, relative);
    for (what, (images, length)) in [("a camera", far), ("matrices that move along", relative)] {
        for (frame, (image, near)) in images.iter().zip(&near).enumerate() {
            let [largest, mean] = difference(image, near);
            assert!(largest < 0.05 && mean < 1e-4, "{what}, frame {frame}: {largest:.1e}, {mean:.1e}");
        }
        let differ = length.iter().zip(&lengths).filter(|(a, b)| (a[0] - b[0]).abs() > 0.01).count();
        assert!(differ <= 2, "{what}: {differ} histories");
    }
}

/// Matrices in f32 round the eye's place to steps of 1/32 here. An eye on those steps loses nothing.
#[test]
fn matrices_in_f32_far_away_lose_no_more_than_they_say() {
    // The camera does not turn and moves by whole steps; the wall before it is 3 away.
    let size = SIZE[0] as usize * SIZE[1] as usize;
    let step = 1.0 / 32.0;
    let slope = 1.0 / (0.4_f32 / 2.0).tan();
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    let focal = 0.5 * SIZE[1] as f32 * slope;
    let projection =
        [[slope / aspect, 0.0, 0.0, 0.0], [0.0, slope, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.1, 0.0]];
    let motion = focal * step / 3.0;
    let frames: Vec<Recorded> = (0..10)
        .map(|index| Recorded {
            index,
            camera: Camera::default(),
            depth: vec![3.0; size],
            normal: vec![[0.0, 0.0, 1.0]; size],
            motion: vec![[if index == 0 { 0.0 } else { motion }, 0.0]; size],
            previous_depth: vec![3.0; size],
            albedo: vec![[0.5; 3]; size],
            light: (0..size).map(|i| [((i * 7919 + index as usize * 104_729) % 97) as f32 / 97.0; 3]).collect(),
            denoised: Vec::new(),
        })
        .collect();
    let seen = |place: [f32; 3]| {
        let frame = std::cell::Cell::new(0.0);
        replay_from(&frames, |_| {
            let eye = [place[0] + step * frame.replace(frame.get() + 1.0), place[1], place[2]];
            let [x, y, z] = eye.map(|e| -e);
            let view = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [x, y, z, 1.0]];
            Matrices { view, projection, jitter: [0.0; 2] }.into()
        })
    };
    let (near, lengths) = seen([0.0; 3]);
    let (far, far_lengths) = seen([524_288.0, -8192.0, 262_144.0]);
    assert!(near == far && lengths == far_lengths);
    let middle = lengths[(SIZE[1] / 2 * SIZE[0] + SIZE[0] / 2) as usize][0];
    assert!(middle > 5.0, "history goes on: {middle}");
}
