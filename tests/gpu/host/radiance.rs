//! Radiance with and without its albedo and emission, and the modes without a filter.

use super::{Recorded, SIZE, Uploaded, colors, denoiser, difference, recorded, replay, reshading, target, upload};
use crate::common::gpu::gpu;
use crate::common::statistics::Rgb;
use asvgf::{Mode, Settings, Shading};

/// An emission image with a bright rectangle.
fn emission() -> Vec<Rgb> {
    let inside = |i: u32| (10..20).contains(&(i % SIZE[0])) && (5..15).contains(&(i / SIZE[0]));
    (0..SIZE[0] * SIZE[1]).map(|i| if inside(i) { [4.0, 2.0, 0.5] } else { [0.0; 3] }).collect()
}

/// Full radiance: light times albedo plus emission.
fn full(frame: &Recorded, emission: &[Rgb]) -> Vec<Rgb> {
    let pixel = |i: usize| [0, 1, 2].map(|c| frame.light[i][c] * frame.albedo[i][c].max(1e-3) + emission[i][c]);
    (0..emission.len()).map(pixel).collect()
}

#[test]
fn the_full_image_and_its_parts_are_denoised_alike() {
    let frames = recorded(Settings::adaptive());
    let (mut whole, mut parts) = (denoiser(reshading()), denoiser(reshading()));
    let [a, b] = [0; 2].map(|_| target());
    let emitted = emission();
    let glow = upload(gpu(), SIZE, &emitted);
    for frame in &frames {
        let host = Uploaded::new(gpu(), frame);
        let image = upload(gpu(), SIZE, &full(frame, &emitted));
        gpu().submit(|encoder| {
            whole.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
            let shading = Shading { emission: Some(&glow), demodulated: false, radiance: &image, ..host.shading(&a) };
            whole.denoise(&gpu().device, encoder, &shading).unwrap();
            parts.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
            let shading = Shading { emission: Some(&glow), ..host.shading(&b) };
            parts.denoise(&gpu().device, encoder, &shading).unwrap();
        });
        let found = difference(&colors(&a), &colors(&b));
        // Beside an emission 100 times as bright, the light loses two digits when the emission is subtracted. Albedos are rounded to f16.
        assert!(found[0] < 2e-2 && found[1] < 1e-3, "frame {}: {found:?}", frame.index);
    }
    // Emission bypasses the filter, so it stays as sharp as the input.
    let dark = replay(&mut denoiser(reshading()), &frames);
    for (i, lit) in colors(&b).iter().enumerate() {
        for c in 0..3 {
            let added = lit[c] - dark[dark.len() - 1][i][c];
            assert!((added - emitted[i][c]).abs() < 1e-4 * (1.0 + emitted[i][c]), "pixel {i}: {added}");
        }
    }
}

#[test]
fn the_target_may_be_the_radiance() {
    let frames = recorded(Settings::adaptive());
    let (mut inside, mut apart) = (denoiser(reshading()), denoiser(reshading()));
    for frame in &frames[..3] {
        let host = Uploaded::new(gpu(), frame);
        let usage = wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::STORAGE_BINDING
            | wgpu::TextureUsages::COPY_DST
            | wgpu::TextureUsages::COPY_SRC;
        let both = gpu().texture(SIZE, wgpu::TextureFormat::Rgba32Float, usage);
        let (view, other) = (both.create_view(&Default::default()), target());
        let bytes: Vec<u8> =
            frame.light.iter().flat_map(|c| [c[0], c[1], c[2], 1.0]).flat_map(f32::to_le_bytes).collect();
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * SIZE[0]), rows_per_image: None };
        gpu().queue.write_texture(both.as_image_copy(), &bytes, layout, both.size());
        gpu().submit(|encoder| {
            inside.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
            inside.denoise(&gpu().device, encoder, &Shading { radiance: &view, ..host.shading(&view) }).unwrap();
            apart.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
            apart.denoise(&gpu().device, encoder, &host.shading(&other)).unwrap();
        });
        assert_eq!(colors(&view), colors(&other));
    }
}

#[test]
fn the_modes_without_a_filter_show_the_samples_and_their_mean() {
    let frames = recorded(Settings::adaptive());
    let noisy = replay(&mut denoiser(Settings { mode: Mode::Noisy, ..Settings::adaptive() }), &frames[..3]);
    let none = vec![[0.0; 3]; frames[0].light.len()];
    for (image, frame) in noisy.iter().zip(&frames) {
        assert!(difference(image, &full(frame, &none))[0] < 1e-2, "frame {}", frame.index);
    }
    // A mean needs frames with the same camera.
    let still: Vec<Recorded> = frames[..4].iter().map(|f| Recorded { camera: frames[0].camera, ..f.clone() }).collect();
    let means = replay(&mut denoiser(Settings { mode: Mode::Reference, ..Settings::adaptive() }), &still);
    let mean: Vec<Rgb> = (0..none.len())
        .map(|i| [0, 1, 2].map(|c| still.iter().map(|f| full(f, &none)[i][c]).sum::<f32>() / 4.0))
        .collect();
    assert!(difference(&means[3], &mean)[0] < 1e-2);
    let moving = replay(&mut denoiser(Settings { mode: Mode::Reference, ..Settings::adaptive() }), &frames[..3]);
    assert_eq!(moving, noisy, "the camera moves, so each frame is a mean of one");
}

/// Ink that reflects nothing, between paper that does, borrows next to no light from the paper, and takes none away.
#[test]
fn black_texels_stay_black() {
    let frames = recorded(Settings::adaptive());
    let (mut printed, mut blank) = (denoiser(Settings::adaptive()), denoiser(Settings::adaptive()));
    let is_ink = |i: usize| (i % SIZE[0] as usize + i / SIZE[0] as usize).is_multiple_of(2);
    for frame in &frames[..6] {
        let mut ink = frame.clone();
        (0..ink.albedo.len()).filter(|&i| is_ink(i)).for_each(|i| ink.albedo[i] = [0.0; 3]);
        let images = [(&mut printed, &ink), (&mut blank, frame)].map(|(denoiser, frame)| {
            let (host, target) = (Uploaded::new(gpu(), frame), target());
            let full: Vec<Rgb> =
                frame.light.iter().zip(&frame.albedo).map(|(l, a)| [0, 1, 2].map(|c| l[c] * a[c])).collect();
            let radiance = upload(gpu(), SIZE, &full);
            gpu().submit(|encoder| {
                denoiser.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
                let shading = Shading { radiance: &radiance, demodulated: false, ..host.shading(&target) };
                denoiser.denoise(&gpu().device, encoder, &shading).unwrap();
            });
            colors(&target)
        });
        let mean = |image: &[Rgb], ink: bool| {
            let some: Vec<Rgb> = (0..image.len()).filter(|&i| is_ink(i) == ink).map(|i| image[i]).collect();
            crate::common::statistics::mean(&some)
        };
        let (black, paper, expected) = (mean(&images[0], true), mean(&images[0], false), mean(&images[1], false));
        println!("frame {}: ink {black:.5}, paper {paper:.4}, without ink {expected:.4}", frame.index);
        // Ink without light is shown black.
        assert!((paper / expected - 1.0).abs() < 0.06, "frame {}: paper of {paper}, not {expected}", frame.index);
        assert!(black < 0.02 * expected, "frame {}: ink of {black} on paper of {paper}", frame.index);
    }
}
