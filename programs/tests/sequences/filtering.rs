//! Sequences through the filter.

use crate::folder::{Folder, Frames, add, random, wall};
use crate::shared::shared;
use asvgf::image_io::write_exr_rgb;
use asvgf::scene::{GpuScene, builtin};
use asvgf::{Camera, FilterSettings, Gradient, Settings, View};
use asvgf_programs::denoise::look_ahead;
use asvgf_programs::film::Film;
use asvgf_programs::gpu::Gpu;
use asvgf_programs::score::scoring::{self, Scores};
use asvgf_programs::sequence::Sequence;
use asvgf_programs::sequence::export::{self, Export};
use asvgf_programs::sequence::layers::Layer;
use asvgf_programs::tracing;
use std::path::Path;

const SIZE: [u32; 2] = [48, 27];

fn with_gradient(gradient: Gradient) -> Settings {
    Settings { filter: FilterSettings { gradient, ..Default::default() }, ..Settings::adaptive() }
}

/// Denoises, and returns each frame.
fn denoised(sequence: &Sequence, settings: Settings) -> Vec<Vec<[f32; 3]>> {
    told(sequence, settings).0
}

/// Denoises, and returns each frame, and the first that repeats the noise of the one before.
fn told(sequence: &Sequence, settings: Settings) -> (Vec<Vec<[f32; 3]>>, Option<i64>) {
    let gpu = Gpu::new().unwrap();
    let mut film = Film::new(&gpu, sequence.size, settings).unwrap();
    let mut frames = Vec::new();
    let denoised = look_ahead::denoise(&mut film, None, sequence, &mut Frames(&mut frames));
    let denoised = denoised.unwrap();
    assert!(denoised.times.iter().all(|passes| !passes.is_empty()));
    (frames, denoised.repeated)
}

/// Renders frames of a built-in scene, exports them, and denoises the export. Returns the sequence, the images of the path tracer's
/// denoiser, and those of the sequence's.
fn there_and_back(name: &str) -> (Sequence, [Vec<Vec<[f32; 3]>>; 2]) {
    let folder = Folder::new();
    let gpu = Gpu::new().unwrap();
    let scene = builtin::scene(name, "all").unwrap();
    let mut uploaded = GpuScene::new(&gpu.device, &gpu.queue, &scene).unwrap();
    let mut film = Film::new(&gpu, SIZE, Settings::adaptive()).unwrap();
    let (mut expected, mut cameras, mut frames) = (Vec::new(), Vec::new(), Export::default());
    // The lamp comes back on in frame 60.
    for frame in 56..62 {
        let pose = scene.pose(Some(0), frame as f32 / 30.0);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        uploaded.update(&gpu.device, &mut encoder, &pose).unwrap();
        gpu.queue.submit([encoder.finish()]);
        let seen = scene.camera_view(&pose, scene.camera_node().unwrap()).unwrap();
        let camera = Camera { jitter: [0.2, -0.3], ..seen };
        // The files' numbers do not matter: the denoiser's begin with 0.
        tracing::render(&mut film, &uploaded, camera, frame - 56).unwrap();
        expected.push(film.numbers(View::Denoised).unwrap());
        frames.write(&folder.0.join(format!("frame_{frame:04}.exr")), &mut film).unwrap();
        cameras.push(camera);
    }
    export::write_manifest(&folder.0, SIZE, &cameras).unwrap();
    let sequence = folder.open().unwrap();
    let found = denoised(&sequence, with_gradient(Gradient::Pairs));
    (sequence, [found, expected])
}

#[test]
fn the_path_tracers_frames_give_the_image_that_it_made_of_them() {
    let (sequence, [found, expected]) = there_and_back("cornell");
    assert!(
        sequence.in_place
            && Layer::ALL.iter().take_while(|&&layer| layer != Layer::Lambda).all(|&layer| sequence.has(layer))
            && !sequence.has(Layer::Specular)
    );
    for (frame, (found, expected)) in found.iter().zip(&expected).enumerate() {
        for (a, b) in found.as_flattened().iter().zip(expected.as_flattened()) {
            // Colours between passes have a precision of 2⁻¹¹, and one rounding may go either way.
            assert!((a - b).abs() <= 2e-3 * b.abs() + 1e-4, "frame {frame}: {a} is not {b}");
        }
    }
}

