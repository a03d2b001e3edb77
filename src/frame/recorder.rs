//! The denoiser's part of the GPU, and the recording of a plan's steps into the host's encoder.

use crate::Error;
use crate::gpu::counts::Counters;
use crate::gpu::filled::filled;
use crate::gpu::frame::{self, FrameUniform, Moment};
use crate::gpu::pipelines::Pipelines;
use crate::gpu::resource::Resource;
use crate::gpu::textures::Textures;
use crate::gpu::timing::{FrameQueries, Timing};
#[cfg(feature = "path-tracer")]
use crate::passes::SceneBinding;
use crate::passes::{HostView, Pass, Slot, Step, Traversal};
use crate::plan::Plan;
use crate::settings::{MOST_ITERATIONS, Settings};
use std::num::NonZeroU64;
use wgpu::{
    BindingResource, Buffer, BufferBinding, BufferUsages, CommandEncoder, ComputePassDescriptor,
    ComputePassTimestampWrites, Device, DeviceType, TextureView,
};

/// Spacing of the strides of the à-trous iterations in their buffer: the default `min_uniform_buffer_offset_alignment`.
const STRIDE_SPACING: u64 = 256;

/// The pipelines, textures and measuring instruments of one denoiser.
#[derive(Debug)]
pub(crate) struct Recorder {
    pub size: [u32; 2],
    pub pipelines: Pipelines,
    pub textures: Textures,
    pub timing: Option<Timing>,
    pub counters: Option<Counters>,
    strides: Buffer,
    /// True if the adapter is the CPU.
    on_cpu: bool,
}

/// A frame that is being recorded: its constants, timestamps and counters.
#[derive(Debug)]
pub(crate) struct Recording {
    pub uniform: Buffer,
    index: u32,
    counts: Option<Buffer>,
    queries: Option<FrameQueries>,
}

/// The resources of a frame that are not the denoiser's own.
pub(crate) struct Resources<'a> {
    pub host: &'a dyn Fn(HostView) -> Option<&'a TextureView>,
    #[cfg(feature = "path-tracer")]
    pub scene: &'a dyn Fn(SceneBinding) -> Option<BindingResource<'a>>,
    pub traversal: Traversal,
    pub target: Option<&'a TextureView>,
    /// The options of a view.
    pub show: Option<&'a Buffer>,
}

impl Default for Resources<'_> {
    fn default() -> Self {
        Self {
            host: &|_| None,
            #[cfg(feature = "path-tracer")]
            scene: &|_| None,
            traversal: Traversal::default(),
            target: None,
            show: None,
        }
    }
}

impl Recorder {
    /// Makes a recorder for frames of this size with these instruments.
    pub fn new(
        device: &Device,
        size: [u32; 2],
        pipelines: Pipelines,
        textures: Textures,
        timing: Option<Timing>,
        counters: Option<Counters>,
    ) -> Self {
        let mut strides = vec![0_u8; MOST_ITERATIONS as usize * STRIDE_SPACING as usize];
        for (i, place) in strides.chunks_exact_mut(STRIDE_SPACING as usize).enumerate() {
            place[..4].copy_from_slice(&(1_i32 << i).to_le_bytes());
        }
        let strides = filled(device, "asvgf strides", &strides, BufferUsages::UNIFORM);
        let on_cpu = device.adapter_info().device_type == DeviceType::Cpu;
        Self { size, pipelines, textures, timing, counters, strides, on_cpu }
    }

    /// Adapts a plan to the adapter.
    pub fn adapt(&self, plan: Plan) -> Plan {
        if self.on_cpu { plan.on_cpu() } else { plan }
    }

    /// Compiles those shaders of steps that are not compiled yet.
    pub fn compile(&self, steps: &[Step], traversal: Traversal) -> Result<(), Error> {
        steps.iter().try_for_each(|step| self.pipelines.kernel(step, traversal).map(|_| ()))
    }

    /// Makes the constants of a frame, for each batch of its paths. They have a buffer of their own, because the host may record other
    /// frames before it submits this one.
    pub fn uniform(&self, device: &Device, settings: &Settings, moment: &Moment, batches: &[[u32; 2]]) -> Buffer {
        let uniform = FrameUniform::new(self.size, moment, settings);
        filled(device, "asvgf frame", &frame::of_each_batch(uniform, batches), BufferUsages::UNIFORM)
    }

    /// Begins a frame with these constants. `passes` returns the most passes that it may have.
    pub fn begin(&self, device: &Device, index: u32, passes: impl FnOnce() -> usize, uniform: Buffer) -> Recording {
        let queries = self.timing.as_ref().map(|timing| timing.begin(device, index, passes()));
        Recording { uniform, index, counts: None, queries }
    }

