//! The formats of renderers, each against the encoded values.

use super::{denoiser, upload_bytes};
use crate::common::gpu::gpu;
use crate::common::plane::{V, dot, unit};
use asvgf::{Camera, FilterSettings, Gradient, Settings, Shading, Surfaces, View};
use wgpu::TextureFormat::{self, *};
use wgpu::TextureView;

const SIZE: [u32; 2] = super::SIZE;
const COUNT: usize = (SIZE[0] * SIZE[1]) as usize;

/// Directions all over the sphere, on a spiral.
fn directions() -> Vec<V> {
    let turn = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..COUNT)
        .map(|i| {
            let z = 1.0 - 2.0 * (i as f64 + 0.5) / COUNT as f64;
            let r = (1.0 - z * z).sqrt();
            [r * (turn * i as f64).cos(), r * (turn * i as f64).sin(), z]
        })
        .collect()
}

/// A point of the unfolded octahedron, −1…1 (Meyer et al. 2010).
fn octahedral(n: V) -> [f64; 2] {
    let n = n.map(|c| c / (n[0].abs() + n[1].abs() + n[2].abs()));
    let fold = |a: f64, b: f64| (1.0 - b.abs()) * if a < 0.0 { -1.0 } else { 1.0 };
    if n[2] >= 0.0 { [n[0], n[1]] } else { [fold(n[0], n[1]), fold(n[1], n[0])] }
}

/// The nearest f16 of a number of the normal range, or 0.
fn half(x: f64) -> u16 {
    if x.abs() < 2.0_f64.powi(-14) {
        return 0;
    }
    let exponent = x.abs().log2().floor();
    let mantissa = ((x.abs() / exponent.exp2() - 1.0) * 1024.0).round() as u16;
    // A mantissa that rounds up to 1024 carries into the exponent.
    let magnitude = (((exponent as i32 + 15) as u16) << 10) + mantissa;
    if x < 0.0 { magnitude | 0x8000 } else { magnitude }
}

fn image<const N: usize>(format: TextureFormat, values: &[[f64; N]]) -> TextureView {
    let signed = |x: f64| ((x * 127.0).round() as i8).to_le_bytes();
    let bytes: Vec<u8> = values
        .iter()
        .flat_map(|v| match format {
            R32Float | Rg32Float | Rgba32Float => v.iter().flat_map(|&x| (x as f32).to_le_bytes()).collect::<Vec<_>>(),
            R16Float | Rg16Float | Rgba16Float => v.iter().flat_map(|&x| half(x).to_le_bytes()).collect(),
            Rg8Snorm | Rgba8Snorm => v.iter().flat_map(|&x| signed(x)).collect(),
            Rg8Unorm | Rgba8Unorm => v.iter().map(|&x| ((x * 0.5 + 0.5) * 255.0).round() as u8).collect(),
            Rgb10a2Unorm => {
                let word = |i: usize| ((v[i] * 0.5 + 0.5) * 1023.0).round() as u32;
                (word(0) | word(1) << 10 | word(2) << 20).to_le_bytes().to_vec()
            }
            R32Uint => {
                let word = |i: usize| ((v[i] * 0.5 + 0.5) * 65535.0).round() as u32;
                (word(0) | word(1) << 16).to_le_bytes().to_vec()
            }
            other => panic!("{other:?}"),
        })
        .collect();
    upload_bytes(gpu(), SIZE, format, &bytes)
}

/// Depth, normal and motion as the filter reads them.
fn taken(depth: &TextureView, normal: &TextureView, motion: &TextureView) -> [Vec<[f32; 3]>; 3] {
    let filter = FilterSettings { gradient: Gradient::Off, ..Default::default() };
    let mut denoiser = denoiser(Settings { filter, ..Settings::adaptive() });
    let radiance = image(Rgba32Float, &[[0.5; 4]; COUNT]);
    let target = super::target();
    gpu().submit(|encoder| {
        let surfaces = Surfaces::new(Camera::default(), 0, depth, normal, motion);
        denoiser.begin_frame(&gpu().device, encoder, &surfaces).unwrap();
        denoiser.denoise(&gpu().device, encoder, &Shading::new(&radiance, &target)).unwrap();
    });
    [View::Depth, View::Normal, View::Motion].map(|v| super::view(&mut denoiser, v))
}

