//! The [`Denoiser`]: carries out a [`Plan`] in the host's encoder.

use crate::camera::PlacedCamera;
use crate::gpu::compose::Permutation;
use crate::gpu::counts::{Counters, InputCounts};
use crate::gpu::filled::filled;
use crate::gpu::frame::{self, FrameUniform, Moment};
use crate::gpu::pipelines::Pipelines;
use crate::gpu::textures::Textures;
use crate::gpu::timing::{FrameQueries, FrameTimes, Timing};
use crate::host;
use crate::passes::{self, Pass};
use crate::plan::{Changes, Decision, HostTraits, Plan, Slot, Step, Traversal};
use crate::settings::Settings;
use crate::{Error, View, ViewOptions};
#[cfg(feature = "path-tracer")]
use crate::{scene::Snapshot, settings::TracerSettings};
#[cfg(feature = "path-tracer")]
use std::sync::Arc;
use wgpu::{
    BindingResource, Buffer, BufferBinding, BufferUsages, CommandEncoder, ComputePassDescriptor, Device, DeviceType,
    Features, Limits, Queue, TextureFormat, TextureUsages, TextureView,
};

/// Spacing of the strides of the à-trous iterations in their buffer: the default `min_uniform_buffer_offset_alignment`.
const STRIDE_SPACING: u64 = 256;

/// What a [`Denoiser`] is made for.
#[derive(Clone, Debug, Default)]
pub struct DenoiserDescriptor {
    /// Width and height of the image in pixels, each 1…`max_texture_dimension_2d`.
    pub size: [u32; 2],
    /// What to do.
    pub settings: Settings,
    /// Measure each pass on the GPU; needs [`wgpu::Features::TIMESTAMP_QUERY`] on the device.
    pub timing: bool,
    /// Count the pixels of a host's frames that have to be cleaned, for [`Denoiser::take_counts`].
    pub diagnostics: bool,
    /// Keep every intermediate image until the next frame, so that [`Denoiser::show`] can show any. Costs memory: without it images
    /// that are no longer read give their textures to others.
    pub views: bool,
    /// What is compiled.
    pub specialize: Specialize,
    /// Another denoiser's [`Denoiser::pipelines`], to share what is compiled; it must be of the same device.
    pub pipelines: Option<Pipelines>,
}

/// What is compiled, and with it what each frame runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Specialize {
    /// Just what the scene, the settings and what changed since the last frame need: the least work. Where these change, something
    /// new may have to be compiled: [`Denoiser::prepare`] does it ahead.
    #[default]
    Exactly,
    /// Everything that the materials and lights of such a scene and any frame of these settings may need: compiled once, whatever
    /// changes, and nothing is left out. (Instances, normals, an environment and the views of a host are a matter of what is bound.)
    Everything,
}

/// What a [`Denoiser`] asks of the device.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Requirements {
    /// Features that must be enabled.
    pub features: Features,
    /// Limits that must be reached; those of [`wgpu::Limits::default`] always do.
    pub limits: Limits,
}

/// Turns noisy samples into clean frames: those of the host's own renderer, in two calls a frame
/// ([`Denoiser::begin_frame`], [`Denoiser::denoise`]), or of a `GpuScene` that it traces itself (`render`).
///
/// It records into the host's encoder and never submits, waits or prints. Several frames, or several denoisers, may be
/// recorded into one encoder. History lives in the denoiser; use one per view. A traced frame and a host's do not share it.
#[derive(Debug)]
pub struct Denoiser {
    pub(crate) size: [u32; 2],
    pub(crate) settings: Settings,
    pipelines: Pipelines,
    pub(crate) textures: Textures,
    strides: Buffer,
    /// The adapter is the CPU.
    on_cpu: bool,
    pub(crate) specialize: Specialize,
    pub(crate) timing: Option<Timing>,
    pub(crate) counters: Option<Counters>,
    /// A host's frame that waits for its light.
    pub(crate) begun: Option<host::Begun>,
    pub(crate) last: Option<LastFrame>,
    pub(crate) history: bool,
}

/// What the next frame, and [`Denoiser::show`], need of the last one.
#[derive(Debug)]
pub(crate) struct LastFrame {
    pub plan: Plan,
    pub uniform: Buffer,
    pub camera: PlacedCamera,
    pub source: Source,
    pub index: u32,
}

/// Where a frame's samples came from.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    /// A host's renderer, and what its light is.
    Host(Light),
    /// The path tracer: its scene as it was, and how paths were traced.
    #[cfg(feature = "path-tracer")]
    Scene(Arc<Snapshot>, TracerSettings),
}

