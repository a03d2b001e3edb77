//! The scene on the GPU, laid out as shaders/shared/scene.wgsl reads it.

use super::buffers::{buffer, check_size, check_texels, storage};
use super::bvh::Quantization;
use super::centre::{self, relative};
use super::facets::{self, Facet};
use super::folded::{self, Texel};
use super::geometry::{self, Geometry};
use super::instances::{self, Instance, NODE_TEXELS, top_level_nodes, top_level_texels};
use super::lights::{self, AnalyticLight, Emitter, GpuLight};
use super::sky::Sky;
use super::snapshot::{Snapshot, Visible};
use super::texels::{self, Images, Place};
use super::textures;
use super::{Light, Material, Pose, Scene, SceneError, materials};
use crate::plan::{Traits, Traversal};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Mat4};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use wgpu::{BindingResource, Buffer, BufferUsages, CommandEncoder, Device, DeviceType, Queue, Texture, TextureView};

/// Lights that the Blinn–Phong gradient evaluates; the strongest are kept.
const ANALYTIC_LIGHTS: usize = 64;

/// Slots of the traversal's stack: no tree that obvhs builds over real geometry comes near.
const LARGEST_STACK: u32 = 64;

/// Texels of a row of the lookup table, as in shaders/shared/scene.wgsl.
const ROW_TEXELS: usize = 3;

/// A [`Scene`] on the GPU: geometry and its trees once; placements, materials and lights as they are now.
///
/// Each mesh is stored once. What stands still is gathered into one tree in world space; meshes that move or repeat get
/// trees of their own under a second level, which is rebuilt when something moved. Coordinates count from a centre near the
/// scene's middle, so that a scene far from the origin looks as it does near.
#[derive(Debug)]
pub struct GpuScene {
    id: u64,
    traits: Traits,
    stack: u32,
    /// Where in the world coordinates on the GPU count from. It stays, as the last frame's coordinates count from it too.
    centre: DVec3,
    pose: Pose,
    /// The pose as paths see it.
    snapshot: Arc<Snapshot>,
    instances: Vec<Instance>,
    emitters: Vec<Emitter>,
    light_table: Vec<GpuLight>,
    /// Place in the light table of the first of `punctual`, which follow each other.
    first_punctual: usize,
    punctual: Vec<Punctual>,
    materials: Vec<Material>,
    images: Vec<Place>,
    header: Header,
    buffers: Buffers,
    triangles: usize,
    /// Corners of each row, where the scene has so few triangles that each is tested.
    few: Option<Vec<[[f32; 3]; 3]>>,
}

#[derive(Debug)]
struct Buffers {
    scene: Buffer,
    geometry: (Texture, TextureView),
    attributes: Buffer,
    images: Images,
    materials: (Texture, TextureView),
    lights: (Texture, TextureView),
    sky: Option<Sky>,
    facets: Buffer,
    facet_owners: Buffer,
}

/// A light without area and the node that places it.
#[derive(Debug)]
struct Punctual {
    node: usize,
    index: usize,
    light: Light,
}

/// `Scene` of scene.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
struct Header {
    instances: u32,
    instance_count: u32,
    light_count: u32,
    environment_light: u32,
    environment_width: u32,
    environment_height: u32,
    environment_run: u32,
    environment_cells: u32,
    attribute_stride: u32,
    uv0: u32,
    uv1: u32,
    environment_density: f32,
    grid_base: [f32; 3],
    root: u32,
    grid_step: [f32; 3],
    color_first: u32,
}

impl Header {
    fn set_grid(&mut self, grid: Quantization) {
        self.grid_base = grid.base;
        self.grid_step = grid.step;
    }
}

