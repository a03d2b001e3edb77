//! Runs one pass on images that a test invents.

use super::gpu::gpu;
use super::plane::{V, cross, sub, unit};
use crate::gpu::compose::{Permutation, Shaders};
use crate::gpu::frame::{FrameUniform, Moment};
use crate::gpu::kernel::Kernel;
use crate::gpu::resource::Resource;
use crate::passes::{Bound, Feature, Grid, HostView, Slot, Step, Traversal};
use crate::{Camera, Matrices, Settings, Viewpoint};
use std::collections::BTreeMap;
use std::sync::{Mutex, OnceLock};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{BindingResource, Buffer, BufferUsages, Extent3d, Texture, TextureFormat, TextureUsages};

/// A texel as four words. Words that its format lacks are ignored.
pub(super) type Texel = [u32; 4];

/// Sizes: a single pixel, and images whose rows and columns are no multiple of a workgroup or stratum.
pub(super) const SIZES: [[u32; 2]; 3] = [[1, 1], [7, 5], [33, 17]];

/// The frame that a pass runs in.
#[derive(Clone)]
pub(super) struct Bench {
    pub size: [u32; 2],
    pub camera: Camera,
    pub previous: Camera,
    pub index: u32,
    pub continued: bool,
    pub settings: Settings,
    pub lambda_block: u32,
    /// Half the height of what the cameras show, if they are orthographic.
    pub half_height: Option<f64>,
}

impl Bench {
    pub fn new(size: [u32; 2], settings: Settings) -> Self {
        let camera =
            Camera { eye: [0.2, 0.3, 4.0], target: [0.1, 0.0, 0.0], jitter: [0.2, -0.3], ..Default::default() };
        Self { size, camera, previous: camera, index: 5, continued: true, settings, lambda_block: 1, half_height: None }
    }

    /// Runs a step on the images of its bindings; an image that is not given is zero. Returns the images that the step wrote, and
    /// checks that they are the same with textures and with storage.
    pub fn run(&self, step: &Step, inputs: &[(&str, Vec<Texel>)]) -> BTreeMap<&'static str, Vec<Texel>> {
        let outputs = self.run_once(step, inputs);
        let other = step.clone().on_cpu();
        if other != *step {
            assert!(outputs == self.run_once(&other, inputs), "{:?} with storage reads differs", step.pass);
        }
        outputs
    }

    fn run_once(&self, step: &Step, inputs: &[(&str, Vec<Texel>)]) -> BTreeMap<&'static str, Vec<Texel>> {
        let gpu = gpu();
        let textures: BTreeMap<&str, Texture> =
            step.bindings.iter().map(|bound| (bound.name, self.texture(step, bound))).collect();
        for (name, texels) in inputs {
            let texture = textures.get(name).unwrap_or_else(|| panic!("{:?} has no `{name}`", step.pass));
            write(texture, texels);
        }
        let [frame, stride] =
            [bytemuck::bytes_of(&self.uniform()), &(1_i32 << step.iteration).to_le_bytes()].map(uniform);
        let kernel = kernel(step);
        let views: BTreeMap<&str, _> = textures.iter().map(|(n, t)| (*n, t.create_view(&Default::default()))).collect();
        let resource = |resource| match resource {
            Resource::Frame => Some(frame.as_entire_binding()),
            Resource::Stride => Some(stride.as_entire_binding()),
            Resource::Image(number) => views.get(step.bindings[number].name).map(BindingResource::TextureView),
            _ => None,
        };
        let groups = kernel.bind(&gpu.device, resource).unwrap_or_else(|missing| panic!("nothing for {missing:?}"));
        let [width, height] = step.grid().extent(self.size);
        gpu.submit(|encoder| {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&kernel.pipeline);
            pass.set_bind_group(0, &groups[0], &[]);
            pass.dispatch_workgroups(width.div_ceil(8), height.div_ceil(8), 1);
        });
        let outputs = step.bindings.iter().filter(|bound| bound.written);
        outputs.map(|bound| (bound.name, read(&textures[bound.name]))).collect()
    }

    fn uniform(&self) -> FrameUniform {
        let camera = |c: &Camera| self.viewpoint(c).placed(self.size).unwrap_or_else(|e| panic!("{e}"));
        let moment = Moment {
            camera: camera(&self.camera),
            previous: camera(&self.previous),
            origin: [0.0; 3],
            index: self.index,
            continued: self.continued,
            lambda_block: self.lambda_block,
            converges: false,
        };
        FrameUniform::new(self.size, &moment, &self.settings)
    }

    fn viewpoint(&self, c: &Camera) -> Viewpoint {
        let Some(half) = self.half_height else { return (*c).into() };
        let [right, up, back] = axes(c);
        let column = |i: usize| [right[i], up[i], back[i], 0.0].map(|x| x as f32);
        let view = [column(0), column(1), column(2), [0.0, 0.0, 0.0, 1.0]];
        let aspect = f64::from(self.size[0]) / f64::from(self.size[1]);
        let [x, y] = [1.0 / (half * aspect), 1.0 / half].map(|s| s as f32);
        let projection = [[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, -0.01, 0.0], [0.0, 0.0, 0.0, 1.0]];
        Viewpoint::Relative { matrices: Matrices { view, projection, jitter: c.jitter }, origin: c.eye }
    }

    fn texture(&self, step: &Step, bound: &Bound) -> Texture {
        let has = |feature| step.features.has(feature);
        let (format, [width, height]) = match bound.slot {
            Slot::Now(image) | Slot::Before(image) => (image.format(), image.grid().extent(self.size)),
            Slot::Target if has(Feature::TargetF16) => (TextureFormat::Rgba16Float, self.size),
            Slot::Target => (TextureFormat::Rgba32Float, self.size),
            // The host's views have the widest format that a host may hand in.
            Slot::Host(view) => match view {
                HostView::Depth | HostView::PreviousDepth => (TextureFormat::R32Float, self.size),
                HostView::Lambda => (TextureFormat::R32Float, self.size.map(|s| s.div_ceil(self.lambda_block))),
                HostView::Instance if !has(Feature::FloatObjects) => (TextureFormat::R32Uint, self.size),
                HostView::Instance => (TextureFormat::R32Float, self.size),
                HostView::Normal if has(Feature::PackedNormals) => (TextureFormat::R32Uint, self.size),
                HostView::Normal if has(Feature::OctahedralNormals) => (TextureFormat::Rg32Float, self.size),
                HostView::Motion => (TextureFormat::Rg32Float, self.size),
                HostView::PairNow | HostView::PairBefore => {
                    let luminance = has(Feature::LuminancePairs);
                    let grid = if has(Feature::StratumPairs) { Grid::Strata } else { Grid::Pixels };
                    (
                        if luminance { TextureFormat::R32Float } else { TextureFormat::Rgba32Float },
                        grid.extent(self.size),
                    )
                }
                _ => (TextureFormat::Rgba32Float, self.size),
            },
        };
        let usage = TextureUsages::STORAGE_BINDING
            | TextureUsages::TEXTURE_BINDING
            | TextureUsages::COPY_SRC
            | TextureUsages::COPY_DST;
        gpu().texture([width, height], format, usage)
    }
}

