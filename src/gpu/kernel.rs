//! A compiled shader. Its layout follows from the shader alone, which is the single source of truth. The names of its bindings are
//! resolved here, once.

use super::resource::Resource;
use crate::Error;
use crate::passes::Step;
use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};
use wgpu::naga::{self, AddressSpace, ImageClass, Module, ScalarKind, StorageAccess, TypeInner};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry,
    BindingResource, BindingType, BufferBindingType, ComputePipeline, ComputePipelineDescriptor, Device,
    PipelineCompilationOptions, PipelineLayoutDescriptor, ShaderModuleDescriptor, ShaderSource, ShaderStages,
    StorageTextureAccess, TextureFormat, TextureSampleType, TextureViewDimension,
};

/// A pipeline and the resources that it binds.
#[derive(Debug)]
pub(crate) struct Kernel {
    pub pipeline: ComputePipeline,
    groups: Vec<Group>,
    label: String,
}

/// The layout of a bind group and the resource behind each of its bindings.
#[derive(Debug)]
struct Group {
    layout: BindGroupLayout,
    bindings: Vec<(u32, Resource)>,
}

/// A binding that a shader uses.
#[derive(Debug)]
pub(crate) struct Used {
    pub group: u32,
    pub binding: u32,
    pub name: String,
    pub ty: BindingType,
}

impl Kernel {
    /// Compiles a step's composed module.
    pub fn new(device: &Device, module: Module, step: &Step) -> Result<Self, Error> {
        let failed =
            |message| Error::Shader { shader: step.pass.name(), features: format!("{:?}", step.features), message };
        let used = used_bindings(&module).map_err(failed)?;
        let label = format!("asvgf {}", step.pass.name());
        let group_count = used.iter().map(|u| u.group + 1).max().unwrap_or(0);
        let group = |number| {
            let of_group = || used.iter().filter(move |u| u.group == number);
            let entries: Vec<_> = of_group()
                .map(|u| BindGroupLayoutEntry {
                    binding: u.binding,
                    visibility: ShaderStages::COMPUTE,
                    ty: u.ty,
                    count: None,
                })
                .collect();
            let layout =
                device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some(&label), entries: &entries });
            let resource = |u: &Used| {
                Resource::named(&u.name, step)
                    .ok_or_else(|| failed(format!("nothing is known by the name `{}`", u.name)))
            };
            let bindings = of_group().map(|u| Ok((u.binding, resource(u)?))).collect::<Result<_, Error>>()?;
            Ok(Group { layout, bindings })
        };
        let groups = (0..group_count).map(group).collect::<Result<Vec<_>, Error>>()?;
        let layouts: Vec<_> = groups.iter().map(|group| Some(&group.layout)).collect();
        let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some(&label),
            bind_group_layouts: &layouts,
            immediate_size: 0,
        });
        let module = device.create_shader_module(ShaderModuleDescriptor {
            label: Some(&label),
            source: ShaderSource::Naga(std::borrow::Cow::Owned(module)),
        });
        let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some(&label),
            layout: Some(&layout),
            module: &module,
            entry_point: Some("main"),
            // Every variable is assigned before it is read.
            compilation_options: PipelineCompilationOptions {
                zero_initialize_workgroup_memory: false,
                ..Default::default()
            },
            cache: None,
        });
        Ok(Self { pipeline, groups, label })
    }

    /// The resources that the kernel binds.
    #[cfg(all(test, feature = "path-tracer"))]
    pub fn resources(&self) -> impl Iterator<Item = Resource> {
        self.groups.iter().flat_map(|group| &group.bindings).map(|(_, resource)| *resource)
    }

    /// Makes bind groups with the resources that `find` returns.
    ///
    /// # Errors
    /// Names the resource that is missing.
    pub fn bind<'a>(
        &self,
        device: &Device,
        find: impl Fn(Resource) -> Option<BindingResource<'a>>,
    ) -> Result<Vec<BindGroup>, Resource> {
        let bind = |group: &Group| {
            let entry = |&(binding, resource)| {
                find(resource).map(|resource| BindGroupEntry { binding, resource }).ok_or(resource)
            };
            let entries = group.bindings.iter().map(entry).collect::<Result<Vec<_>, _>>()?;
            let label = Some(self.label.as_str());
            Ok(device.create_bind_group(&BindGroupDescriptor { label, layout: &group.layout, entries: &entries }))
        };
        self.groups.iter().map(bind).collect()
    }
}

/// Validates a module for core WebGPU without extensions, and lists the bindings that its entry point reaches.
pub(crate) fn used_bindings(module: &Module) -> Result<Vec<Used>, String> {
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(module)
        .map_err(|e| format!("{:?}", e.into_inner()))?;
    let entry = info.get_entry_point(0);
    let mut used = Vec::new();
    for (handle, variable) in module.global_variables.iter() {
        let Some(binding) = variable.binding else { continue };
        if entry[handle].is_empty() {
            continue;
        }
        let name = plain_name(variable.name.as_deref().unwrap_or_default()).to_owned();
        let ty = binding_type(module, variable).ok_or_else(|| format!("the binding `{name}` has an unknown type"))?;
        used.push(Used { group: binding.group, binding: binding.binding, name, ty });
    }
    used.sort_by_key(|u| (u.group, u.binding));
    Ok(used)
}

/// Removes the name of the module, which the composer appends to imported variables.
fn plain_name(name: &str) -> &str {
    name.split("X_naga_oil").next().unwrap_or(name)
}

fn binding_type(module: &Module, variable: &naga::GlobalVariable) -> Option<BindingType> {
    let buffer = |ty| BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    match variable.space {
        AddressSpace::Uniform => Some(buffer(BufferBindingType::Uniform)),
        AddressSpace::Storage { access } => {
            Some(buffer(BufferBindingType::Storage { read_only: !access.contains(StorageAccess::STORE) }))
        }
        _ => match module.types[variable.ty].inner {
            TypeInner::Image { class: ImageClass::Sampled { kind, .. }, arrayed, .. } => Some(BindingType::Texture {
                sample_type: match kind {
                    ScalarKind::Uint => TextureSampleType::Uint,
                    ScalarKind::Sint => TextureSampleType::Sint,
                    _ => TextureSampleType::Float { filterable: false },
                },
                view_dimension: if arrayed { TextureViewDimension::D2Array } else { TextureViewDimension::D2 },
                multisampled: false,
            }),
            TypeInner::Image { class: ImageClass::Storage { format, access }, .. } => {
                Some(BindingType::StorageTexture {
                    access: if access.contains(StorageAccess::LOAD) {
                        StorageTextureAccess::ReadOnly
                    } else {
                        StorageTextureAccess::WriteOnly
                    },
                    format: texture_format(format)?,
                    view_dimension: TextureViewDimension::D2,
                })
            }
            _ => None,
        },
    }
}

/// The storage formats that the shaders use.
fn texture_format(format: naga::StorageFormat) -> Option<TextureFormat> {
    use naga::StorageFormat as F;
    Some(match format {
        F::R32Uint => TextureFormat::R32Uint,
        F::R32Float => TextureFormat::R32Float,
        F::Rg32Uint => TextureFormat::Rg32Uint,
        F::Rg32Float => TextureFormat::Rg32Float,
        F::Rgba8Unorm => TextureFormat::Rgba8Unorm,
        F::Rgba16Float => TextureFormat::Rgba16Float,
        F::Rgba32Uint => TextureFormat::Rgba32Uint,
        F::Rgba32Float => TextureFormat::Rgba32Float,
        _ => return None,
    })
}
