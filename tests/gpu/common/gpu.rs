//! One device for all tests of a binary. It offers the minimum of every WebGPU device, so that tests notice any demand for more.

use std::sync::OnceLock;
use std::time::Duration;
use wgpu::{
    BufferDescriptor, BufferUsages, CommandEncoder, Device, DeviceDescriptor, Extent3d, Features, Instance,
    InstanceDescriptor, InstanceFlags, Limits, MapMode, PollType, Queue, Texture, TextureDescriptor, TextureDimension,
    TextureFormat, TextureUsages, TextureView,
};

/// A device and its queue.
pub struct Gpu {
    pub device: Device,
    pub queue: Queue,
}

/// Time limit for the GPU, so that a hang fails the test.
const PATIENCE: Duration = Duration::from_secs(120);

const NO_ADAPTER: &str = "no GPU that wgpu can use was found, and these tests run shaders. Install a driver, or a software \
    one (Debian, Ubuntu: apt-get install mesa-vulkan-drivers; Fedora: dnf install mesa-vulkan-drivers; Arch: pacman -S \
    vulkan-swrast)";

/// The device that the tests of this binary share.
pub fn gpu() -> &'static Gpu {
    static SHARED: OnceLock<Gpu> = OnceLock::new();
    SHARED.get_or_init(|| Gpu::new(InstanceFlags::default()))
}

impl Gpu {
    /// Makes a separate device.
    pub fn new(flags: InstanceFlags) -> Self {
        Self::with(flags, Features::empty()).expect("every adapter offers no features")
    }

    /// Makes a separate device with more than the minimum, if the adapter has it.
    pub fn with(flags: InstanceFlags, features: Features) -> Option<Self> {
        let descriptor = InstanceDescriptor { flags, ..InstanceDescriptor::new_without_display_handle_from_env() };
        Self::of(&Instance::new(descriptor), features)
    }

    /// Makes a separate device from an existing instance.
    pub fn of(instance: &Instance, features: Features) -> Option<Self> {
        let adapter = match pollster::block_on(instance.request_adapter(&Default::default())) {
            Ok(adapter) => adapter,
            Err(e) => panic!("{NO_ADAPTER}: {e}"),
        };
        if !adapter.features().contains(features) {
            return None;
        }
        let (device, queue) = pollster::block_on(adapter.request_device(&DeviceDescriptor {
            label: Some("test"),
            required_features: features,
            required_limits: Limits::default(),
            ..Default::default()
        }))
        .expect("every adapter offers the default limits");
        Some(Self { device, queue })
    }

    /// Records commands and submits them.
    pub fn submit<T>(&self, record: impl FnOnce(&mut CommandEncoder) -> T) -> T {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let result = record(&mut encoder);
        self.queue.submit([encoder.finish()]);
        result
    }

    /// Makes a texture with these usages.
    pub fn texture(&self, size: [u32; 2], format: TextureFormat, usage: TextureUsages) -> Texture {
        texture(&self.device, size, format, usage)
    }

    /// Makes a texture that a shader writes and [`Gpu::read`] reads.
    pub fn target(&self, size: [u32; 2], format: TextureFormat) -> TextureView {
        self.texture(size, format, TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC)
            .create_view(&Default::default())
    }

    /// Reads the bytes of a texture, row by row without padding.
    pub fn read(&self, texture: &Texture) -> Vec<u8> {
        let row = texture.width() * texture.format().block_copy_size(None).expect("a format of one plane");
        let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.readable(u64::from(padded) * u64::from(texture.height()));
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None };
        self.submit(|encoder| {
            let destination = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
            encoder.copy_texture_to_buffer(texture.as_image_copy(), destination, texture.size());
        });
        let bytes = self.map(&buffer);
        bytes.chunks(padded as usize).flat_map(|r| &r[..row as usize]).copied().collect()
    }

    /// Makes a buffer to copy results into.
    pub fn readable(&self, size: u64) -> wgpu::Buffer {
        let usage = BufferUsages::COPY_DST | BufferUsages::MAP_READ;
        self.device.create_buffer(&BufferDescriptor { label: Some("readback"), size, usage, mapped_at_creation: false })
    }

    /// Waits, and returns the content of a readable buffer.
    pub fn map(&self, buffer: &wgpu::Buffer) -> Vec<u8> {
        buffer.map_async(MapMode::Read, .., |result| result.expect("a readable buffer"));
        self.wait();
        buffer.get_mapped_range(..).expect("mapped").to_vec()
    }

    /// Waits until all submitted work is done.
    pub fn wait(&self) {
        let poll = PollType::Wait { submission_index: None, timeout: Some(PATIENCE) };
        self.device.poll(poll).expect("the GPU answers in time");
    }
}

/// Makes a texture on any device, with these usages.
pub fn texture(device: &Device, size: [u32; 2], format: TextureFormat, usage: TextureUsages) -> Texture {
    device.create_texture(&TextureDescriptor {
        label: Some("test"),
        size: Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}
