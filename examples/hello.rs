//! From nothing to a picture without a window: denoises a second of a built-in scene and writes the last frame to `out/hello.png`.

use asvgf::wgpu::*;
use asvgf::{Camera, Denoiser, DenoiserDescriptor, Frame, View, image_io, scene};

/// A copy from a texture to a buffer needs rows of a multiple of 256 bytes: 4 × 640 is one.
const SIZE: Extent3d = Extent3d { width: 640, height: 360, depth_or_array_layers: 1 };

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let adapter = pollster::block_on(Instance::default().request_adapter(&Default::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
    let [light, picture] = [TextureFormat::Rgba16Float, TextureFormat::Rgba8Unorm].map(|format| {
        let texture = device.create_texture(&TextureDescriptor {
            label: None,
            size: SIZE,
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format,
            usage: TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        texture.create_view(&Default::default())
    });

    let room = scene::builtin::scene("cornell", "move-light").ok_or("there is no such scene")?;
    let mut uploaded = scene::GpuScene::new(&device, &queue, &room)?;
    let descriptor = DenoiserDescriptor { size: [SIZE.width, SIZE.height], ..Default::default() };
    let mut denoiser = Denoiser::new(&device, &queue, &descriptor)?;
    let camera = Camera { eye: [0.0, 1.0, 3.9], target: [0.0, 1.0, 0.0], ..Default::default() };
    for index in 0..30 {
        let mut encoder = device.create_command_encoder(&Default::default());
        uploaded.update(&device, &mut encoder, &room.pose(Some(0), index as f32 / 30.0))?;
        denoiser.render(&device, &mut encoder, &Frame::new(&uploaded, camera, index, &light))?;
        queue.submit([encoder.finish()]);
    }

    let mut encoder = device.create_command_encoder(&Default::default());
    denoiser.show(&device, &mut encoder, View::Denoised, Default::default(), &picture)?;
    let (size, usage) = (u64::from(4 * SIZE.width * SIZE.height), BufferUsages::COPY_DST | BufferUsages::MAP_READ);
    let buffer = device.create_buffer(&BufferDescriptor { label: None, size, usage, mapped_at_creation: false });
    let layout = TexelCopyBufferLayout { bytes_per_row: Some(4 * SIZE.width), ..Default::default() };
    let into = TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(picture.texture().as_image_copy(), into, SIZE);
    encoder.map_buffer_on_submit(&buffer, MapMode::Read, .., |_| {});
    queue.submit([encoder.finish()]);
    device.poll(PollType::wait_indefinitely())?;
    std::fs::create_dir_all("out")?;
    Ok(image_io::write_png("out/hello.png", SIZE.width, SIZE.height, buffer.get_mapped_range(..)?.as_chunks().0)?)
}