#[test]
fn frames_with_specular_light_give_the_image_that_the_path_tracer_made_of_them() {
    let (sequence, [found, expected]) = there_and_back("gloss");
    let layers = Layer::ALL.iter().take_while(|&&layer| layer != Layer::GlossyDirect);
    assert!(layers.filter(|&&layer| layer != Layer::Lambda).all(|&layer| sequence.has(layer)));
    for (frame, (found, expected)) in found.iter().zip(&expected).enumerate() {
        let pairs = || found.as_flattened().iter().zip(expected.as_flattened());
        let far = pairs().filter(|(a, b)| (*a - *b).abs() > 2e-3 * b.abs() + 1e-4).count();
        let difference: f64 = pairs().map(|(a, b)| f64::from((a - b).abs())).sum();
        let level: f64 = pairs().map(|(_, b)| f64::from(*b)).sum();
        // Measured: at most 2.4e-3 of the light, and 361 numbers apart.
        let said =
            format!("frame {frame}: {:.1e} of the light, {far} of {} apart", difference / level, pairs().count());
        assert!(difference <= 4e-3 * level && 8 * far <= pairs().count(), "{said}");
    }
}

#[test]
fn the_least_that_a_sequence_may_have_stays_what_it_is() {
    let folder = Folder::with_frames();
    for frame in denoised(&folder.open().unwrap(), with_gradient(Gradient::Off)) {
        assert!(frame.as_flattened().iter().all(|x| (x - 0.5).abs() < 1e-3), "a grey wall: {frame:?}");
    }
}

#[test]
fn a_light_that_reflects_nothing_is_kept_out_of_the_filter() {
    let folder = Folder::new();
    for frame in 0..3 {
        let mut image = wall([12, 8]);
        add(&mut image, Layer::Albedo, &[0.5; 3]);
        add(&mut image, Layer::Emission, &[0.0; 3]);
        for (name, samples) in &mut image.channels {
            let lit = if name.starts_with("albedo") { 0.0 } else { 7.0 };
            if !name.starts_with("normal") && !name.starts_with("depth") {
                samples[40] = lit;
            }
        }
        folder.write(frame, &image);
    }
    for frame in denoised(&folder.open().unwrap(), with_gradient(Gradient::Off)) {
        for (i, pixel) in frame.iter().enumerate() {
            let expected = if i == 40 { 7.0 } else { 0.5 };
            assert!(pixel.iter().all(|x| (x - expected).abs() < 1e-2), "pixel {i}: {pixel:?} is not {expected}");
        }
    }
}

/// Writes a wall whose radiance is a function of pixel and frame.
fn painted(folder: &Folder, frames: u32, size: [u32; 2], radiance: &dyn Fn(u32, u32) -> f32) {
    for frame in 0..frames {
        let mut image = wall(size);
        for (_, samples) in image.channels.iter_mut().take(3) {
            samples.iter_mut().enumerate().for_each(|(i, x)| *x = radiance(frame, i as u32));
        }
        folder.write(frame, &image);
    }
}

#[test]
fn frames_with_the_same_noise_are_told_and_denoised_one_by_one() {
    let size = [24, 16];
    let (fixed, fresh, smooth) = (Folder::new(), Folder::new(), Folder::new());
    painted(&fixed, 6, size, &|_, i| 2.0 * random(i, 7));
    painted(&fresh, 6, size, &|frame, i| 2.0 * random(i, frame));
    painted(&smooth, 6, size, &|_, i| 1.0 + 0.5 * (0.2 * (i % 24) as f32).sin());
    let settings = || Settings::adaptive().constant(0.2);
    let (frames, repeated) = told(&fixed.open().unwrap(), settings());
    assert_eq!(repeated, Some(2), "two in a row");
    let error = |frame: &[[f32; 3]]| frame.iter().map(|c| f64::from(c[0] - 1.0).powi(2)).sum::<f64>();
    for (i, frame) in frames.iter().enumerate() {
        assert!(error(frame) <= if i == 1 { 1.5 } else { 1.01 } * error(&frames[0]), "frame {i}");
    }
    // Noise that differs is averaged, and a frame without noise may well stay the same.
    let mut bare = settings();
    bare.filter.iterations = 0;
    let (frames, repeated) = told(&fresh.open().unwrap(), bare);
    assert!(repeated.is_none() && error(&frames[5]) < 0.3 * error(&frames[0]));
    assert_eq!(told(&smooth.open().unwrap(), settings()).1, None);
    // Each frame is held for another.
    let held = Folder::new();
    painted(&held, 8, size, &|frame, i| 2.0 * random(i, frame / 2));
    assert_eq!(told(&held.open().unwrap(), settings()).1, None);
}

