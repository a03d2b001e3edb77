//! Devices that are lost or offer too little. The files named `refusals.rs` test refused views, sizes, settings and
//! cameras.

use super::{Breaks, Case, Named, Worst};
use crate::stability::common::gpu::texture;
use asvgf::scene::{GpuScene, builtin};
use asvgf::{Camera, Denoiser, DenoiserDescriptor, Error, Frame, Settings, Shading, Surfaces, View, ViewOptions};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use wgpu::{
    Device, DeviceDescriptor, Instance, InstanceDescriptor, Limits, MemoryBudgetThresholds, Queue, TextureFormat,
    TextureUsages, TextureView,
};

pub const CASES: &[Case] = &[
    Case {
        name: "a device that is lost",
        varied: "before `new`, before a frame, between its two calls, after it; each call of the interface",
        quantity: "calls that panic",
        bound: 0.0,
        origin: "the device itself reports the loss to its host, by `set_device_lost_callback`",
        measure: lost,
        breaks: Breaks::Never("nothing waits for the device"),
    },
    Case {
        name: "memory that is full",
        varied: "no allocation succeeds; each call of the interface",
        quantity: "calls that panic",
        bound: 0.0,
        origin: "the device itself reports it to its host, by `on_uncaptured_error` or an error scope around `new` and `resize`",
        measure: out_of_memory,
        breaks: Breaks::Never("the denoiser uses unallocated resources as if they existed, and wgpu refuses them"),
    },
    Case {
        name: "limits below the default",
        varied: "each of ten limits that the passes need, alone, at one less than the default",
        quantity: "devices that are not refused with `Error::Limit` and the limit's name",
        bound: 0.0,
        origin: "`Denoiser::requirements`",
        measure: low_limits,
        breaks: Breaks::Never("every limit is compared"),
    },
    Case {
        name: "the largest sizes",
        varied: "3840×2160, 8192×1, 1×8192, 8192×8192 on a device without memory and with the default limits",
        quantity: "errors of the device or of the denoiser, over three frames of either kind",
        bound: 0.0,
        origin: "core limits of WebGPU",
        measure: large,
        breaks: Breaks::Known(
            "memory: the device reports an image that does not fit as out of memory, and nothing panics",
        ),
    },
];

/// Opens a device that validates and computes nothing, and counts its errors.
fn idle(limits: Limits) -> (Device, Queue, Arc<AtomicU32>) {
    let noop = wgpu::NoopBackendOptions { enable: true, ..Default::default() };
    let instance = Instance::new(InstanceDescriptor {
        backends: wgpu::Backends::NOOP,
        backend_options: wgpu::BackendOptions { noop, ..Default::default() },
        ..InstanceDescriptor::new_without_display_handle()
    });
    let adapter = pollster::block_on(instance.request_adapter(&Default::default())).unwrap();
    let descriptor = DeviceDescriptor { required_limits: limits, ..Default::default() };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).unwrap();
    let errors = Arc::new(AtomicU32::new(0));
    let counted = Arc::clone(&errors);
    device.on_uncaptured_error(Arc::new(move |_| {
        counted.fetch_add(1, Ordering::Relaxed);
    }));
    (device, queue, errors)
}

fn view(device: &Device, size: [u32; 2], format: TextureFormat, usage: TextureUsages) -> TextureView {
    texture(device, size, format, usage).create_view(&Default::default())
}

/// Views of one size that a host hands in.
struct Images {
    depth: TextureView,
    color: TextureView,
    motion: TextureView,
    target: TextureView,
}

impl Images {
    fn new(device: &Device, size: [u32; 2]) -> Self {
        let read = |format| view(device, size, format, TextureUsages::TEXTURE_BINDING);
        Self {
            depth: read(TextureFormat::R32Float),
            color: read(TextureFormat::Rgba16Float),
            motion: read(TextureFormat::Rg32Float),
            target: view(device, size, TextureFormat::Rgba16Float, TextureUsages::STORAGE_BINDING),
        }
    }

    fn surfaces(&self, index: u32) -> Surfaces<'_> {
        Surfaces::new(Camera::default(), index, &self.depth, &self.color, &self.motion)
    }
}

/// Calls, one of which is the first on a lost device.
const CALLS: [&str; 6] = ["new", "begin_frame", "denoise", "render", "show", "resize"];

fn lost() -> Worst {
    let mut worst = Worst::default();
    for (number, call) in CALLS.into_iter().enumerate() {
        let (device, queue, _) = idle(Limits::default());
        let lose = |at| {
            if at == number {
                device.destroy();
            }
        };
        worst.add(panics(&device, &queue, [16, 9], lose).into(), || format!("lost before `{call}`"));
    }
    worst
}

/// Makes all calls of the interface in turn, after `before` with the number of each; returns the number of panics.
fn panics(device: &Device, queue: &Queue, size: [u32; 2], before: impl Fn(usize)) -> u32 {
    let images = Images::new(device, size);
    let descriptor = DenoiserDescriptor { size, diagnostics: true, ..Default::default() };
    let scene = builtin::scene("cornell", "all").unwrap();
    let mut panics = 0;
    // Objects that could not be made cannot be called.
    let (mut denoiser, mut uploaded) = (None, None);
    for (number, step) in CALLS.into_iter().enumerate() {
        before(number);
        let mut encoder = device.create_command_encoder(&Default::default());
        let called = catch_unwind(AssertUnwindSafe(|| {
            if step == "new" {
                denoiser = Denoiser::new(device, queue, &descriptor).ok();
                uploaded = GpuScene::new(device, queue, &scene).ok();
            }
            let (Some(denoiser), Some(uploaded)) = (&mut denoiser, &mut uploaded) else { return };
            // Errors are fine, panics are not.
            let _ = match step {
                "begin_frame" => denoiser.begin_frame(device, &mut encoder, &images.surfaces(0)).map(|_| ()),
                "denoise" => denoiser.denoise(device, &mut encoder, &Shading::new(&images.color, &images.target)),
                "render" => {
                    let _ = uploaded.update(device, &mut encoder, &scene.pose(Some(0), 0.5));
                    let camera = Camera::default();
                    let frame = Frame::new(uploaded, camera, 1, &images.target);
                    denoiser.render(device, &mut encoder, &frame)
                }
                "show" => {
                    let options = ViewOptions::default();
                    denoiser.show(device, &mut encoder, View::Depth, options, &images.target)
                }
                "resize" => denoiser.resize(device, [8, 8]),
                _ => Ok(()),
            };
            denoiser.take_counts();
            denoiser.take_times();
        }));
        panics += u32::from(called.is_err());
        queue.submit([encoder.finish()]);
    }
    panics
}

