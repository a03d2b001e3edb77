//! Everything that a host without a window needs beside the denoiser: a device, a target texture, and its pixels back.

use asvgf::wgpu::{self, TextureFormat, TextureUsages};
use std::fmt;

/// A device of the program's own.
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub adapter: wgpu::AdapterInfo,
}

/// Reason for the lack of a device, with a remedy.
#[derive(Debug)]
pub struct NoGpu(String);

impl std::error::Error for NoGpu {}

impl fmt::Display for NoGpu {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}\nNo GPU that wgpu can use was found. Install your GPU's Vulkan driver, or a software one:\n  \
             Debian, Ubuntu: sudo apt-get install -y mesa-vulkan-drivers\n  Fedora: sudo dnf install mesa-vulkan-drivers\n  \
             Arch: sudo pacman -S vulkan-swrast",
            self.0
        )
    }
}

impl Gpu {
    /// Requests only the features of every WebGPU device, and timestamps if the adapter has them.
    pub fn new() -> Result<Self, NoGpu> {
        // OpenGL lacks storage textures of some of the formats; WGPU_BACKEND may still select it.
        let backends = wgpu::Backends::from_env().unwrap_or(wgpu::Backends::PRIMARY);
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends,
            ..wgpu::InstanceDescriptor::new_without_display_handle_from_env()
        });
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options)).map_err(|e| NoGpu(e.to_string()))?;
        // Large scenes and images need more than WebGPU's guaranteed minimum.
        let limits = wgpu::Limits {
            max_buffer_size: adapter.limits().max_buffer_size,
            max_storage_buffer_binding_size: adapter.limits().max_storage_buffer_binding_size,
            ..wgpu::Limits::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("program"),
            required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: limits,
            ..Default::default()
        }))
        .map_err(|e| NoGpu(e.to_string()))?;
        // Such an error is mostly out of memory: a command can only report it and end.
        device.on_uncaptured_error(std::sync::Arc::new(|error| fail(&error)));
        Ok(Self { device, queue, adapter: adapter.get_info() })
    }

    /// Returns a texture that the denoiser can write and the host can read back.
    pub fn target(&self, size: [u32; 2], format: TextureFormat) -> wgpu::TextureView {
        self.device
            .create_texture(&wgpu::TextureDescriptor {
                label: Some("target"),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC,
                view_formats: &[],
            })
            .create_view(&Default::default())
    }

    /// Waits for the GPU and returns the texels of a target, row by row.
    pub fn read(&self, target: &wgpu::TextureView) -> Vec<u8> {
        let texture = target.texture();
        let texel = texture.format().block_copy_size(None).expect("a colour format");
        let row = texture.width() * texel;
        let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: u64::from(padded) * u64::from(texture.height()),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None },
            },
            texture.size(),
        );
        self.queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |_| {});
        self.wait();
        let bytes = buffer.get_mapped_range(..).expect("mapped");
        bytes.chunks(padded as usize).flat_map(|r| &r[..row as usize]).copied().collect()
    }

    /// Waits until the GPU has done all submitted work.
    pub fn wait(&self) {
        if let Err(error) = self.device.poll(wgpu::PollType::wait_indefinitely()) {
            fail(&error);
        }
    }

    /// Returns the linear colours of an rgba32float target.
    pub fn read_colors(&self, target: &wgpu::TextureView) -> Vec<[f32; 3]> {
        let bytes = self.read(target);
        let channel = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
        bytes.chunks_exact(16).map(|t| [channel(&t[0..4]), channel(&t[4..8]), channel(&t[8..12])]).collect()
    }
}

fn fail(error: &dyn fmt::Display) -> ! {
    eprintln!("error: the GPU failed: {error}");
    std::process::exit(1)
}
