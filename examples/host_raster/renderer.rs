//! A tiny renderer on the GPU, in the place of your own, see renderer.wgsl.

use asvgf::wgpu::util::{BufferInitDescriptor, DeviceExt};
use asvgf::wgpu::*;
use asvgf::{Matrices, RESHADE_WGSL, Reshade};

/// The places of all objects in a frame.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    pub eye: [f32; 3],
    pub ball: [f32; 3],
    pub lamp: [f32; 3],
    pub radiance: f32,
}

impl Moment {
    /// The camera walks sideways, the ball rolls, the lamp swings.
    pub fn at(frame: u32) -> Self {
        let t = frame as f32 / 30.0;
        Self {
            eye: [0.5 * t - 0.5, 1.6, 5.0],
            ball: [0.4 * t - 0.4, 0.7, 0.0],
            lamp: [1.5 * (1.5 * t).sin(), 3.0, 0.8],
            radiance: 14.0,
        }
    }

    /// Unit vectors to the right, up and forward, looking at the middle of the floor.
    fn axes(&self) -> [[f32; 3]; 3] {
        let unit = |v: [f32; 3]| v.map(|x| x / v.iter().map(|x| x * x).sum::<f32>().sqrt());
        let cross = |a: [f32; 3], b: [f32; 3]| {
            [0, 1, 2].map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
        };
        let forward = unit([-self.eye[0], 0.6 - self.eye[1], -self.eye[2]]);
        let right = unit(cross(forward, [0.0, 1.0, 0.0]));
        [right, cross(right, forward), forward]
    }

    /// Tangents of half the field of view across and upwards.
    fn tangents(size: [u32; 2]) -> [f32; 2] {
        [0.4 * size[0] as f32 / size[1] as f32, 0.4]
    }

    /// View and projection matrices, right-handed. Depth is reversed and has no far plane, both of which the denoiser accepts.
    pub fn matrices(&self, size: [u32; 2]) -> Matrices {
        let [right, up, forward] = self.axes();
        let along = |axis: [f32; 3]| -(0..3).map(|i| axis[i] * self.eye[i]).sum::<f32>();
        let column = |i: usize| [right[i], up[i], -forward[i], 0.0];
        let [x, y] = Self::tangents(size);
        Matrices {
            view: [column(0), column(1), column(2), [along(right), along(up), -along(forward), 1.0]],
            projection: [
                [1.0 / x, 0.0, 0.0, 0.0],
                [0.0, 1.0 / y, 0.0, 0.0],
                [0.0, 0.0, 0.0, -1.0],
                [0.0, 0.0, 0.1, 0.0],
            ],
            jitter: [0.0; 2],
        }
    }

    /// The uniform `View` of renderer.wgsl.
    fn view(&self, size: [u32; 2]) -> [[f32; 4]; 4] {
        let [right, up, forward] = self.axes();
        let [x, y] = Self::tangents(size);
        [self.eye, right.map(|c| c * x), up.map(|c| c * y), forward].map(|[x, y, z]| [x, y, z, 0.0])
    }
}

/// The renderer's pipelines and images.
pub struct Renderer {
    device: Device,
    size: [u32; 2],
    draw: ComputePipeline,
    shade: ComputePipeline,
    pub depth: TextureView,
    pub normal: TextureView,
    pub motion: TextureView,
    pub albedo: TextureView,
    pub radiance: TextureView,
}

impl Renderer {
    pub fn new(device: &Device, size: [u32; 2]) -> Self {
        let source = [RESHADE_WGSL, include_str!("renderer.wgsl")].concat();
        let module = device.create_shader_module(ShaderModuleDescriptor {
            label: Some("host"),
            source: ShaderSource::Wgsl(source.into()),
        });
        let pipeline = |entry| {
            device.create_compute_pipeline(&ComputePipelineDescriptor {
                label: Some(entry),
                layout: None,
                module: &module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                cache: None,
            })
        };
        let image = |format| image(device, size, format);
        Self {
            device: device.clone(),
            size,
            draw: pipeline("draw"),
            shade: pipeline("shade"),
            depth: image(TextureFormat::R32Float),
            normal: image(TextureFormat::Rgba16Float),
            motion: image(TextureFormat::Rg32Float),
            albedo: image(TextureFormat::Rgba8Unorm),
            radiance: image(TextureFormat::Rgba16Float),
        }
    }

    /// Makes the shader's uniform buffer for a moment and the one before.
    pub fn scene(&self, now: &Moment, before: &Moment) -> Buffer {
        let ball = |m: &Moment| [m.ball[0], m.ball[1], m.ball[2], 0.7];
        let mut words = [now.view(self.size), before.view(self.size)].concat();
        words.extend([ball(now), ball(before), [now.lamp[0], now.lamp[1], now.lamp[2], 0.6], [now.radiance; 4]]);
        let contents: Vec<u8> = words.iter().flatten().flat_map(|f: &f32| f.to_le_bytes()).collect();
        self.device.create_buffer_init(&BufferInitDescriptor {
            label: Some("host scene"),
            contents: &contents,
            usage: BufferUsages::UNIFORM,
        })
    }

    /// Draws depth, normals, motion and albedo.
    pub fn draw(&self, encoder: &mut CommandEncoder, scene: &Buffer) {
        let views = [&self.depth, &self.normal, &self.motion, &self.albedo].map(BindingResource::TextureView);
        let scene = [scene.as_entire_binding()];
        self.run(encoder, &self.draw, scene.into_iter().chain(views));
    }

    /// Shades with one noisy sample of the light per pixel.
    pub fn shade(&self, encoder: &mut CommandEncoder, scene: &Buffer, reshade: &Reshade) {
        let buffers = [scene.as_entire_binding(), reshade.frame.as_entire_binding()];
        let views =
            [&reshade.guide, &reshade.repeats, &reshade.shifts, &self.radiance].map(BindingResource::TextureView);
        self.run(encoder, &self.shade, buffers.into_iter().chain(views));
    }

    fn run<'a>(
        &self,
        encoder: &mut CommandEncoder,
        pipeline: &ComputePipeline,
        resources: impl Iterator<Item = BindingResource<'a>>,
    ) {
        let entries: Vec<_> =
            resources.zip(0..).map(|(resource, binding)| BindGroupEntry { binding, resource }).collect();
        let layout = pipeline.get_bind_group_layout(0);
        let group = self.device.create_bind_group(&BindGroupDescriptor {
            label: Some("host"),
            layout: &layout,
            entries: &entries,
        });
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(self.size[0].div_ceil(8), self.size[1].div_ceil(8), 1);
    }
}

/// Makes an image that shaders write and read.
pub fn image(device: &Device, size: [u32; 2], format: TextureFormat) -> TextureView {
    device
        .create_texture(&TextureDescriptor {
            label: Some("host"),
            size: Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format,
            usage: TextureUsages::STORAGE_BINDING | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC,
            view_formats: &[],
        })
        .create_view(&Default::default())
}