impl GpuScene {
    /// Builds the trees and uploads everything at rest. [`GpuScene::update`] then moves it.
    ///
    /// # Errors
    /// [`Scene::validate`]'s, and one that names the part of the scene that is larger than the device's textures or storage bindings.
    pub fn new(device: &Device, queue: &Queue, scene: &Scene) -> Result<Self, SceneError> {
        scene.validate()?;
        let pose = scene.pose(None, 0.0);
        let bounds = scene.bounds(&pose).map(|corners| corners.map(DVec3::from));
        let centre = bounds.map_or(DVec3::ZERO, centre::centre);
        let groups = geometry::groups(scene, &pose.world, centre);
        let instanced = groups.len() > 1 || !groups[0].nodes.is_empty();
        let instance_count: usize = groups.iter().map(|g| g.nodes.len().max(1)).sum();
        // The lookup table comes first, then the top level and the records, in rows of their own as they are replaced when
        // something moves, then the trees.
        let table_texels = groups.iter().map(|g| g.faces.len() * ROW_TEXELS).sum::<usize>();
        let (top, top_texels) = if instanced {
            (table_texels.next_multiple_of(folded::WIDTH), top_level_texels(instance_count))
        } else {
            (table_texels.next_multiple_of(NODE_TEXELS), 0)
        };
        let mut geometry = Geometry::new(scene, ((top + top_texels) / NODE_TEXELS) as u32);
        let mut traits = geometry::traits(scene, geometry.layout);
        let mut instances = Vec::new();
        let mut light_table = Vec::new();
        let mut powers = Vec::new();
        let mut emitters = BTreeMap::<(usize, usize), Emitter>::new();
        let mut next_id = 0;
        for group in groups {
            let built = geometry.add(scene, &group);
            let nodes: Vec<Option<usize>> =
                if group.nodes.is_empty() { vec![None] } else { group.nodes.iter().copied().map(Some).collect() };
            for node in nodes {
                let placement = node.map_or(Mat4::IDENTITY, |n| relative(&pose.world[n], group.centre, centre));
                let first_light = light_table.len() as u32;
                for &(row, face) in &built.emitters {
                    let material = scene.meshes[face.mesh].material;
                    let instance = instances.len();
                    light_table.push(GpuLight {
                        kind: lights::EMITTER,
                        triangle: row,
                        instance: instance as u32,
                        ..Default::default()
                    });
                    let [a, b, c] = face.corners.map(|p| placement.transform_point3(p));
                    let area = 0.5 * f64::from((b - a).cross(c - a).length());
                    powers.push(area * PI * lights::luminance(scene.materials[material].emissive));
                    let emitter = emitters.entry((instance, material)).or_insert_with(|| Emitter {
                        instance,
                        material,
                        ..Default::default()
                    });
                    emitter.add(face.corners, face.area_normal());
                }
                instances.push(Instance {
                    node,
                    centre: group.centre,
                    root: built.root,
                    first_row: built.first_row,
                    row_count: group.faces.len() as u32,
                    first_id: next_id,
                    first_light,
                    bounds: built.bounds,
                    grid: built.grid,
                });
                next_id += group.faces.len() as u32;
            }
        }
        let radius = bounds.map_or(1.0, |[low, high]| low.distance(high) / 2.0);
        let first_punctual = light_table.len();
        let mut punctual = Vec::new();
        for (node, description) in scene.nodes.iter().enumerate() {
            if let Some(index) = description.light {
                let light = scene.lights[index];
                punctual.push(Punctual { node, index, light });
                light_table.push(GpuLight::default());
                powers.push(lights::punctual_power(&light, radius));
            }
        }
        let images = texels::places(device, &scene.images)?;
        let layout = geometry.layout;
        let mut header = Header {
            instances: (top + top_level_nodes(instance_count) * NODE_TEXELS) as u32,
            root: (top / NODE_TEXELS) as u32,
            instance_count: instances.len() as u32,
            environment_light: u32::MAX,
            attribute_stride: layout.stride as u32,
            uv0: layout.uv[0].unwrap_or(0) as u32,
            uv1: layout.uv[1].unwrap_or(0) as u32,
            color_first: layout.color.unwrap_or(0) as u32,
            ..Default::default()
        };
        let sky = match &scene.environment {
            Some(environment) => Sky::new(device, queue, environment)?,
            None => None,
        };
        if let Some(sky) = &sky {
            header.environment_light = light_table.len() as u32;
            [header.environment_width, header.environment_height] = sky.size();
            header.environment_run = sky.cells.run;
            header.environment_cells = sky.cells.all | sky.cells.columns << 8;
            light_table.push(GpuLight { kind: lights::ENVIRONMENT, ..Default::default() });
            powers.push(sky.weight * PI * radius * radius);
        }
        traits.instanced = instanced;
        traits.punctual_lights = !punctual.is_empty();
        let image_texels = Images::new(device, queue, &scene.images);
        traits.folded_images = image_texels.are_folded();
        traits.environment = sky.is_some();
        traits.environment_run = sky.as_ref().map_or(0, |sky| 1 << sky.cells.run);
        traits.emitters &= first_punctual > 0;
        // Ids are numbered through all instances, so the next one is their triangles' number.
        traits.few_triangles = device.adapter_info().device_type == DeviceType::Cpu
            && next_id as usize <= facets::MOST
            && !traits.alpha_mask;
        lights::assign_probabilities(&mut light_table, &powers);
        if let (Some(sky), Some(light)) = (&sky, light_table.last()) {
            header.environment_density = (f64::from(light.pmf) / sky.weight) as f32;
        }
        header.light_count = light_table.len() as u32;

        // One slot for the bottom, one for the mark between the levels, one that is written before it is known to be kept.
        let (placements, depth) = placements(&mut header, instanced, &instances, &pose, centre);
        let stack = (geometry.depth + depth + 3).next_multiple_of(4);
        traits.levels = geometry.depth + depth;
        if stack > LARGEST_STACK {
            let reason = format!("their tree has {stack} levels, {LARGEST_STACK} at most can be traversed");
            return Err(SceneError { file: "scene".into(), element: "triangles".into(), reason });
        }
        let mut texels = folded::texels(&geometry.rows).to_vec();
        texels.extend(std::iter::repeat_n(Texel::default(), top - texels.len()));
        texels.extend(placements);
        texels.resize(top + top_texels, Texel::default());
        texels.extend_from_slice(folded::texels(&geometry.nodes));
        check_texels(device, "triangles and their trees", texels.len())?;
        check_size(device, "normals and texture coordinates", size_of_val(geometry.attributes.as_slice()))?;
        let empty = storage(device, "placeholder", &[0_u32; 4], 16);
        let folded = |label: &str, texels: &[Texel]| {
            let texture = folded::texture(device, queue, label, texels);
            let view = texture.create_view(&Default::default());
            (texture, view)
        };
        let id = {
            static NEXT: AtomicU64 = AtomicU64::new(1);
            NEXT.fetch_add(1, Ordering::Relaxed)
        };
        let visible = visible(&instances, &punctual, &pose);
        let mut this = Self {
            id,
            traits,
            stack,
            centre,
            pose: pose.clone(),
            // Its buffers are replaced below, once the lights have their places.
            snapshot: Arc::new(Snapshot {
                scene: id,
                visible,
                placements: empty.clone(),
                analytic_lights: empty.clone(),
            }),
            instances,
            emitters: emitters.into_values().collect(),
            light_table,
            first_punctual,
            punctual,
            materials: scene.materials.clone(),
            header,
            buffers: Buffers {
                scene: buffer(device, "scene", bytemuck::bytes_of(&header), BufferUsages::UNIFORM),
                geometry: folded("geometry", &texels),
                attributes: storage(device, "normals and texture coordinates", &geometry.attributes, 4),
                images: image_texels,
                materials: {
                    let materials = materials::materials(&scene.materials, &pose.emission, &images);
                    folded("materials", folded::texels(&materials))
                },
                // As above.
                lights: folded("lights", &[]),
                sky,
                facets: empty.clone(),
                facet_owners: empty,
            },
            images,
            triangles: geometry.rows.len(),
            few: traits.few_triangles.then(|| geometry.rows.iter().map(|row| row.map(corner)).collect()),
        };
        this.snapshot = this.take_snapshot(device, this.snapshot.visible.clone());
        this.buffers.lights = folded("lights", folded::texels(&this.light_table));
        this.upload_facets(device);
        Ok(this)
    }

