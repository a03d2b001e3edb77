//! A host's own images, read in place, have the same effect as copies of them.

use super::{Recorded, SIZE, Uploaded, colors, recorded, target, upload};
use crate::common::gpu::gpu;
use crate::common::statistics::Rgb;
use asvgf::{Denoiser, DenoiserDescriptor, FilterSettings, Gradient, Lambda, Mode, Pairs, Settings, Shading};
use wgpu::{TextureFormat, TextureUsages, TextureView};

/// The form in which the host hands in its light.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Light {
    Alone,
    Modulated,
    Demodulated,
}

/// A frame with some invalid values.
fn soiled(frame: &Recorded) -> Recorded {
    let mut frame = frame.clone();
    for (k, i) in (0..frame.light.len() - 4).step_by(11).enumerate() {
        frame.light[i][k % 3] = [f32::NAN, f32::INFINITY, -1.0, 1e30][k % 4];
        frame.motion[i + 1][k % 2] = [f32::NAN, f32::NEG_INFINITY, 1e30][k % 3];
        frame.previous_depth[i + 2] = [f32::NAN, -1.0, 0.0][k % 3];
        frame.albedo[i + 3][k % 3] = [f32::NAN, 0.0, -1.0, 1e30][k % 4];
        frame.depth[i + 4] = 0.0;
    }
    frame
}

/// A texture that serves as radiance and target, with an image in it.
fn target_with(image: &[Rgb]) -> TextureView {
    let usage = TextureUsages::TEXTURE_BINDING
        | TextureUsages::STORAGE_BINDING
        | TextureUsages::COPY_DST
        | TextureUsages::COPY_SRC;
    let texture = gpu().texture(SIZE, TextureFormat::Rgba32Float, usage);
    let texels: Vec<[f32; 4]> = image.iter().map(|&[r, g, b]| [r, g, b, 1.0]).collect();
    let bytes_per_row = Some(16 * SIZE[0]);
    gpu().queue.write_texture(
        texture.as_image_copy(),
        bytemuck::cast_slice(&texels),
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None },
        texture.size(),
    );
    texture.create_view(&Default::default())
}

/// The denoised frames, and the bytes of the denoiser.
fn denoise(
    settings: &Settings,
    frames: &[Recorded],
    light: Light,
    views: bool,
    in_target: bool,
) -> (Vec<Vec<Rgb>>, u64) {
    let descriptor = DenoiserDescriptor { size: SIZE, settings: settings.clone(), views, ..Default::default() };
    let mut denoiser = Denoiser::new(&gpu().device, &gpu().queue, &descriptor).unwrap();
    let mut images = Vec::new();
    for frame in frames {
        let host = Uploaded::new(gpu(), frame);
        let lambda = upload(gpu(), SIZE, &vec![[0.3_f32]; frame.light.len()]);
        let pair = |value: f32| upload(gpu(), SIZE.map(|s| s.div_ceil(3)), &vec![[value]; 16 * 12]);
        let [now, before] = [pair(0.5), pair(0.4)];
        let target = if in_target { target_with(&frame.light) } else { target() };
        let shading = Shading {
            albedo: (light != Light::Alone).then_some(&host.albedo),
            // Any image will do as emission.
            emission: (light == Light::Modulated).then_some(&host.normal),
            demodulated: light == Light::Demodulated,
            lambda: Some(Lambda { view: &lambda, block: 1, confidence: false }),
            pairs: Some(Pairs { current: &now, previous: &before, in_place: false }),
            ..Shading::new(if in_target { &target } else { &host.light }, &target)
        };
        gpu().submit(|encoder| {
            denoiser.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
            denoiser.denoise(&gpu().device, encoder, &shading).unwrap();
        });
        images.push(colors(&target));
    }
    let plan = denoiser.plan().unwrap();
    assert_eq!(denoiser.memory(), plan.bytes(SIZE, views), "what was planned is what was made");
    (images, denoiser.memory())
}

fn check(settings: &Settings, light: Light) {
    let frames: Vec<Recorded> = recorded(Settings::adaptive())[..3].iter().map(soiled).collect();
    let (direct, least) = denoise(settings, &frames, light, false, false);
    let (copied, most) = denoise(settings, &frames, light, true, false);
    let (in_target, between) = denoise(settings, &frames, light, false, true);
    let what = format!("{:?}, {:?}, {light:?}", settings.mode, settings.filter.gradient);
    println!("{what}: {least}, {between} and {most} bytes");
    assert!(direct.iter().flatten().flatten().all(|c| c.is_finite() && *c >= 0.0), "{what}");
    assert_eq!(direct, copied, "{what}: copied");
    assert_eq!(direct, in_target, "{what}: from the target");
    assert!(least <= between && between < most, "{what}");
}

fn with(gradient: Gradient) -> Settings {
    Settings { filter: FilterSettings { gradient, ..Default::default() }, ..Settings::adaptive() }
}

#[test]
fn a_constant_alpha_makes_the_same_of_them() {
    for light in [Light::Alone, Light::Modulated, Light::Demodulated] {
        check(&with(Gradient::Off), light);
    }
}

#[test]
fn a_hosts_lambda_and_pairs_make_the_same_of_them() {
    check(&with(Gradient::Lambda), Light::Alone);
    check(&with(Gradient::Pairs), Light::Modulated);
}

#[test]
fn modes_that_do_not_filter_show_the_same() {
    for mode in [Mode::Noisy, Mode::Reference] {
        check(&Settings { mode, ..with(Gradient::Off) }, Light::Modulated);
        check(&Settings { mode, ..with(Gradient::Reshade) }, Light::Alone);
    }
}
