//! The smallest host: its own G-buffer, its own noisy shading, one call before the shading and one after it. Writes the last of 40
//! frames to `out/host_noisy.png` and `out/host_denoised.png`: `cargo run --release --example host_raster`.

mod renderer;

use asvgf::wgpu::{self, TextureFormat};
use asvgf::{
    Denoiser, DenoiserDescriptor, FilterSettings, Gradient, Settings, Shading, Surfaces, View, ViewOptions, image_io,
};
use renderer::{Moment, Renderer};
use std::error::Error;

const SIZE: [u32; 2] = [640, 360];

fn main() -> Result<(), Box<dyn Error>> {
    let adapter = pollster::block_on(wgpu::Instance::default().request_adapter(&Default::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
    let renderer = Renderer::new(&device, SIZE);
    let filter = FilterSettings { gradient: Gradient::Reshade, ..Default::default() };
    let settings = Settings { filter, ..Settings::adaptive() };
    let mut denoiser =
        Denoiser::new(&device, &queue, &DenoiserDescriptor { size: SIZE, settings, ..Default::default() })?;
    let clean = renderer::image(&device, SIZE, TextureFormat::Rgba16Float);
    for index in 0..40 {
        let mut encoder = device.create_command_encoder(&Default::default());
        let moment = Moment::at(index);
        let scene = renderer.scene(&moment, &Moment::at(index.saturating_sub(1)));
        renderer.draw(&mut encoder, &scene);
        let r = &renderer;
        let surfaces = Surfaces::new(moment.matrices(SIZE), index, &r.depth, &r.normal, &r.motion);
        let reshade = denoiser.begin_frame(&device, &mut encoder, &surfaces)?.ok_or("the gradient is off")?;
        renderer.shade(&mut encoder, &scene, &reshade);
        let shading = Shading { albedo: Some(&renderer.albedo), ..Shading::new(&renderer.radiance, &clean) };
        denoiser.denoise(&device, &mut encoder, &shading)?;
        queue.submit([encoder.finish()]);
    }
    std::fs::create_dir_all("out")?;
    for (name, view) in [("noisy", View::Noisy), ("denoised", View::Denoised)] {
        let picture = renderer::image(&device, SIZE, TextureFormat::Rgba8Unorm);
        let mut encoder = device.create_command_encoder(&Default::default());
        denoiser.show(&device, &mut encoder, view, ViewOptions::default(), &picture)?;
        queue.submit([encoder.finish()]);
        let pixels = read(&device, &queue, picture.texture())?;
        image_io::write_png(format!("out/host_{name}.png"), SIZE[0], SIZE[1], pixels.as_chunks().0)?;
    }
    Ok(())
}

/// Reads the bytes of a picture whose rows need no padding, because their length is a multiple of 256.
fn read(device: &wgpu::Device, queue: &wgpu::Queue, picture: &wgpu::Texture) -> Result<Vec<u8>, Box<dyn Error>> {
    let [row, height] = [4 * picture.width(), picture.height()];
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("picture"),
        size: u64::from(row * height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout { bytes_per_row: Some(row), ..Default::default() };
    let mut encoder = device.create_command_encoder(&Default::default());
    let destination = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(picture.as_image_copy(), destination, picture.size());
    encoder.map_buffer_on_submit(&buffer, wgpu::MapMode::Read, .., |_| {});
    queue.submit([encoder.finish()]);
    device.poll(wgpu::PollType::wait_indefinitely())?;
    Ok(buffer.get_mapped_range(..)?.to_vec())
}