    /// Moves what moves and dims what dims. A frame in which nothing does needs no call. What has changed since a denoiser's last
    /// frame follows from the pose that it rendered then: in any order of calls, and for several denoisers. What changes is recorded
    /// in the encoder, or goes into new buffers: frames that were recorded but not yet submitted keep theirs.
    ///
    /// # Errors
    /// One that names the element of the pose that does not belong to this scene or is not finite; nothing has changed then.
    pub fn update(&mut self, device: &Device, encoder: &mut CommandEncoder, pose: &Pose) -> Result<(), SceneError> {
        let wrong =
            |element: String, reason: &str| Err(SceneError { file: "pose".into(), element, reason: reason.into() });
        let lengths = |p: &Pose| [p.world.len(), p.emission.len(), p.intensity.len()];
        if lengths(pose) != lengths(&self.pose) {
            return wrong("lengths".into(), "differ from the scene's: make it with `Scene::pose` of the same scene");
        }
        // What f32 cannot hold is infinite in shaders.
        let finite = |x: &f64| x.abs() <= f64::from(f32::MAX);
        if let Some(i) = pose.world.iter().position(|m| !m.iter().flatten().all(finite)) {
            return wrong(format!("world[{i}]"), "is not finite");
        }
        if pose.emission.iter().chain(&pose.intensity).flatten().any(|f| !(f.is_finite() && *f >= 0.0)) {
            return wrong("emission or intensity".into(), "is negative or not finite");
        }
        self.pose = pose.clone();
        let (before, now) = (self.snapshot.clone(), visible(&self.instances, &self.punctual, pose));
        if now == before.visible {
            return Ok(());
        }
        if self.traits.instanced && !now.is_placed_as(&before.visible) {
            let (placements, _) = placements(&mut self.header, true, &self.instances, &self.pose, self.centre);
            self.buffers.scene = buffer(device, "scene", bytemuck::bytes_of(&self.header), BufferUsages::UNIFORM);
            let first_row = self.header.root / (folded::WIDTH / NODE_TEXELS) as u32;
            folded::replace(device, encoder, &self.buffers.geometry.0, first_row, &placements);
            self.upload_facets(device);
        }
        if !now.emits_as(&before.visible) {
            let materials = materials::materials(&self.materials, &pose.emission, &self.images);
            folded::replace(device, encoder, &self.buffers.materials.0, 0, folded::texels(&materials));
        }
        self.snapshot = self.take_snapshot(device, now);
        folded::replace(device, encoder, &self.buffers.lights.0, 0, folded::texels(&self.light_table));
        Ok(())
    }

