//! A host's glossy frames in other coordinates: the world turned, rolled, mirrored, scaled and far away, and the image with a margin in which
//! there is nothing.

use super::{colors, upload, view};
use crate::common::gpu::gpu;
use crate::common::plane::{V, cross, scale, sub, unit};
use crate::common::stage::Stage;
use crate::common::statistics::{Rgb, relative_mse};
use asvgf::{
    Denoiser, DenoiserDescriptor, FilterSettings, Gloss, Gradient, Matrices, Settings, Shading, Surfaces, View,
    Viewpoint,
};
use std::sync::LazyLock;
use wgpu::TextureFormat;

const SIZE: [u32; 2] = [48, 36];

/// The first of the frames: in those that follow the lamp goes out, and everything moves.
const FIRST: u32 = 26;
const FRAMES: u32 = 8;

/// A frame as a renderer has it.
#[derive(Clone, Default)]
struct Rendered {
    size: [u32; 2],
    index: u32,
    eye: V,
    /// Directions of the image's right side, of its upper side, and against the view.
    axes: [V; 3],
    fov_y: f64,
    depth: Vec<[f32; 1]>,
    normal: Vec<Rgb>,
    motion: Vec<[f32; 2]>,
    previous_depth: Vec<[f32; 1]>,
    instance: Vec<[f32; 1]>,
    albedo: Vec<Rgb>,
    diffuse: Vec<Rgb>,
    reflectance: Vec<Rgb>,
    specular: Vec<Rgb>,
    roughness: Vec<[f32; 1]>,
    hit_distance: Vec<[f32; 1]>,
}

/// Frames of the path tracer.
fn rendered() -> Vec<Rendered> {
    let mut stage = Stage::built_in("gloss", "all", SIZE, Settings::adaptive()).leaving_nothing_out();
    stage.index = FIRST;
    (FIRST..FIRST + FRAMES)
        .map(|index| {
            let camera = stage.camera_in(&stage.pose_at(index));
            let forward = unit(sub(camera.target, camera.eye));
            let right = unit(cross(forward, camera.up.map(f64::from)));
            stage.frame();
            let motion = stage.view(View::Motion);
            let mut first = |view: View, channel: usize| -> Vec<[f32; 1]> {
                stage.view(view).iter().map(|c| [c[channel]]).collect()
            };
            let scalars = [(View::Depth, 0), (View::Object, 0), (View::Roughness, 0), (View::HitDistance, 1)];
            let [depth, instance, roughness, hit_distance] = scalars.map(|(view, channel)| first(view, channel));
            let colors = [View::Normal, View::Albedo, View::DiffuseNoisy, View::SpecularAlbedo, View::SpecularNoisy];
            let [normal, albedo, diffuse, reflectance, specular] = colors.map(|view| stage.view(view));
            Rendered {
                size: SIZE,
                index,
                eye: camera.eye,
                axes: [right, cross(right, forward), scale(forward, -1.0)],
                fov_y: camera.fov_y.into(),
                depth,
                normal,
                motion: motion.iter().map(|m| [m[0], m[1]]).collect(),
                previous_depth: motion.iter().map(|m| [m[2]]).collect(),
                instance,
                albedo,
                diffuse,
                reflectance,
                specular,
                roughness,
                hit_distance,
            }
        })
        .collect()
}

impl Rendered {
    fn viewpoint(&self) -> Viewpoint {
        let column = |axis: usize| [self.axes[0][axis], self.axes[1][axis], self.axes[2][axis], 0.0].map(|x| x as f32);
        let view = [column(0), column(1), column(2), [0.0, 0.0, 0.0, 1.0]];
        // A margin to the right and below leaves the size of a pixel and the upper left corner as they are.
        let [w, h] = [0, 1].map(|i| f64::from(self.size[i]) / f64::from(SIZE[i]));
        let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
        let slope = 1.0 / (self.fov_y / 2.0).tan();
        let projection = [
            [slope / aspect / w, 0.0, 0.0, 0.0],
            [0.0, slope / h, 0.0, 0.0],
            [1.0 - 1.0 / w, 1.0 / h - 1.0, 0.0, -1.0],
            [0.0, 0.0, 0.1, 0.0],
        ];
        let matrices = Matrices::new(view, projection.map(|c| c.map(|x| x as f32)));
        Viewpoint::Relative { matrices, origin: self.eye }
    }

    /// The same world after a turn, a uniform scaling and a shift.
    fn placed(&self, turn: [V; 3], size: f64, place: V) -> Self {
        let turned = |v: V| turn.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
        let long = |image: &[[f32; 1]]| image.iter().map(|x| [(f64::from(x[0]) * size) as f32]).collect();
        let eye = turned(self.eye);
        Self {
            eye: [0, 1, 2].map(|i| size * eye[i] + place[i]),
            axes: self.axes.map(turned),
            normal: self.normal.iter().map(|n| turned(n.map(f64::from)).map(|x| x as f32)).collect(),
            depth: long(&self.depth),
            previous_depth: long(&self.previous_depth),
            hit_distance: long(&self.hit_distance),
            ..self.clone()
        }
    }

