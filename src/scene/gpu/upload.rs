//! The buffers and textures of a scene, made from an [`Assembly`].

use super::arrangement::{Facets, TopLevel};
use super::assembly::Assembly;
use super::geometry::deforming::Reshaped;
use super::geometry::instances::NODE_TEXELS;
use super::geometry::sections::ROW_TEXELS;
use super::light::radiance::pack;
use super::light::record::GpuLight;
use super::light::sky::SkyTable;
use super::memory::buffers::{buffer, replaceable, storage};
use super::memory::folded::{self, Texel};
use super::memory::pieces::{self, PIECE, Writer};
use super::surface::images::Images;
use crate::passes::SceneBinding;
use crate::scene::description::Environment;
use bytemuck::Pod;
use wgpu::{
    BindingResource, Buffer, BufferUsages, CommandEncoder, Device, Queue, Texture, TextureFormat, TextureView,
    TextureViewDimension,
};

/// A texture and its view.
type Viewed = (Texture, TextureView);

/// A scene on the GPU, laid out as shaders/shared/scene.wgsl reads it.
#[derive(Debug)]
pub(crate) struct Buffers {
    scene: Buffer,
    geometry: Viewed,
    attributes: Buffer,
    images: Images,
    materials: Viewed,
    lights: Viewed,
    sky: Option<Sky>,
    /// Triangles and their owners.
    facets: [Buffer; 2],
}

#[derive(Debug)]
struct Sky {
    radiance: Viewed,
    table: Viewed,
}

impl Buffers {
    pub fn new(device: &Device, queue: &Queue, assembly: &Assembly<'_>) -> Self {
        let &Assembly { ref header, ref geometry, ref attributes, ref materials, images, ref sky, .. } = assembly;
        let attribute_buffer = if assembly.contents.deforming { replaceable } else { storage };
        Self {
            scene: buffer(device, "scene", bytemuck::bytes_of(header), BufferUsages::UNIFORM),
            geometry: folded(device, queue, "geometry", geometry),
            attributes: attribute_buffer(device, "normals and texture coordinates", attributes, 4),
            images: Images::new(device, queue, images, assembly.contents.folded_images),
            materials: folded(device, queue, "materials", materials),
            lights: folded(device, queue, "lights", &assembly.arrangement.lights.texels()),
            sky: sky.as_ref().map(|(environment, table)| Sky::new(device, queue, environment, table)),
            facets: facets(device, assembly.facets.as_ref()),
        }
    }

    /// Records the replacement of the top level and the records of instances.
    pub fn replace_top_level(&mut self, device: &Device, encoder: &mut CommandEncoder, top_level: &TopLevel) {
        self.scene = buffer(device, "scene", bytemuck::bytes_of(&top_level.header), BufferUsages::UNIFORM);
        let first = top_level.header.root() as usize * NODE_TEXELS;
        folded::replace(device, encoder, &self.geometry.0, first, &top_level.texels);
    }

    /// Records the replacement of a mesh's shape: its rows, normals and tree.
    pub fn replace_shape(&self, device: &Device, encoder: &mut CommandEncoder, shape: &Reshaped) {
        let geometry = &self.geometry.0;
        let Reshaped { first_row, rows, attributes: (first_word, words), first_node, nodes } = shape;
        folded::replace(device, encoder, geometry, *first_row as usize * ROW_TEXELS, folded::texels(rows));
        folded::replace(device, encoder, geometry, *first_node as usize * NODE_TEXELS, folded::texels(nodes));
        if !words.is_empty() {
            let staging = buffer(device, "staging", bytemuck::cast_slice(words), BufferUsages::COPY_SRC);
            let offset = (first_word * size_of::<u32>()) as u64;
            encoder.copy_buffer_to_buffer(&staging, 0, &self.attributes, offset, staging.size());
        }
    }

    /// Replaces the triangles in world space of a scene that has few.
    pub fn replace_facets(&mut self, device: &Device, new: &Facets) {
        self.facets = facets(device, Some(new));
    }