#[test]
fn what_glows_faintly_and_is_lit_is_filtered_whatever_its_albedo() {
    let (size, mirror) = ([24, 16], |i: u32| (6..18).contains(&(i % 24)) && (4..12).contains(&(i / 24)));
    let folder = Folder::new();
    for frame in 0..8 {
        let mut image = wall(size);
        add(&mut image, Layer::Albedo, &[0.5; 3]);
        add(&mut image, Layer::Emission, &[0.0; 3]);
        for (name, samples) in &mut image.channels {
            for (i, x) in samples.iter_mut().enumerate().filter(|(i, _)| mirror(*i as u32)) {
                match name.as_str() {
                    "albedo.R" | "albedo.G" | "albedo.B" => *x = 0.0,
                    "emission.R" | "emission.G" | "emission.B" => *x = 0.01,
                    "R" | "G" | "B" => *x = 0.01 + 2.0 * random(i as u32, frame),
                    _ => {}
                }
            }
        }
        folder.write(frame, &image);
    }
    let frames = denoised(&folder.open().unwrap(), Settings::adaptive().constant(0.2));
    let of_mirror = || frames[7].iter().enumerate().filter(|(i, _)| mirror(*i as u32)).map(|(_, c)| f64::from(c[0]));
    let mean = of_mirror().sum::<f64>() / of_mirror().count() as f64;
    let deviation = (of_mirror().map(|x| (x - mean).powi(2)).sum::<f64>() / of_mirror().count() as f64).sqrt();
    println!("a mirror of 1.01 with noise of 0.58: {mean:.3}, with noise of {deviation:.3}");
    assert!((mean / 1.01 - 1.0).abs() < 0.1 && deviation < 0.15);
    let wall = frames[7].iter().enumerate().filter(|(i, _)| !mirror(*i as u32));
    assert!(wall.into_iter().all(|(_, c)| (c[0] - 0.5).abs() < 0.05), "the wall beside it stays what it is");
}

#[test]
fn frames_of_a_still_scene_have_all_the_same_layers() {
    let folder = Folder::new();
    let gpu = Gpu::new().unwrap();
    let scene = builtin::scene("pillars", "static").unwrap();
    let uploaded = GpuScene::new(&gpu.device, &gpu.queue, &scene).unwrap();
    let mut film = Film::new(&gpu, SIZE, Settings::adaptive()).unwrap();
    let camera = scene.camera_view(&scene.pose(None, 0.0), scene.camera_node().unwrap()).unwrap();
    let (mut expected, mut frames) = (Vec::new(), Export::default());
    for frame in 0..4 {
        tracing::render(&mut film, &uploaded, camera, frame).unwrap();
        expected.push(film.numbers(View::Denoised).unwrap());
        frames.write(&folder.0.join(format!("frame_{frame:04}.exr")), &mut film).unwrap();
    }
    export::write_manifest(&folder.0, SIZE, &[camera; 4]).unwrap();
    let sequence = folder.open().unwrap();
    assert!(sequence.has(Layer::GradientCurrent) && sequence.has(Layer::Motion));
    let found = denoised(&sequence, with_gradient(Gradient::Pairs));
    for (frame, (found, expected)) in found.iter().zip(&expected).enumerate() {
        let difference: f64 =
            found.as_flattened().iter().zip(expected.as_flattened()).map(|(a, b)| f64::from((a - b).abs())).sum();
        let level: f64 = expected.as_flattened().iter().map(|x| f64::from(*x)).sum();
        assert!(difference < 1e-3 * level, "frame {frame}: {difference} of {level}");
    }
}

/// Files of an earlier `render`: pairs in the first frame alone.
#[test]
fn a_frame_without_pairs_has_none() {
    let folder = Folder::new();
    for frame in 0..3 {
        let mut image = wall([12, 8]);
        if frame == 1 {
            add(&mut image, Layer::GradientCurrent, &[-1.0; 3]);
            add(&mut image, Layer::GradientPrevious, &[-1.0; 3]);
        }
        folder.write(frame, &image);
    }
    let sequence = folder.open().unwrap();
    assert!(sequence.has(Layer::GradientCurrent));
    for frame in denoised(&sequence, with_gradient(Gradient::Pairs)) {
        assert!(frame.as_flattened().iter().all(|x| (x - 0.5).abs() < 1e-3), "a grey wall");
    }
}

