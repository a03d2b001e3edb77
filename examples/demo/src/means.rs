//! Means over an image, summed on the GPU and fetched without waiting, see means.wgsl.

use crate::readback::Readback;
use wgpu::{
    BindGroupDescriptor, BindGroupEntry, BindingResource, BufferDescriptor, BufferUsages, CommandEncoder,
    ComputePipeline, ComputePipelineDescriptor, Device, TextureView,
};

/// A quantity that is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    AdaptiveError,
    ConstantError,
    Lambda,
    HistoryLength,
}

/// The mean of a quantity over one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mean {
    pub quantity: Quantity,
    pub frame: u32,
    pub value: f64,
}

/// Measures means, and keeps those that have arrived until they are taken.
pub struct Means {
    mean: ComputePipeline,
    squared_error: ComputePipeline,
    arrived: Readback<Mean>,
}

impl Means {
    pub fn new(device: &Device) -> Self {
        let module = device.create_shader_module(wgpu::include_wgsl!("means.wgsl"));
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
        Self { mean: pipeline("mean"), squared_error: pipeline("squared_error"), arrived: Readback::default() }
    }

    /// Records the mean of an image's red channel or, given two independent images of the truth, of its squared error.
    pub fn record(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        (quantity, frame): (Quantity, u32),
        image: &TextureView,
        truth: Option<[&TextureView; 2]>,
    ) {
        let (width, height) = (image.texture().width(), image.texture().height());
        let rows = device.create_buffer(&BufferDescriptor {
            label: Some("means"),
            size: 4 * u64::from(height),
            usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let pipeline = if truth.is_some() { &self.squared_error } else { &self.mean };
        let images = [Some(image), truth.map(|t| t[0]), truth.map(|t| t[1])];
        let textures = images.into_iter().map(|image| image.map(BindingResource::TextureView));
        let resources = textures.chain([Some(rows.as_entire_binding())]).enumerate();
        let entries: Vec<BindGroupEntry<'_>> =
            resources.filter_map(|(i, r)| Some(BindGroupEntry { binding: i as u32, resource: r? })).collect();
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: Some("means"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(height, 1, 1);
        drop(pass);
        let pixels = f64::from(width) * f64::from(height);
        self.arrived.fetch(device, encoder, &rows, move |bytes| {
            let sum: f64 = floats(bytes).iter().map(|&x| f64::from(x)).sum();
            Mean { quantity, frame, value: sum / pixels }
        });
    }

    /// Takes the means that have arrived since the last call.
    pub fn take(&self) -> Vec<Mean> {
        self.arrived.take()
    }
}

/// Converts bytes from the GPU to numbers.
pub fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}