/// Directions of the image's right side, of its upper side, and against the view.
pub(super) fn axes(camera: &Camera) -> [V; 3] {
    let forward = unit(sub(camera.target, camera.eye));
    let right = unit(cross(forward, camera.up.map(f64::from)));
    [right, cross(right, forward), forward.map(|x| -x)]
}

/// Compiles each kernel once for all tests.
fn kernel(step: &Step) -> &'static Kernel {
    static KERNELS: OnceLock<Mutex<BTreeMap<Permutation, &'static Kernel>>> = OnceLock::new();
    let mut kernels = KERNELS.get_or_init(Mutex::default).lock().unwrap_or_else(|e| e.into_inner());
    let permutation = Permutation::of(step, Traversal::default());
    kernels.entry(permutation).or_insert_with(|| {
        let module = Shaders::new().and_then(|mut shaders| shaders.compose(permutation));
        let kernel = module.and_then(|module| Kernel::new(&gpu().device, module, step));
        Box::leak(Box::new(kernel.unwrap_or_else(|e| panic!("{e}"))))
    })
}

fn uniform(contents: &[u8]) -> Buffer {
    let usage = BufferUsages::UNIFORM;
    gpu().device.create_buffer_init(&BufferInitDescriptor { label: Some("test"), contents, usage })
}

fn words(texture: &Texture) -> usize {
    texture.format().block_copy_size(None).map_or(0, |bytes| bytes as usize / 4)
}

fn write(texture: &Texture, texels: &[Texel]) {
    let (width, height) = (texture.width(), texture.height());
    assert_eq!(texels.len(), (width * height) as usize, "an image of another size");
    let data: Vec<u32> = texels.iter().flat_map(|t| &t[..words(texture)]).copied().collect();
    let bytes_per_row = Some(width * 4 * words(texture) as u32);
    gpu().queue.write_texture(
        texture.as_image_copy(),
        bytemuck::cast_slice(&data),
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None },
        Extent3d { width, height, depth_or_array_layers: 1 },
    );
}

fn read(texture: &Texture) -> Vec<Texel> {
    let data: Vec<u32> = bytemuck::pod_collect_to_vec(&gpu().read(texture));
    let texel = |words: &[u32]| std::array::from_fn(|i| words.get(i).copied().unwrap_or(0));
    data.chunks_exact(words(texture)).map(texel).collect()
}