#[test]
fn lambda_from_outside_drops_history() {
    let folder = Folder::new();
    for frame in 0..4 {
        let mut image = wall([12, 8]);
        // The light doubles in the last frame, and λ is 1 on the left only.
        let doubled = if frame == 3 { 2.0 } else { 1.0 };
        image.channels.iter_mut().take(3).for_each(|(_, samples)| samples.iter_mut().for_each(|x| *x *= doubled));
        add(&mut image, Layer::Lambda, &[0.0]);
        let lambda = image.channels.last_mut().unwrap();
        lambda
            .1
            .iter_mut()
            .enumerate()
            .filter(|(i, _)| i % 12 < 6)
            .for_each(|(_, l)| *l = if frame == 3 { 1.0 } else { 0.0 });
        folder.write(frame, &image);
    }
    let frames = denoised(&folder.open().unwrap(), with_gradient(Gradient::Lambda));
    let [left, right] = [frames[3][48][0], frames[3][59][0]];
    assert!((left - 1.0).abs() < 0.05 && right < 0.7, "left {left}, right {right}");
}

/// Denoises a sequence into files, and compares them with references.
fn scores(sequence: &Sequence, input: &Path, references: &Path, settings: Settings) -> Scores {
    let out = Folder::new();
    for (i, frame) in denoised(sequence, settings).iter().enumerate() {
        let [width, height] = sequence.size;
        write_exr_rgb(out.0.join(format!("denoised_{i:04}.exr")), width, height, frame).unwrap();
    }
    let scores = scoring::score(&out.0, input, references).unwrap();
    println!("{scores}");
    scores
}

/// A shadow's edge wanders over a wall, under noise, with pairs and with the truth.
#[test]
fn a_wandering_shadow_comes_as_close_to_the_truth_as_it_should() {
    let size @ [width, height] = [48, 33];
    let light = |frame: u32, i: u32| if i % width < 12 + 2 * frame { 0.1 } else { 1.0 };
    let noise = |frame: u32, i: u32| 2.0 * random(i, frame);
    // The pixel at each stratum's centre has the last frame's path as well, in the light of both.
    let pair = |of: u32, frame: u32, i: u32| {
        let repeats = frame > 0 && i % width % 3 == 1 && i / width % 3 == 1;
        if repeats { light(of, i) * noise(frame - 1, i) } else { -1.0 }
    };
    let (input, references) = (Folder::new(), Folder::new());
    for frame in 0..12 {
        let mut image = wall(size);
        let each = |value: &dyn Fn(u32) -> f32| (0..width * height).map(value).collect::<Vec<f32>>();
        for (_, samples) in image.channels.iter_mut().take(3) {
            *samples = each(&|i| light(frame, i) * noise(frame, i));
        }
        let layers = [(Layer::GradientCurrent, frame), (Layer::GradientPrevious, frame.saturating_sub(1))];
        for (layer, of) in layers {
            image.channels.extend(layer.channels().into_iter().map(|name| (name, each(&|i| pair(of, frame, i)))));
        }
        input.write(frame, &image);
        let truth: Vec<[f32; 3]> = (0..width * height).map(|i| [light(frame, i); 3]).collect();
        write_exr_rgb(references.0.join(format!("reference_{frame:04}.exr")), width, height, &truth).unwrap();
    }
    let of = |gradient| scores(&input.open().unwrap(), &input.0, &references.0, with_gradient(gradient));
    let [pairs, off] = [Gradient::Pairs, Gradient::Off].map(of);
    assert!(pairs.rel_mse <= 0.5 && pairs.bias.abs() <= 0.03 && pairs.flicker <= 0.125, "{pairs}");
    assert!(off.rel_mse > 2.0 * pairs.rel_mse, "without pairs, shadows lag: {off}");
}

/// Frames and references of `move_object`, which Mitsuba rendered (docs/filter.md). The prototype described there reaches
/// a relMSE of 0.0033, a bias of −1.0 % and a flicker of 0.061.
#[test]
fn another_renderers_frames_come_as_close_to_the_truth_as_they_should() {
    let Some(input) = shared("sequences/move_object") else { return };
    let sequence = Sequence::open(input.as_path(), |_| {}).unwrap();
    let scores = scores(&sequence, &input, &input, with_gradient(Gradient::Pairs));
    assert!(scores.rel_mse <= 0.0037 && scores.bias.abs() <= 0.015 && scores.flicker <= 0.065, "{scores}");
}