#[test]
fn normals_of_every_format() {
    let directions = directions();
    let three: Vec<[f64; 4]> = directions.iter().map(|n| [n[0], n[1], n[2], 0.0]).collect();
    let two: Vec<[f64; 2]> = directions.iter().map(|&n| octahedral(n)).collect();
    let depth = image(R32Float, &[[2.0]; COUNT]);
    let motion = image(Rg32Float, &[[0.0; 2]; COUNT]);
    // Tolerances in degrees: the filter's own 10 bits, and the loss of the format.
    let formats = [
        (image(Rgba32Float, &three), 0.15),
        (image(Rgba16Float, &three), 0.2),
        (image(Rgba8Snorm, &three), 0.6),
        (image(Rgba8Unorm, &three), 0.6),
        (image(Rgb10a2Unorm, &three), 0.25),
        (image(Rg32Float, &two), 0.15),
        (image(Rg16Float, &two), 0.2),
        (image(Rg8Snorm, &two), 1.2),
        (image(Rg8Unorm, &two), 1.2),
        (image(R32Uint, &two), 0.15),
    ];
    for (normal, degrees) in formats {
        let format = normal.texture().format();
        let [_, found, _] = taken(&depth, &normal, &motion);
        for (found, expected) in found.iter().zip(&directions) {
            let angle = dot(unit(found.map(f64::from)), *expected).clamp(-1.0, 1.0).acos().to_degrees();
            assert!(angle <= degrees, "{format:?}: {found:?} for {expected:?} is {angle}° off");
        }
    }
}

#[test]
fn depths_and_motions_of_every_format() {
    let normal = image(Rgba32Float, &[[0.0, 0.0, 1.0, 0.0]; COUNT]);
    let depths: Vec<f64> = (0..COUNT).map(|i| 0.5 + i as f64 / 64.0).collect();
    let motions: Vec<[f64; 2]> = (0..COUNT).map(|i| [i as f64 / 256.0 - 2.0, 3.0 - i as f64 / 128.0]).collect();
    let wide = |d: &f64| [*d, 7.0, 7.0, 7.0];
    let all: Vec<(TextureView, TextureView, f64)> = vec![
        (image(R32Float, &depths.iter().map(|d| [*d]).collect::<Vec<_>>()), image(Rg32Float, &motions), 1e-6),
        (image(R16Float, &depths.iter().map(|d| [*d]).collect::<Vec<_>>()), image(Rg16Float, &motions), 1e-3),
        (
            image(Rg16Float, &depths.iter().map(|d| [*d, 7.0]).collect::<Vec<_>>()),
            image(Rgba16Float, &motions.iter().map(|m| [m[0], m[1], 7.0, 7.0]).collect::<Vec<_>>()),
            1e-3,
        ),
        (
            image(Rgba32Float, &depths.iter().map(wide).collect::<Vec<_>>()),
            image(Rgba32Float, &motions.iter().map(|m| [m[0], m[1], 7.0, 7.0]).collect::<Vec<_>>()),
            1e-6,
        ),
    ];
    for (depth, motion, rounding) in all {
        let what = format!("{:?}, {:?}", depth.texture().format(), motion.texture().format());
        let [found_depth, _, found_motion] = taken(&depth, &normal, &motion);
        for i in 0..COUNT {
            let near = |found: f32, expected: f64| {
                assert!(
                    (f64::from(found) - expected).abs() <= rounding * expected.abs() + 1e-4 * rounding,
                    "{what}: {found} for {expected}"
                );
            };
            near(found_depth[i][0], depths[i]);
            near(found_motion[i][0], motions[i][0]);
            near(found_motion[i][1], motions[i][1]);
        }
    }
}
