//! Runs a test's own shader on numbers.

use super::gpu::gpu;
use crate::gpu::compose::{Permutation, Shaders};
use crate::gpu::kernel::used_bindings;
use crate::passes::{Features, Pass, SceneBinding};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{
    BindGroupDescriptor, BindGroupEntry, BindingResource, BufferUsages, ComputePipelineDescriptor,
    ShaderModuleDescriptor, ShaderSource,
};

/// Binds the numbers at 0 and a number of results at 1, and starts an invocation for each of the numbers.
pub(super) fn compute(
    source: &str,
    pass: &'static Pass,
    features: Features,
    numbers: &[[f32; 4]],
    results: usize,
) -> Vec<[f32; 4]> {
    compute_with(source, pass, features, numbers, results, &|_| None)
}

/// Does the same with the bindings of group 1 by name, if the shader has any.
pub(super) fn compute_with<'a>(
    source: &str,
    pass: &'static Pass,
    features: Features,
    numbers: &[[f32; 4]],
    results: usize,
    resource: &dyn Fn(SceneBinding) -> Option<BindingResource<'a>>,
) -> Vec<[f32; 4]> {
    let gpu = gpu();
    let device = &gpu.device;
    let permutation = Permutation { pass, features, traversal: Default::default(), view: None };
    let module =
        Shaders::new().and_then(|mut s| s.compose_source(source, permutation)).unwrap_or_else(|e| panic!("{e}"));
    let used = used_bindings(&module).unwrap();
    let module = device.create_shader_module(ShaderModuleDescriptor {
        label: Some("test"),
        source: ShaderSource::Naga(std::borrow::Cow::Owned(module)),
    });
    let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor {
        label: Some("test"),
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    });
    let given = device.create_buffer_init(&BufferInitDescriptor {
        label: Some("numbers"),
        contents: bytemuck::cast_slice(numbers),
        usage: BufferUsages::STORAGE,
    });
    let found = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("results"),
        size: 16 * results as u64,
        usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let group = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            BindGroupEntry { binding: 0, resource: given.as_entire_binding() },
            BindGroupEntry { binding: 1, resource: found.as_entire_binding() },
        ],
    });
    let entries: Vec<_> = used
        .iter()
        .filter(|u| u.group == 1)
        .map(|u| BindGroupEntry {
            binding: u.binding,
            resource: SceneBinding::named(&u.name).and_then(resource).unwrap_or_else(|| panic!("no `{}`", u.name)),
        })
        .collect();
    let layout = (!entries.is_empty()).then(|| pipeline.get_bind_group_layout(1));
    let of_scene = layout.map(|layout| {
        device.create_bind_group(&BindGroupDescriptor { label: None, layout: &layout, entries: &entries })
    });
    let readable = gpu.readable(found.size());
    gpu.submit(|encoder| {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        if let Some(of_scene) = &of_scene {
            pass.set_bind_group(1, of_scene, &[]);
        }
        pass.dispatch_workgroups(numbers.len().div_ceil(64) as u32, 1, 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&found, 0, &readable, 0, found.size());
    });
    bytemuck::pod_collect_to_vec(&gpu.map(&readable))
}