    /// The mirror image.
    fn flipped(&self) -> Self {
        fn row<T: Copy>(image: &[T]) -> Vec<T> {
            image.chunks(SIZE[0] as usize).flat_map(|row| row.iter().rev().copied()).collect()
        }
        let x = |[x, y, z]: V| [-x, y, z];
        let [right, up, back] = self.axes;
        Self {
            eye: x(self.eye),
            axes: [scale(x(right), -1.0), x(up), x(back)],
            depth: row(&self.depth),
            normal: row(&self.normal).iter().map(|n| [-n[0], n[1], n[2]]).collect(),
            motion: row(&self.motion).iter().map(|m| [-m[0], m[1]]).collect(),
            previous_depth: row(&self.previous_depth),
            instance: row(&self.instance),
            albedo: row(&self.albedo),
            diffuse: row(&self.diffuse),
            reflectance: row(&self.reflectance),
            specular: row(&self.specular),
            roughness: row(&self.roughness),
            hit_distance: row(&self.hit_distance),
            ..self.clone()
        }
    }

    /// The same with a margin to the right and below that holds no surface, and numbers that are none.
    fn padded(&self, margin: [u32; 2]) -> Self {
        let size = [0, 1].map(|i| SIZE[i] + margin[i]);
        fn pad<const N: usize>(image: &[[f32; N]], margin: [u32; 2], value: f32) -> Vec<[f32; N]> {
            let rows = image.chunks(SIZE[0] as usize);
            let empty = |count: u32| std::iter::repeat_n([value; N], count as usize);
            let mut padded: Vec<[f32; N]> = rows.flat_map(|row| row.iter().copied().chain(empty(margin[0]))).collect();
            padded.extend(empty(margin[1] * (SIZE[0] + margin[0])));
            padded
        }
        let nan = f32::NAN;
        Self {
            size,
            depth: pad(&self.depth, margin, nan),
            normal: pad(&self.normal, margin, nan),
            motion: pad(&self.motion, margin, nan),
            previous_depth: pad(&self.previous_depth, margin, nan),
            instance: pad(&self.instance, margin, 0.0),
            albedo: pad(&self.albedo, margin, nan),
            diffuse: pad(&self.diffuse, margin, nan),
            reflectance: pad(&self.reflectance, margin, nan),
            specular: pad(&self.specular, margin, nan),
            roughness: pad(&self.roughness, margin, nan),
            hit_distance: pad(&self.hit_distance, margin, nan),
            ..self.clone()
        }
    }
}

/// What the denoiser makes of frames: each image, and the motion of the reflections.
fn denoised(frames: &[Rendered]) -> Vec<[Vec<Rgb>; 2]> {
    let size = frames[0].size;
    let filter = FilterSettings { gradient: Gradient::Statistics, ..Default::default() };
    let settings = Settings { filter, ..Settings::adaptive() };
    let descriptor = DenoiserDescriptor { size, settings, views: true, ..Default::default() };
    let mut denoiser = Denoiser::new(&gpu().device, &gpu().queue, &descriptor).unwrap();
    let target = gpu().target(size, TextureFormat::Rgba32Float);
    frames
        .iter()
        .map(|frame| {
            let [depth, previous_depth, instance, roughness, hit_distance] =
                [&frame.depth, &frame.previous_depth, &frame.instance, &frame.roughness, &frame.hit_distance]
                    .map(|image| upload(gpu(), size, image));
            let [normal, albedo, diffuse, reflectance, specular] =
                [&frame.normal, &frame.albedo, &frame.diffuse, &frame.reflectance, &frame.specular]
                    .map(|image| upload(gpu(), size, image));
            let motion = upload(gpu(), size, &frame.motion);
            gpu().submit(|encoder| {
                let surfaces = Surfaces {
                    previous_depth: Some(&previous_depth),
                    instance: Some(&instance),
                    ..Surfaces::new(frame.viewpoint(), frame.index, &depth, &normal, &motion)
                };
                denoiser.begin_frame(&gpu().device, encoder, &surfaces).unwrap();
                let gloss = Gloss {
                    radiance: Some(&specular),
                    reflectance: Some(&reflectance),
                    roughness: Some(&roughness),
                    hit_distance: Some(&hit_distance),
                    ..Default::default()
                };
                let shading = Shading { albedo: Some(&albedo), gloss: Some(gloss), ..Shading::new(&diffuse, &target) };
                denoiser.denoise(&gpu().device, encoder, &shading).unwrap();
            });
            [colors(&target), view(&mut denoiser, View::ReflectionMotion)]
        })
        .collect()
}

