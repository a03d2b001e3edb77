//! The example's renderer: it repeats the paths that its shader is told to repeat.

use super::{colors, difference, reshading};
use crate::common::gpu::gpu;
use asvgf::{Denoiser, DenoiserDescriptor, Shading, Surfaces, View, ViewOptions};
use wgpu::{CommandEncoder, TextureFormat, TextureView};

#[allow(dead_code, reason = "shared with the example, which uses the rest")]
#[path = "../../../examples/host_raster/renderer.rs"]
mod example;

use example::{Moment, Renderer};

const SIZE: [u32; 2] = [64, 36];

struct Stage {
    renderer: Renderer,
    denoiser: Denoiser,
    target: TextureView,
    index: u32,
    /// Motion that replaces the renderer's own.
    motion: Option<TextureView>,
}

impl Stage {
    fn new() -> Self {
        Self::of_size(SIZE)
    }

    fn of_size(size: [u32; 2]) -> Self {
        let descriptor = DenoiserDescriptor { size, settings: reshading(), views: true, ..Default::default() };
        Self {
            renderer: Renderer::new(&gpu().device, size),
            denoiser: Denoiser::new(&gpu().device, &gpu().queue, &descriptor).unwrap(),
            target: gpu().target(size, TextureFormat::Rgba32Float),
            index: 0,
            motion: None,
        }
    }

    fn frame(&mut self, now: &Moment, before: &Moment) {
        gpu().submit(|encoder| self.record(encoder, now, before));
    }

    fn record(&mut self, encoder: &mut CommandEncoder, now: &Moment, before: &Moment) {
        let r = &self.renderer;
        let scene = r.scene(now, before);
        r.draw(encoder, &scene);
        let motion = self.motion.as_ref().unwrap_or(&r.motion);
        let matrices = now.matrices(self.denoiser.size());
        let surfaces = Surfaces::new(matrices, self.index, &r.depth, &r.normal, motion);
        let reshade = self.denoiser.begin_frame(&gpu().device, encoder, &surfaces).unwrap().unwrap();
        r.shade(encoder, &scene, &reshade);
        let shading = Shading { albedo: Some(&r.albedo), ..Shading::new(&r.radiance, &self.target) };
        self.denoiser.denoise(&gpu().device, encoder, &shading).unwrap();
        self.index += 1;
    }

    /// Does the same as [`Stage::frame`] with the motion in rg16float: it draws the same frame once more to find the motion.
    fn frame_in_16_bits(&mut self, now: &Moment, before: &Moment) {
        let r = &self.renderer;
        gpu().submit(|encoder| r.draw(encoder, &r.scene(now, before)));
        let words: Vec<[f32; 2]> = bytemuck::pod_collect_to_vec(&gpu().read(r.motion.texture()));
        let round = |x: f32| f32::from_bits((x.to_bits() + 0x1000) & 0xffff_e000);
        let rounded: Vec<[f32; 2]> = words.iter().map(|m| m.map(round)).collect();
        self.motion = Some(super::upload(gpu(), SIZE, &rounded));
        self.frame(now, before);
    }

    fn view(&mut self, view: View) -> Vec<[f32; 3]> {
        let target = gpu().target(SIZE, TextureFormat::Rgba32Float);
        gpu().submit(|e| self.denoiser.show(&gpu().device, e, view, ViewOptions::default(), &target)).unwrap();
        colors(&target)
    }

    fn largest(&mut self, view: View) -> f32 {
        self.view(view).iter().map(|c| c[0].abs().max(c[1].abs())).fold(0.0, f32::max)
    }
}

/// A moment in which only the camera moves.
fn walking(frame: u32) -> Moment {
    Moment { eye: Moment::at(frame).eye, ..Moment::at(0) }
}

#[test]
fn nothing_changed_is_exactly_nothing_whether_the_camera_moves_or_not() {
    for walks in [false, true] {
        let mut stage = Stage::new();
        let at = |frame: u32| walking(if walks { frame } else { 0 });
        for i in 0..12_u32 {
            stage.frame(&at(i), &at(i.saturating_sub(1)));
            assert_eq!(stage.largest(View::Lambda), 0.0, "frame {i}, walking: {walks}");
        }
        // In twelve frames, each pixel repeats a path at least once, and is not a new sample then.
        let longest = stage.largest(View::HistoryLength);
        assert!((10.0..12.0).contains(&longest), "walking: {walks}, {longest}");
    }
}