    /// Number of triangles in the lookup table; instances share theirs.
    pub fn triangles(&self) -> usize {
        self.triangles
    }

    /// What the scene has, and so what the passes must contain.
    pub fn traits(&self) -> Traits {
        self.traits
    }

    /// Bytes of GPU memory that the scene takes.
    pub fn memory(&self) -> u64 {
        let b = &self.buffers;
        let sky = b.sky.iter().flat_map(|sky| [&sky.radiance.0, &sky.table.0]);
        let textures = [&b.geometry.0, &b.materials.0, &b.lights.0].into_iter().chain(sky);
        let buffers = [&b.attributes, &b.facets, &b.facet_owners];
        textures.map(textures::bytes).sum::<u64>() + buffers.iter().map(|b| b.size()).sum::<u64>() + b.images.bytes()
    }

    /// The scene as paths see it now.
    pub(crate) fn snapshot(&self) -> &Arc<Snapshot> {
        &self.snapshot
    }

    /// Where in the world coordinates on the GPU count from.
    pub(crate) fn centre(&self) -> [f64; 3] {
        self.centre.to_array()
    }

    /// How rays find their triangles in shaders for these traits, the scene's or more.
    pub(crate) fn traversal(&self, traits: &Traits) -> Traversal {
        match &self.few {
            Some(_) if traits.few_triangles => {
                Traversal::Every { triangles: (self.buffers.facets.size() / size_of::<Facet>() as u64) as u32 }
            }
            _ => Traversal::Tree { stack: self.stack },
        }
    }

    /// Makes rays go down the trees whatever there is to test.
    #[cfg(test)]
    pub(crate) fn use_trees(&mut self) {
        self.few = None;
        self.traits.few_triangles = false;
    }