/// Compares the altered frames with the others, by the part of each image that shows the same. `allowed` are the largest difference of a
/// reflection's motion in pixels, and the relative squared error of images.
fn check(what: &str, allowed: [f64; 2], alter: impl Fn(&Rendered) -> Rendered, restore: impl Fn(Rgb) -> Rgb) {
    let flips = restore([1.0, 0.0, 0.0])[0] < 0.0;
    let altered: Vec<Rendered> = FRAMES_OF_THE_TRACER.iter().map(alter).collect();
    let width = altered[0].size[0] as usize;
    let mut worst = [0.0_f64; 2];
    for (found, expected) in denoised(&altered).iter().zip(&*UNALTERED) {
        let shown = |image: &[Rgb]| -> Vec<Rgb> {
            let rows = image.chunks(width).take(SIZE[1] as usize).map(|row| &row[..SIZE[0] as usize]);
            rows.flat_map(|row| {
                let mut row = row.to_vec();
                if flips {
                    row.reverse();
                }
                row
            })
            .collect()
        };
        let motion = shown(&found[1]);
        let apart = |(a, b): (&Rgb, &Rgb)| f64::from((restore(*a)[0] - b[0]).hypot(a[1] - b[1]));
        worst[0] = motion.iter().zip(&expected[1]).map(apart).fold(worst[0], f64::max);
        worst[1] = worst[1].max(relative_mse(&shown(&found[0]), &expected[0]));
    }
    println!("{what}: motions up to {:.4} pixels apart, images up to {:.1e}", worst[0], worst[1]);
    assert!(worst[0] <= allowed[0] && worst[1] <= allowed[1], "{what}: {worst:?}");
}

static FRAMES_OF_THE_TRACER: LazyLock<Vec<Rendered>> = LazyLock::new(rendered);
static UNALTERED: LazyLock<Vec<[Vec<Rgb>; 2]>> = LazyLock::new(|| denoised(&FRAMES_OF_THE_TRACER));

const UPRIGHT: [V; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A quarter turn that takes axis a to axis b.
fn quarter(a: usize, b: usize) -> [V; 3] {
    let mut turn = UPRIGHT;
    (turn[a], turn[b]) = (UPRIGHT[b].map(|x| -x), UPRIGHT[a]);
    turn
}

/// Quarter turns exchange axes and signs, so that nothing but sums of three is rounded otherwise.
#[test]
fn a_world_that_lies_on_its_side_looks_the_same() {
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        check(
            &format!("axis {a} turned to {b}"),
            [1.0 / 256.0, 1e-6],
            |f| f.placed(quarter(a, b), 1.0, [0.0; 3]),
            |m| m,
        );
    }
}

/// Normals are rounded to 10 bits, each time to others, and the curvature follows from their differences.
#[test]
fn a_rolled_camera_sees_the_same() {
    for angle in [0.2_f64, 0.7, 2.5] {
        let (s, c) = angle.sin_cos();
        let turn = [[c, -s, 0.0], [0.6 * s, 0.6 * c, -0.8], [0.8 * s, 0.8 * c, 0.6]];
        check(&format!("turned by {angle}"), [0.25, 1e-4], |f| f.placed(turn, 1.0, [0.0; 3]), |m| m);
    }
}

#[test]
fn other_units_and_places_change_nothing() {
    check("10 km away", [0.0; 2], |f| f.placed(UPRIGHT, 1.0, [1e4, -1e4, 1e4]), |m| m);
    check("1024 units for one", [0.0; 2], |f| f.placed(UPRIGHT, 1024.0, [0.0; 3]), |m| m);
    check("one unit for 1024", [0.0; 2], |f| f.placed(UPRIGHT, 1.0 / 1024.0, [0.0; 3]), |m| m);
    // These are rounded.
    check("1000 units for one", [0.0625, 1e-5], |f| f.placed(UPRIGHT, 1000.0, [0.0; 3]), |m| m);
    check("one unit for 1000", [0.0625, 1e-5], |f| f.placed(UPRIGHT, 0.001, [0.0; 3]), |m| m);
}

/// The random rounding of histories goes by the pixel, so mirror images are alike to the rounding alone.
#[test]
fn the_mirror_image_looks_mirrored() {
    check("mirrored", [2.0 / 256.0, 1e-4], Rendered::flipped, |m| [-m[0], m[1], m[2]]);
}

#[test]
fn a_margin_of_nothing_is_no_neighbour() {
    for margin in [[7, 5], [0, 3], [64, 0]] {
        check(&format!("a margin of {margin:?}"), [1.0 / 256.0, 1e-6], |f| f.padded(margin), |m| m);
    }
}