    /// The same for a host's frame, whose cleaned input is counted.
    pub fn begin_counted(
        &self,
        device: &Device,
        index: u32,
        passes: impl FnOnce() -> usize,
        uniform: Buffer,
    ) -> Recording {
        let counts = self.counters.as_ref().map(|_| Counters::begin(device));
        Recording { counts, ..self.begin(device, index, passes, uniform) }
    }

    /// Records compiled steps, and calls `after` behind each.
    pub fn record<'a>(
        &'a self,
        device: &Device,
        encoder: &mut CommandEncoder,
        steps: &[Step],
        resources: &Resources<'a>,
        recording: &'a mut Recording,
        after: &mut impl FnMut(&Pass, &mut CommandEncoder),
    ) -> Result<(), Error> {
        let Recording { uniform, counts, queries, .. } = recording;
        for step in steps {
            let timestamps = queries.as_mut().and_then(|queries| queries.next(step.pass.name()));
            self.dispatch(device, encoder, step, resources, (uniform, counts.as_ref()), timestamps)?;
            after(step.pass, encoder);
        }
        Ok(())
    }

    /// Records a view's step, which is not part of a frame.
    pub fn show<'a>(
        &'a self,
        device: &Device,
        encoder: &mut CommandEncoder,
        step: &Step,
        resources: &Resources<'a>,
        uniform: &'a Buffer,
    ) -> Result<(), Error> {
        self.dispatch(device, encoder, step, resources, (uniform, None), None)
    }

    /// Ends a frame: its times and counts come back once the host has submitted it.
    pub fn end(&self, device: &Device, encoder: &mut CommandEncoder, recording: Recording) -> Buffer {
        let Recording { uniform, index, counts, queries } = recording;
        if let (Some(timing), Some(queries)) = (&self.timing, queries) {
            timing.end(device, encoder, queries);
        }
        if let (Some(counters), Some(counts)) = (&self.counters, &counts) {
            counters.end(device, encoder, counts, index);
        }
        uniform
    }

    fn dispatch<'a>(
        &'a self,
        device: &Device,
        encoder: &mut CommandEncoder,
        step: &Step,
        resources: &Resources<'a>,
        frame: (&'a Buffer, Option<&'a Buffer>),
        timestamp_writes: Option<ComputePassTimestampWrites<'_>>,
    ) -> Result<(), Error> {
        let kernel = self.pipelines.kernel(step, resources.traversal)?;
        let missing = |resource| {
            let what = match resource {
                Resource::Image(number) => step.bindings[number].name.to_owned(),
                other => format!("{other:?}"),
            };
            Error::Shader {
                shader: step.pass.name(),
                features: format!("{:?}", step.features),
                message: format!("nothing is bound to `{what}`"),
            }
        };
        let groups =
            kernel.bind(device, |resource| self.resource(resource, step, resources, frame)).map_err(missing)?;
        let [width, height] = step.grid().extent(self.size);
        let label = format!("asvgf {}", step.pass.name());
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor { label: Some(&label), timestamp_writes });
        pass.set_pipeline(&kernel.pipeline);
        for (index, group) in groups.iter().enumerate() {
            pass.set_bind_group(index as u32, group, &[]);
        }
        pass.dispatch_workgroups(width.div_ceil(8), height.div_ceil(8), 1);
        Ok(())
    }

    /// The buffer or view behind a binding of a step.
    fn resource<'a>(
        &'a self,
        resource: Resource,
        step: &Step,
        resources: &Resources<'a>,
        (uniform, counts): (&'a Buffer, Option<&'a Buffer>),
    ) -> Option<BindingResource<'a>> {
        let part = |buffer, offset, size: usize| {
            Some(BindingResource::Buffer(BufferBinding { buffer, offset, size: NonZeroU64::new(size as u64) }))
        };
        match resource {
            Resource::Image(number) => {
                let view = match step.bindings.get(number)?.slot {
                    slot @ (Slot::Now(_) | Slot::Before(_)) => self.textures.view(slot),
                    Slot::Target => resources.target,
                    Slot::Host(view) => (resources.host)(view),
                };
                view.map(BindingResource::TextureView)
            }
            Resource::Frame => part(uniform, u64::from(step.batch) * frame::SPACING as u64, size_of::<FrameUniform>()),
            Resource::Stride => part(&self.strides, u64::from(step.iteration) * STRIDE_SPACING, 4),
            Resource::Show => resources.show.map(Buffer::as_entire_binding),
            Resource::Counts => counts.map(Buffer::as_entire_binding),
            #[cfg(feature = "path-tracer")]
            Resource::Scene(binding) => (resources.scene)(binding),
        }
    }
}