/// Tests an allocation that wgpu refuses: it refuses any beyond a share of the driver's free memory; with a share of 0,
/// all.
fn out_of_memory() -> Worst {
    let mut worst = Worst::default();
    let thresholds = MemoryBudgetThresholds { for_resource_creation: Some(0), ..Default::default() };
    let instance = Instance::new(InstanceDescriptor {
        // These backends know the free memory.
        backends: wgpu::Backends::VULKAN | wgpu::Backends::DX12,
        memory_budget_thresholds: thresholds,
        ..InstanceDescriptor::new_without_display_handle()
    });
    let adapter = pollster::block_on(instance.request_adapter(&Default::default())).unwrap();
    let (device, queue) = pollster::block_on(adapter.request_device(&DeviceDescriptor::default())).unwrap();
    let failed = Arc::new(AtomicU32::new(0));
    let counted = Arc::clone(&failed);
    device.on_uncaptured_error(Arc::new(move |error| {
        counted.fetch_add(u32::from(matches!(error, wgpu::Error::OutOfMemory { .. })), Ordering::Relaxed);
    }));
    let panics = panics(&device, &queue, [640, 360], |_| {});
    let failed = failed.load(Ordering::Relaxed);
    worst.add(panics.into(), || match failed {
        0 => "nothing: this driver does not say how much is free".into(),
        _ => format!("{failed} allocations that failed"),
    });
    worst
}

/// A limit's name, and a function that lowers it.
type Lower = Named<fn(&mut Limits)>;

const LIMITS: [Lower; 10] = [
    ("max_texture_dimension_2d", |l| l.max_texture_dimension_2d -= 1),
    ("max_bind_groups", |l| l.max_bind_groups -= 1),
    ("max_sampled_textures_per_shader_stage", |l| l.max_sampled_textures_per_shader_stage -= 1),
    ("max_storage_buffers_per_shader_stage", |l| l.max_storage_buffers_per_shader_stage -= 1),
    ("max_storage_textures_per_shader_stage", |l| l.max_storage_textures_per_shader_stage -= 1),
    ("max_uniform_buffers_per_shader_stage", |l| l.max_uniform_buffers_per_shader_stage -= 1),
    ("max_compute_invocations_per_workgroup", |l| l.max_compute_invocations_per_workgroup -= 1),
    ("max_compute_workgroup_size_x", |l| l.max_compute_workgroup_size_x -= 1),
    ("max_compute_workgroups_per_dimension", |l| l.max_compute_workgroups_per_dimension -= 1),
    ("max_storage_buffer_binding_size", |l| l.max_storage_buffer_binding_size -= 4),
];

fn low_limits() -> Worst {
    let mut worst = Worst::default();
    for (name, lower) in LIMITS {
        let mut limits = Limits::default();
        lower(&mut limits);
        let (device, queue, _) = idle(limits);
        let descriptor = DenoiserDescriptor { size: [16, 9], ..Default::default() };
        let refused = match Denoiser::new(&device, &queue, &descriptor) {
            Err(Error::Limit { limit, needed, available }) => limit == name && needed > available,
            _ => false,
        };
        worst.add(f64::from(u8::from(!refused)), || name.into());
    }
    worst
}

fn large() -> Worst {
    let mut worst = Worst::default();
    for size in [[3840, 2160], [8192, 1], [1, 8192], [8192, 8192]] {
        let (device, queue, errors) = idle(Limits::default());
        let images = Images::new(&device, size);
        let scene = builtin::scene("cornell", "all").unwrap();
        let mut uploaded = GpuScene::new(&device, &queue, &scene).unwrap();
        for settings in [Settings::adaptive(), Settings::classic()] {
            let descriptor = DenoiserDescriptor { size, settings, ..Default::default() };
            let mut denoiser = Denoiser::new(&device, &queue, &descriptor).unwrap();
            for index in 0..3 {
                let mut encoder = device.create_command_encoder(&Default::default());
                let mut refused = 0;
                refused += u32::from(denoiser.begin_frame(&device, &mut encoder, &images.surfaces(index)).is_err());
                let shading = Shading::new(&images.color, &images.target);
                refused += u32::from(denoiser.denoise(&device, &mut encoder, &shading).is_err());
                refused += u32::from(uploaded.update(&device, &mut encoder, &scene.pose(Some(0), 0.1)).is_err());
                let frame = Frame::new(&uploaded, Camera::default(), index, &images.target);
                refused += u32::from(denoiser.render(&device, &mut encoder, &frame).is_err());
                queue.submit([encoder.finish()]);
                let found = refused + errors.load(Ordering::Relaxed);
                worst.add(found.into(), || format!("{size:?}, frame {index}"));
            }
        }
    }
    worst
}
