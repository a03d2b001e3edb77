//! A host with an orthographic camera: a plane at any angle is one surface, and is found again when the camera moves.

use super::{SIZE, denoiser, target, upload, view};
use crate::common::gpu::gpu;
use crate::common::statistics::{Rgb, mean};
use asvgf::{FilterSettings, Gradient, Matrices, Settings, Shading, Surfaces, View};

const HALF: [f32; 2] = [2.0, 1.5];
const EYE: f32 = 5.0;

/// A camera that looks along −Z from (x, 0, 5).
fn camera(x: f32) -> Matrices {
    let view = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [-x, 0.0, -EYE, 1.0]];
    // Depths of 0…50 become 0…1.
    let projection =
        [[1.0 / HALF[0], 0.0, 0.0, 0.0], [0.0, 1.0 / HALF[1], 0.0, 0.0], [0.0, 0.0, -0.02, 0.0], [0.0, 0.0, 0.0, 1.0]];
    Matrices { view, projection, jitter: [0.0; 2] }
}

/// Depth and normal under a pixel, of two planes that meet at world x = 0, one steeper than the other.
fn seen(pixel: usize, x: f32) -> (f32, Rgb) {
    let [column, row] = [pixel as u32 % SIZE[0], pixel as u32 / SIZE[0]].map(|i| i as f32 + 0.5);
    let at = x + (2.0 * column / SIZE[0] as f32 - 1.0) * HALF[0];
    let up = (1.0 - 2.0 * row / SIZE[1] as f32) * HALF[1];
    // The planes are z = slope·x + 0.5·y.
    let slope = if at < 0.0 { 2.0 } else { -0.5 };
    let length = (slope * slope + 0.25 + 1.0_f32).sqrt();
    (EYE - slope * at - 0.5 * up, [-slope / length, -0.5 / length, 1.0 / length])
}

fn random(i: u32) -> f32 {
    let mut x = i.wrapping_mul(0x9e37_79b9);
    for _ in 0..3 {
        x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
    }
    (x >> 8) as f32 / 16_777_216.0
}

#[test]
fn planes_are_filtered_and_followed_in_an_orthographic_view() {
    let count = (SIZE[0] * SIZE[1]) as usize;
    let filter = FilterSettings { gradient: Gradient::Off, ..Default::default() };
    let mut denoiser = denoiser(Settings { filter, ..Settings::adaptive() });
    let target = target();
    // The camera moves a third of a pixel to the right in each frame.
    let step = 2.0 * HALF[0] / SIZE[0] as f32 / 3.0;
    let frames = 8;
    for index in 0..frames {
        let x = step * index as f32;
        let surfaces: Vec<(f32, Rgb)> = (0..count).map(|i| seen(i, x)).collect();
        let depth = upload(gpu(), SIZE, &surfaces.iter().map(|s| [s.0]).collect::<Vec<_>>());
        let normal = upload(gpu(), SIZE, &surfaces.iter().map(|s| s.1).collect::<Vec<_>>());
        let motion = upload(gpu(), SIZE, &vec![[1.0_f32 / 3.0, 0.0]; count]);
        let light: Vec<Rgb> = (0..count as u32).map(|i| [-(1.0 - random(i + index * 7919)).ln(); 3]).collect();
        let light = upload(gpu(), SIZE, &light);
        gpu().submit(|encoder| {
            let surfaces = Surfaces::new(camera(x), index, &depth, &normal, &motion);
            denoiser.begin_frame(&gpu().device, encoder, &surfaces).unwrap();
            denoiser.denoise(&gpu().device, encoder, &Shading::new(&light, &target)).unwrap();
        });
    }
    let lengths = view(&mut denoiser, View::HistoryLength);
    let at_border = |i: usize| (i as u32 % SIZE[0]) + 4 >= SIZE[0];
    // The fold's own pixels change from one plane to the other.
    let found = |i: usize| lengths[i][0] > frames as f32 - 1.5;
    let lost = (0..count).filter(|&i| !at_border(i) && !found(i)).count();
    assert!(lost <= 2 * SIZE[1] as usize, "{lost} pixels lost their history");
    let image = view(&mut denoiser, View::Denoised);
    let deviation = (image.iter().map(|c| f64::from(c[0] - 1.0).powi(2)).sum::<f64>() / count as f64).sqrt();
    println!("noise of 1 becomes {deviation:.4}; a mean of 8 alone has 0.35");
    assert!((mean(&image) - 1.0).abs() < 0.05 && deviation < 0.12, "{deviation}");
    // Points at rest follow from the cameras alone, so the motion is right everywhere.
    let error = view(&mut denoiser, View::MotionError);
    assert!(error.iter().all(|c| c[0].abs() < 0.01), "{:?}", error.iter().map(|c| c[0]).fold(0.0, f32::max));
}