/// What a host's history contains. Mixing kinds would multiply textures twice, or never.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Light {
    pub textures: bool,
    pub emission: bool,
}

impl Denoiser {
    /// What a device must offer for these settings.
    pub fn requirements(descriptor: &DenoiserDescriptor) -> Requirements {
        let features = if descriptor.timing { Features::TIMESTAMP_QUERY } else { Features::empty() };
        Requirements { features, limits: Limits::default() }
    }

    /// Makes a denoiser for images of one size. Shaders are compiled when a frame first needs them.
    ///
    /// # Errors
    /// What the device lacks, or which setting is out of range.
    pub fn new(device: &Device, queue: &Queue, descriptor: &DenoiserDescriptor) -> Result<Self, Error> {
        descriptor.settings.check()?;
        let required = Self::requirements(descriptor);
        let missing = required.features - device.features();
        if !missing.is_empty() {
            return Err(Error::Feature { missing, setting: "DenoiserDescriptor::timing" });
        }
        // A device that is strict about WebGPU reports 0 for limits of wgpu's own, whatever it can do.
        let mut needed = required.limits;
        needed.zero_native_only();
        let mut shortfall = None;
        needed.check_limits_with_fail_fn(&device.limits(), false, |limit, needed, available| {
            shortfall.get_or_insert(Error::Limit { limit, needed, available });
        });
        if let Some(error) = shortfall {
            return Err(error);
        }
        check_size(device, descriptor.size)?;
        let pipelines = match &descriptor.pipelines {
            Some(shared) if shared.belong_to(device) => shared.clone(),
            Some(_) => return Err(Error::OtherDevice),
            None => Pipelines::new(device)?,
        };
        let mut strides = vec![0_u8; 9 * STRIDE_SPACING as usize];
        for i in 0..9 {
            let at = i * STRIDE_SPACING as usize;
            strides[at..at + 4].copy_from_slice(&(1_i32 << i).to_le_bytes());
        }
        Ok(Self {
            size: descriptor.size,
            settings: descriptor.settings.clone(),
            pipelines,
            textures: Textures::new(descriptor.views),
            strides: filled(device, "asvgf strides", &strides, BufferUsages::UNIFORM),
            on_cpu: device.adapter_info().device_type == DeviceType::Cpu,
            specialize: descriptor.specialize,
            timing: descriptor.timing.then(|| Timing::new(queue)),
            counters: descriptor.diagnostics.then(Counters::default),
            begun: None,
            last: None,
            history: false,
        })
    }

    /// As [`Denoiser::prepare`], for a host's frames: `traits` tells what its views have, and `target` is the format of
    /// [`Shading::target`](crate::Shading::target).
    ///
    /// # Errors
    /// As [`Denoiser::prepare`].
    pub fn prepare_hosted(&self, traits: &HostTraits, target: TextureFormat) -> Result<(), Error> {
        let traits = HostTraits { views: self.textures.keeps(), ..*traits };
        self.every_change().iter().try_for_each(|&changes| {
            let plan = self.adapt(Plan::hosted(&traits, &self.settings, changes, target));
            self.compile(&plan.steps, Traversal::default())
        })
    }

    /// What is compiled, to share with another denoiser of the same device.
    pub fn pipelines(&self) -> &Pipelines {
        &self.pipelines
    }

    /// Why each piece of the last frame was in or left out.
    pub fn decisions(&self) -> &[Decision] {
        self.plan().map_or(&[], |plan| &plan.decisions)
    }

    /// The settings in force.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Changes settings from the next frame on. History is kept unless the new settings keep another kind of it. A frame that
    /// was begun has to be begun again.
    ///
    /// # Errors
    /// The setting that is out of range; the old ones stay in force.
    pub fn set_settings(&mut self, settings: Settings) -> Result<(), Error> {
        settings.check()?;
        if settings.mode != self.settings.mode || settings.filter.feedback != self.settings.filter.feedback {
            self.history = false;
        }
        self.abandon();
        self.settings = settings;
        Ok(())
    }

    /// Changes the size of the image. The next frame starts without history.
    ///
    /// # Errors
    /// A size outside the device's limits; the old one stays.
    pub fn resize(&mut self, device: &Device, size: [u32; 2]) -> Result<(), Error> {
        check_size(device, size)?;
        if size != self.size {
            self.abandon();
            self.size = size;
            self.textures.clear();
            self.last = None;
            self.history = false;
        }
        Ok(())
    }

    /// Forgets the history, as after a camera cut, and a frame that was begun.
    pub fn reset(&mut self) {
        self.abandon();
        self.history = false;
    }

