//! The smallest host: its own G-buffer, its own noisy shading, one call before and one after it. Writes the last of 40 frames to
//! `out/host_noisy.png` and `out/host_denoised.png`: `cargo run --release --example host_raster`.

#[allow(dead_code, reason = "other examples use the rest")]
#[path = "support/gpu.rs"]
mod gpu;
#[path = "support/host.rs"]
mod host;
#[path = "support/tone.rs"]
mod tone;

use asvgf::wgpu::TextureFormat;
use asvgf::{
    Denoiser, DenoiserDescriptor, FilterSettings, Gradient, Settings, Shading, Surfaces, View, ViewOptions, image_io,
};
use gpu::Gpu;
use host::{Moment, Renderer};
use std::error::Error;

const SIZE: [u32; 2] = [640, 360];

fn main() -> Result<(), Box<dyn Error>> {
    let gpu = Gpu::new()?;
    let renderer = Renderer::new(&gpu.device, SIZE);
    let filter = FilterSettings { gradient: Gradient::Reshade, ..Default::default() };
    let settings = Settings { filter, ..Settings::adaptive() };
    let mut denoiser =
        Denoiser::new(&gpu.device, &gpu.queue, &DenoiserDescriptor { size: SIZE, settings, ..Default::default() })?;
    let noisy = host::image(&gpu.device, SIZE, TextureFormat::Rgba32Float);
    let clean = host::image(&gpu.device, SIZE, TextureFormat::Rgba32Float);
    for index in 0..40 {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let moment = Moment::at(index);
        let scene = renderer.scene(&moment, &Moment::at(index.saturating_sub(1)));
        renderer.draw(&mut encoder, &scene);
        let r = &renderer;
        let surfaces = Surfaces::new(moment.matrices(SIZE), index, &r.depth, &r.normal, &r.motion);
        let reshade = denoiser.begin_frame(&gpu.device, &mut encoder, &surfaces)?.ok_or("the gradient is off")?;
        renderer.shade(&mut encoder, &scene, &reshade);
        let shading = Shading { albedo: Some(&renderer.albedo), ..Shading::new(&renderer.radiance, &clean) };
        denoiser.denoise(&gpu.device, &mut encoder, &shading)?;
        gpu.queue.submit([encoder.finish()]);
    }
    std::fs::create_dir_all("out")?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    denoiser.show(&gpu.device, &mut encoder, View::Noisy, ViewOptions::default(), &noisy)?;
    gpu.queue.submit([encoder.finish()]);
    for (name, view) in [("noisy", &noisy), ("denoised", &clean)] {
        let pixels: Vec<[u8; 4]> = gpu.read_colors(view).into_iter().map(|c| tone::pixel(c, 1.0)).collect();
        image_io::write_png(format!("out/host_{name}.png"), SIZE[0], SIZE[1], &pixels)?;
    }
    Ok(())
}