#[test]
fn a_motion_in_16_bits_costs_next_to_no_history() {
    let mut stage = Stage::new();
    for i in 0..12_u32 {
        stage.frame_in_16_bits(&walking(4 * i), &walking(4 * i.saturating_sub(1)));
        let lambda = stage.view(View::Lambda);
        let mean = lambda.iter().map(|l| l[0]).sum::<f32>() / lambda.len() as f32;
        assert!(mean < 1e-3, "frame {i}: {mean}");
    }
}

#[test]
fn a_lamp_that_dims_is_followed_at_once() {
    let (bright, dim) = (Moment::at(0), Moment { radiance: 1.0, ..Moment::at(0) });
    let mut stage = Stage::new();
    (0..12).for_each(|_| stage.frame(&bright, &bright));
    (0..3).for_each(|_| stage.frame(&dim, &dim));
    let followed = colors(&stage.target);
    let mut fresh = Stage::new();
    (0..40).for_each(|_| fresh.frame(&dim, &dim));
    let [_, mean] = difference(&followed, &colors(&fresh.target));
    assert!(mean < 0.05, "{mean} of the image is wrong three frames after");
}

#[test]
fn what_a_ball_leaves_behind_is_forgotten() {
    let mut stage = Stage::new();
    (0..12_u32).for_each(|i| stage.frame(&Moment::at(4 * i), &Moment::at(4 * i.saturating_sub(1))));
    let lambda = stage.view(View::Lambda);
    assert!(
        lambda.iter().any(|l| l[0] > 0.02),
        "{:?}: a shadow moved",
        lambda.iter().map(|l| l[0]).fold(0.0, f32::max)
    );
    assert_eq!(stage.largest(View::NonFinite), 0.0);
}

#[test]
fn denoisers_of_two_sizes_share_an_encoder() {
    let sizes = [SIZE, [41, 23]];
    let frames = |stage: &mut Stage| {
        for frame in 0..4 {
            stage.frame(&Moment::at(frame), &Moment::at(frame.saturating_sub(1)));
        }
        colors(&stage.target)
    };
    let alone = sizes.map(|size| frames(&mut Stage::of_size(size)));
    let mut together = sizes.map(Stage::of_size);
    for frame in 0..4 {
        gpu().submit(|encoder| {
            for stage in &mut together {
                stage.record(encoder, &Moment::at(frame), &Moment::at(frame.saturating_sub(1)));
            }
        });
    }
    assert_eq!(together.map(|stage| colors(&stage.target)), alone);
}

#[test]
fn the_sky_is_shown_as_it_is() {
    let mut stage = Stage::new();
    (0..3).for_each(|_| stage.frame(&Moment::at(0), &Moment::at(0)));
    let depth = stage.view(View::Depth);
    let image = colors(&stage.target);
    let sky: Vec<_> = image.iter().zip(&depth).filter(|(_, d)| d[0] == 0.0).map(|(c, _)| *c).collect();
    assert!(sky.len() > 200, "there is some sky");
    for c in sky {
        for (found, written) in c.into_iter().zip([0.3_f32, 0.45, 0.7]) {
            // The value went through f16 and 18 bits.
            assert!((found - written).abs() < 1e-3 * written, "{c:?}");
        }
    }
}

#[test]
fn a_wrong_motion_is_seen() {
    let mut stage = Stage::new();
    (0..3_u32).for_each(|i| stage.frame(&walking(10 * i), &walking(10 * i.saturating_sub(1))));
    assert!(stage.largest(View::Motion) > 1.0, "the camera moves");
    // Motion is stored in steps of 1/256.
    assert!(stage.largest(View::MotionError) < 2.1e-3, "{}", stage.largest(View::MotionError));
    // Motion with the wrong sign is noticed.
    let wrong: Vec<[f32; 2]> = stage.view(View::Motion).iter().map(|m| [-m[0], -m[1]]).collect();
    stage.motion = Some(super::upload(gpu(), SIZE, &wrong));
    stage.frame(&walking(30), &walking(20));
    assert!(stage.largest(View::MotionError) > 1.0);
    // A rolling ball differs, and nothing else.
    let mut rolling = Stage::new();
    let at = |i: u32| Moment { ball: Moment::at(10 * i).ball, ..walking(10 * i) };
    (0..3_u32).for_each(|i| rolling.frame(&at(i), &at(i.saturating_sub(1))));
    let (error, albedo) = (rolling.view(View::MotionError), rolling.view(View::Albedo));
    for (e, a) in error.iter().zip(&albedo) {
        let ball = a[0] > 2.0 * a[2] && a[0] < 0.9;
        assert_eq!(e[0].hypot(e[1]) > 0.1, ball, "{e:?} where the albedo is {a:?}");
    }
}