    /// Width and height of the image in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Bytes of the denoiser's own textures, see [`Plan::bytes`].
    pub fn memory(&self) -> u64 {
        self.textures.bytes()
    }

    /// What the last frame ran, and why each piece was in or left out.
    pub fn plan(&self) -> Option<&Plan> {
        self.last.as_ref().map(|l| &l.plan)
    }

    /// GPU times of the oldest finished frame that was not taken yet; `None` while there is none. Never waits: poll the device
    /// as usual.
    pub fn take_times(&mut self) -> Option<FrameTimes> {
        self.timing.as_ref()?.take()
    }

    /// What had to be cleaned in the oldest finished frame that was not taken yet; `None` while there is none, and always without
    /// [`DenoiserDescriptor::diagnostics`]. Never waits: poll the device as usual.
    pub fn take_counts(&mut self) -> Option<InputCounts> {
        self.counters.as_ref()?.take()
    }

    /// What differs in plans of one kind of frame.
    pub(crate) fn every_change(&self) -> &'static [Changes] {
        match self.specialize {
            Specialize::Exactly => &[Changes::ANY, Changes { camera: true, scene: false }, Changes::NONE],
            Specialize::Everything => &[Changes::ANY],
        }
    }

    /// What a frame may leave out of what it knows not to have changed; nothing is known where there is no last frame.
    pub(crate) fn changes(&self, known: Option<Changes>) -> Changes {
        match self.specialize {
            Specialize::Exactly => known.unwrap_or_default(),
            Specialize::Everything => Changes::ANY,
        }
    }

    /// Records the display of an intermediate image of the last recorded frame, into an `rgba32float` or `rgba16float` view as
    /// numbers or into an `rgba8unorm` view as a picture.
    ///
    /// # Errors
    /// [`Error::NoView`] where the last frame did not make it, or what is wrong with the target.
    pub fn show(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        view: View,
        options: ViewOptions,
        target: &TextureView,
    ) -> Result<(), Error> {
        let accepted = [TextureFormat::Rgba32Float, TextureFormat::Rgba16Float, TextureFormat::Rgba8Unorm];
        let format = self.check_target(target, &accepted)?;
        if self.last.is_some() && !self.textures.is_complete() {
            let reason = "a frame was begun, in the place of the last one's images, and not finished: finish one first";
            return Err(Error::NoView { view, reason });
        }
        let Some(last) = self.last.take() else {
            return Err(Error::NoView { view, reason: "no frame was rendered yet" });
        };
        let step = passes::view::step(view, &last.plan, self.settings.mode, format, |image| self.textures.holds(image));
        let result = step.and_then(|step| {
            self.compile(std::slice::from_ref(&step), Traversal::default())?;
            let numbers = [options.exposure, options.range, 0.0, 0.0];
            let show = filled(device, "asvgf view", bytemuck::cast_slice(&numbers), BufferUsages::UNIFORM);
            let none = |_: &str| None;
            let resources =
                Resources { target: Some(target), show: Some(&show), ..Resources::new(&none, &last.uniform) };
            self.dispatch(device, encoder, &step, &resources, None)
        });
        self.last = Some(last);
        result
    }

    /// One frame's constants, for each batch of its paths: a buffer of its own, as other frames may be recorded before this one is
    /// submitted.
    pub(crate) fn frame_uniform(&self, device: &Device, moment: &Moment, batches: &[[u32; 2]]) -> Buffer {
        let uniform = FrameUniform::new(self.size, moment, &self.settings);
        filled(device, "asvgf frame", &frame::of_each_batch(uniform, batches), BufferUsages::UNIFORM)
    }

    /// Records steps that are compiled.
    pub(crate) fn record<'a>(
        &'a self,
        device: &Device,
        encoder: &mut CommandEncoder,
        steps: &[Step],
        resources: &Resources<'a>,
        queries: &mut Option<FrameQueries>,
        after: &mut impl FnMut(Pass, &mut CommandEncoder),
    ) -> Result<(), Error> {
        for step in steps {
            let timestamps = queries.as_mut().and_then(|q| q.next(step.pass.name()));
            self.dispatch(device, encoder, step, resources, timestamps)?;
            after(step.pass, encoder);
        }
        Ok(())
    }

    pub(crate) fn check_target(
        &self,
        target: &TextureView,
        accepted: &[TextureFormat],
    ) -> Result<TextureFormat, Error> {
        let texture = target.texture();
        let format = texture.format();
        host::shape("target", target)?;
        if !accepted.contains(&format) {
            let accepted = match accepted.len() {
                2 => "rgba16float or rgba32float",
                _ => "rgba8unorm, rgba16float or rgba32float",
            };
            return Err(Error::ViewFormat { view: "target", format, accepted });
        }
        let found = [texture.width(), texture.height()];
        if found != self.size {
            return Err(Error::ViewSize { view: "target", found, expected: self.size });
        }
        let missing = TextureUsages::STORAGE_BINDING - texture.usage();
        if !missing.is_empty() {
            return Err(Error::ViewUsage { view: "target", missing });
        }
        Ok(format)
    }

    fn permutation(step: &Step, traversal: Traversal) -> Permutation {
        Permutation {
            pass: step.pass,
            features: step.features,
            traversal: if step.pass.traces() { traversal } else { Traversal::default() },
            view: if step.pass == Pass::View { step.iteration } else { 0 },
        }
    }

    /// The plan as it suits the adapter.
    pub(crate) fn adapt(&self, plan: Plan) -> Plan {
        if self.on_cpu { plan.on_cpu() } else { plan }
    }

    /// Compiles what steps need, if it was not done.
    pub(crate) fn compile(&self, steps: &[Step], traversal: Traversal) -> Result<(), Error> {
        steps.iter().try_for_each(|step| self.pipelines.kernel(Self::permutation(step, traversal)).map(|_| ()))
    }

    fn dispatch<'a>(
        &'a self,
        device: &Device,
        encoder: &mut CommandEncoder,
        step: &Step,
        resources: &Resources<'a>,
        timestamp_writes: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) -> Result<(), Error> {
        let missing = |name: String| Error::Shader {
            shader: step.pass.name(),
            features: format!("{:?}", step.features),
            message: format!("nothing is bound to `{name}`"),
        };
        let kernel = self.pipelines.kernel(Self::permutation(step, resources.traversal))?;
        let groups = kernel.bind(device, |name| self.resource(step, resources, name)).map_err(missing)?;
        let [width, height] = step.grid.extent(self.size);
        let label = format!("asvgf {}", step.pass.name());
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor { label: Some(&label), timestamp_writes });
        pass.set_pipeline(&kernel.pipeline);
        for (index, group) in groups.iter().enumerate() {
            pass.set_bind_group(index as u32, group, &[]);
        }
        pass.dispatch_workgroups(width.div_ceil(8), height.div_ceil(8), 1);
        Ok(())
    }

    /// What stands behind a binding's name.
    fn resource<'a>(&'a self, step: &Step, given: &Resources<'a>, name: &str) -> Option<BindingResource<'a>> {
        match name {
            "frame" => {
                let offset = u64::from(step.batch()) * frame::SPACING as u64;
                let size = std::num::NonZeroU64::new(size_of::<FrameUniform>() as u64);
                return Some(BindingResource::Buffer(BufferBinding { buffer: given.uniform, offset, size }));
            }
            "show" => return given.show.map(Buffer::as_entire_binding),
            "counts" => return given.counts.map(Buffer::as_entire_binding),
            "stride" => {
                return Some(BindingResource::Buffer(BufferBinding {
                    buffer: &self.strides,
                    offset: u64::from(step.iteration) * STRIDE_SPACING,
                    size: std::num::NonZeroU64::new(4),
                }));
            }
            _ => {}
        }
        if let Some((_, slot)) = step.bindings.iter().find(|(n, _)| *n == name) {
            return match *slot {
                Slot::Now(_) | Slot::Before(_) => self.textures.view(*slot).map(BindingResource::TextureView),
                Slot::Target => given.target.map(BindingResource::TextureView),
                Slot::Host => (given.given)(name),
            };
        }
        (given.given)(name)
    }
}

/// What a dispatch uses that is not the denoiser's own.
pub(crate) struct Resources<'a> {
    /// The scene's, or the host's views, by name.
    pub given: &'a dyn Fn(&str) -> Option<BindingResource<'a>>,
    pub traversal: Traversal,
    pub uniform: &'a Buffer,
    pub target: Option<&'a TextureView>,
    pub counts: Option<&'a Buffer>,
    pub show: Option<&'a Buffer>,
}

impl<'a> Resources<'a> {
    pub fn new(given: &'a dyn Fn(&str) -> Option<BindingResource<'a>>, uniform: &'a Buffer) -> Self {
        Self { given, traversal: Traversal::default(), uniform, target: None, counts: None, show: None }
    }
}

fn check_size(device: &Device, size: [u32; 2]) -> Result<(), Error> {
    let limit = device.limits().max_texture_dimension_2d;
    if size.iter().all(|&s| s >= 1 && s <= limit) {
        Ok(())
    } else {
        Err(Error::Size { width: size[0], height: size[1], limit })
    }
}