    /// What stands behind a binding of shaders/shared/scene.wgsl or blinn_phong.wgsl.
    pub(crate) fn resource(&self, binding: &str) -> Option<BindingResource<'_>> {
        let b = &self.buffers;
        let buffer = match binding {
            "geometry" => return Some(BindingResource::TextureView(&b.geometry.1)),
            "materials" => return Some(BindingResource::TextureView(&b.materials.1)),
            "lights" => return Some(BindingResource::TextureView(&b.lights.1)),
            "images" => return Some(b.images.resource()),
            "environment" => return Some(BindingResource::TextureView(&b.sky.as_ref()?.radiance.1)),
            "environment_table" => return Some(BindingResource::TextureView(&b.sky.as_ref()?.table.1)),
            "scene" => &b.scene,
            "attributes" => &b.attributes,
            "facets" => &b.facets,
            "facet_owners" => &b.facet_owners,
            "analytic_lights" => &self.snapshot.analytic_lights,
            _ => return None,
        };
        Some(buffer.as_entire_binding())
    }

    /// The triangles of all instances in world space, where each of them is tested.
    fn upload_facets(&mut self, device: &Device) {
        let Some(corners) = &self.few else { return };
        let (mut all, mut owners) = (Vec::new(), Vec::new());
        for (number, instance) in self.instances.iter().enumerate() {
            let placement = instance.placement(&self.pose, self.centre);
            for row in instance.first_row..instance.first_row + instance.row_count {
                all.push(Facet::new(corners[row as usize], placement));
                owners.push([row, number as u32, 0, 0]);
            }
        }
        let count = facets::padded(all.len());
        all.resize(count, Facet::default());
        owners.resize(count, [0; 4]);
        let uniform = |label, contents| buffer(device, label, contents, BufferUsages::UNIFORM);
        self.buffers.facets = uniform("facets", bytemuck::cast_slice(&all));
        self.buffers.facet_owners = uniform("owners of facets", bytemuck::cast_slice(&owners));
    }

    /// Puts the lights where they are in this pose, and keeps it for later frames.
    fn take_snapshot(&mut self, device: &Device, visible: Visible) -> Arc<Snapshot> {
        let rows = instances::rows_of(&self.instances, &self.pose, self.centre);
        let placements = storage(device, "placements", &rows, 3 * size_of::<Texel>());
        Arc::new(Snapshot { scene: self.id, visible, placements, analytic_lights: self.place_lights(device) })
    }

    /// Puts the lights where they are in this pose. Returns those of the Blinn–Phong gradient.
    fn place_lights(&mut self, device: &Device) -> Buffer {
        let placement = |instance: usize| self.instances[instance].placement(&self.pose, self.centre);
        let lamp = |e: &Emitter| e.analytic(&self.materials, &self.pose, placement(e.instance));
        let mut analytic: Vec<AnalyticLight> = self.emitters.iter().map(lamp).collect();
        for (punctual, entry) in self.punctual.iter().zip(&mut self.light_table[self.first_punctual..]) {
            let placement = relative(&self.pose.world[punctual.node], DVec3::ZERO, self.centre);
            let placed = lights::punctual(&punctual.light, placement, self.pose.intensity[punctual.index]);
            *entry = GpuLight { alias: entry.alias, threshold: entry.threshold, pmf: entry.pmf, ..placed };
            analytic.push(AnalyticLight::from(placed));
        }
        analytic.sort_by(|a, b| lights::luminance(b.intensity).total_cmp(&lights::luminance(a.intensity)));
        analytic.truncate(ANALYTIC_LIGHTS);
        let count = analytic.len() as u32;
        analytic.resize(analytic.len().max(1), AnalyticLight::default());
        analytic.iter_mut().for_each(|light| light.count = count);
        storage(device, "analytic lights", &analytic, size_of::<AnalyticLight>())
    }
}

/// The part of a pose that paths see: the nodes where there is something.
fn visible(instances: &[Instance], punctual: &[Punctual], pose: &Pose) -> Visible {
    Visible::new(pose, instances.iter().filter_map(|i| i.node).chain(punctual.iter().map(|p| p.node)))
}

/// The top level and the instances' records in a pose, and the top level's depth. Empty where there is one level. The header
/// gets the grid of the boxes that rays meet first.
fn placements(
    header: &mut Header,
    instanced: bool,
    instances: &[Instance],
    pose: &Pose,
    centre: DVec3,
) -> (Vec<Texel>, u32) {
    if !instanced {
        header.set_grid(instances[0].grid);
        return (Vec::new(), 0);
    }
    let placed = instances::place(instances, pose, centre, header.root);
    header.set_grid(placed.grid);
    (placed.texels, placed.depth)
}

/// The vertex in a texel of the lookup table.
fn corner(texel: Texel) -> [f32; 3] {
    [texel[0], texel[1], texel[2]].map(f32::from_bits)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::passes::Pass;
    use crate::plan::{Feature, Features};
    use crate::twins::layout::{assert_layout, assert_layout_in, fields};

    #[test]
    fn the_scene_lies_where_the_shaders_read_it() {
        let header = fields!(Header: instances, instance_count, light_count, environment_light, environment_width,
            environment_height, environment_run, environment_cells, attribute_stride, uv0 as "uv_first",
            uv1 as "uv_second", environment_density, grid_base, root, grid_step, color_first);
        assert_layout("Scene", header, size_of::<Header>());
        let light = fields!(GpuLight: kind, alias as "alias_index", threshold, pmf, position, triangle, axis, instance,
            intensity, range, spot_scale, spot_offset);
        assert_layout("Light", light, size_of::<GpuLight>());
        let analytic = fields!(AnalyticLight: position, kind, axis, range, intensity, spot_scale, spot_offset, count);
        let blinn_phong = Features::of(&[Feature::BlinnPhong]);
        assert_layout_in(Pass::Gradient, blinn_phong, "AnalyticLight", analytic, size_of::<AnalyticLight>());
    }
}