    /// Records the replacement of the materials.
    pub fn replace_materials(&self, device: &Device, encoder: &mut CommandEncoder, materials: &[Texel]) {
        folded::replace(device, encoder, &self.materials.0, 0, materials);
    }

    /// Records the replacement of the lights.
    pub fn replace_lights(&self, device: &Device, encoder: &mut CommandEncoder, lights: &[GpuLight]) {
        folded::replace(device, encoder, &self.lights.0, 0, folded::texels(lights));
    }

    /// The resource behind a binding of shaders/shared/scene.wgsl.
    pub fn resource(&self, binding: SceneBinding) -> Option<BindingResource<'_>> {
        let buffer = match binding {
            SceneBinding::Geometry => return Some(BindingResource::TextureView(&self.geometry.1)),
            SceneBinding::Materials => return Some(BindingResource::TextureView(&self.materials.1)),
            SceneBinding::Lights => return Some(BindingResource::TextureView(&self.lights.1)),
            SceneBinding::Images => return Some(self.images.resource()),
            SceneBinding::Environment => return Some(BindingResource::TextureView(&self.sky.as_ref()?.radiance.1)),
            SceneBinding::EnvironmentTable => return Some(BindingResource::TextureView(&self.sky.as_ref()?.table.1)),
            SceneBinding::Scene => &self.scene,
            SceneBinding::Attributes => &self.attributes,
            SceneBinding::Facets => &self.facets[0],
            SceneBinding::FacetOwners => &self.facets[1],
            SceneBinding::PlacementsBefore
            | SceneBinding::CornersBefore
            | SceneBinding::AnalyticLights
            | SceneBinding::AnalyticLightsBefore => {
                return None;
            }
        };
        Some(buffer.as_entire_binding())
    }

    /// Bytes of GPU memory.
    pub fn memory(&self) -> u64 {
        let sky = self.sky.iter().flat_map(|sky| [&sky.radiance.0, &sky.table.0]);
        let textures = [&self.geometry.0, &self.materials.0, &self.lights.0].into_iter().chain(sky);
        let buffers = [&self.attributes].into_iter().chain(&self.facets);
        textures.map(pieces::bytes).sum::<u64>() + buffers.map(Buffer::size).sum::<u64>() + self.images.bytes()
    }
}

impl Sky {
    /// Uploads an environment piece by piece.
    fn new(device: &Device, queue: &Queue, environment: &Environment, table: &SkyTable) -> Self {
        let [width, height] = table.size;
        let size = [width, height, 1];
        let radiance = pieces::texture(device, "environment", TextureFormat::Rg32Uint, size, TextureViewDimension::D2);
        let mut writer = Writer::new(queue);
        let rows_of_piece = (PIECE / (width as usize * size_of::<[u32; 2]>())).max(1);
        let mut first_row = 0;
        for piece in environment.radiance.chunks(rows_of_piece * width as usize) {
            let packed: Vec<[u32; 2]> = piece.iter().map(|&c| pack(c)).collect();
            writer.rows(&radiance.0, [0, first_row], bytemuck::cast_slice(&packed));
            first_row += rows_of_piece as u32;
        }
        Self { radiance, table: folded(device, queue, "cells of the environment", &table.texels) }
    }
}

fn folded<T: Pod>(device: &Device, queue: &Queue, label: &str, values: &[T]) -> Viewed {
    let texture = folded::texture(device, queue, label, folded::texels(values));
    let view = texture.create_view(&Default::default());
    (texture, view)
}

/// The triangles in world space and their owners, or placeholders.
fn facets(device: &Device, facets: Option<&Facets>) -> [Buffer; 2] {
    let Some(Facets { facets, owners }) = facets else {
        let empty = storage(device, "placeholder", &[0_u32; 4], 16);
        return [empty.clone(), empty];
    };
    let uniform = |label, contents| buffer(device, label, contents, BufferUsages::UNIFORM);
    [uniform("facets", bytemuck::cast_slice(facets)), uniform("owners of facets", bytemuck::cast_slice(owners))]
}
