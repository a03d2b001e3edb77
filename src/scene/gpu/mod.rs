//! The GPU half: [`assembly`] lays a scene out as plain data, [`upload`] carries that out, [`arrangement`] follows the pose.

mod arrangement;
mod assembly;
mod geometry;
mod header;
mod light;
mod memory;
mod snapshot;
mod surface;
mod traits;
mod tree;
mod upload;
mod visible;

#[cfg(test)]
pub(crate) use light::radiance::{pack, unpack};
pub(crate) use snapshot::Snapshot;

use super::description::{Pose, Scene, SceneError};
use crate::plan::{Traits, Traversal};
use arrangement::Arrangement;
use assembly::Assembly;
use memory::capacity::Capacity;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use upload::Buffers;
use wgpu::{BindingResource, CommandEncoder, Device, Queue};

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
    triangles: usize,
    arrangement: Arrangement,
    buffers: Buffers,
    /// The pose as paths see it.
    snapshot: Arc<Snapshot>,
}

impl GpuScene {
    /// Builds the trees and uploads everything at rest. [`GpuScene::update`] then moves it.
    ///
    /// # Errors
    /// [`Scene::validate`]'s, and one that names the part of the scene that is larger than the device's textures or storage bindings.
    pub fn new(device: &Device, queue: &Queue, scene: &Scene) -> Result<Self, SceneError> {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        let assembly = Assembly::of(scene, &Capacity::of(device))?;
        let buffers = Buffers::new(device, queue, &assembly);
        let id = NEXT.fetch_add(1, Ordering::Relaxed);
        let Assembly { traits, stack, triangles, pose, arrangement, analytic_lights, .. } = assembly;
        let (visible, placements) = (arrangement.visible(&pose), arrangement.placements(&pose));
        let snapshot = Arc::new(Snapshot::new(device, id, visible, &placements, &analytic_lights));
        Ok(Self { id, traits, stack, triangles, arrangement, buffers, snapshot })
    }

    /// Moves what moves and dims what dims. A frame in which nothing does needs no call. What has changed since a denoiser's last
    /// frame follows from the pose that it rendered then: in any order of calls, and for several denoisers. What changes is recorded
    /// in the encoder, or goes into new buffers: frames that were recorded but not yet submitted keep theirs.
    ///
    /// # Errors
    /// One that names the element of the pose that does not belong to this scene or is not finite; nothing has changed then.
    pub fn update(&mut self, device: &Device, encoder: &mut CommandEncoder, pose: &Pose) -> Result<(), SceneError> {
        self.arrangement.check(pose)?;
        let (before, now) = (&self.snapshot.visible, self.arrangement.visible(pose));
        if now == *before {
            return Ok(());
        }
        if self.arrangement.instanced && !now.is_placed_as(before) {
            self.buffers.replace_top_level(device, encoder, &self.arrangement.top_level(pose));
            if let Some(facets) = self.arrangement.facets(pose) {
                self.buffers.replace_facets(device, &facets);
            }
        }
        if !now.emits_as(before) {
            self.buffers.replace_materials(device, encoder, &self.arrangement.materials(pose));
        }
        let analytic = self.arrangement.place_lights(pose);
        self.buffers.replace_lights(device, encoder, &self.arrangement.lights.table);
        self.snapshot = Arc::new(Snapshot::new(device, self.id, now, &self.arrangement.placements(pose), &analytic));
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
        self.buffers.memory()
    }

    /// The scene as paths see it now.
    pub(crate) fn snapshot(&self) -> &Arc<Snapshot> {
        &self.snapshot
    }

    /// Where in the world coordinates on the GPU count from.
    pub(crate) fn centre(&self) -> [f64; 3] {
        self.arrangement.centre.to_array()
    }

    /// How rays find their triangles in shaders for these traits, the scene's or more.
    pub(crate) fn traversal(&self, traits: &Traits) -> Traversal {
        match self.arrangement.facet_count() {
            Some(count) if traits.few_triangles => Traversal::Every { triangles: count as u32 },
            _ => Traversal::Tree { stack: self.stack },
        }
    }

    /// Makes rays go down the trees whatever there is to test.
    #[cfg(test)]
    pub(crate) fn use_trees(&mut self) {
        self.arrangement.few = None;
        self.traits.few_triangles = false;
    }

    /// What stands behind a binding of shaders/shared/scene.wgsl or blinn_phong.wgsl.
    pub(crate) fn resource(&self, binding: &str) -> Option<BindingResource<'_>> {
        match binding {
            "analytic_lights" => Some(self.snapshot.analytic_lights.as_entire_binding()),
            _ => self.buffers.resource(binding),
        }
    }
}
