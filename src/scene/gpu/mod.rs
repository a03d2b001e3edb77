//! The GPU half: [`assembly`] lays a scene out as plain data, [`upload`] makes its buffers, and [`arrangement`] follows the pose.

mod arrangement;
mod assembly;
mod contents;
mod emission;
mod geometry;
mod header;
mod light;
mod memory;
mod snapshot;
mod surface;
mod tree;
mod upload;
mod visible;

#[cfg(test)]
pub(crate) use light::radiance::{pack, unpack};
pub(crate) use snapshot::Snapshot;
pub(crate) use visible::Visible;

use super::description::{Pose, Scene, SceneError};
use crate::passes::{SceneBinding, Traversal};
use crate::plan::SceneContents;
use arrangement::Arrangement;
use assembly::Assembly;
use memory::capacity::Capacity;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use upload::Buffers;
use wgpu::{BindingResource, CommandEncoder, Device, Queue};

/// A [`Scene`] on the GPU: its geometry and trees, and placements, materials and lights in the current pose.
///
/// Each mesh is stored once. Static meshes share one tree in world space. Meshes that move or repeat have trees of their own under a
/// second level, which is rebuilt when something moves. A mesh that changes its shape is stored once for each node that draws it, and
/// its tree is fitted to each shape. Coordinates are relative to a centre near the scene's middle, so that a scene
/// far from the origin looks as it does near the origin.
#[derive(Debug)]
pub struct GpuScene {
    id: u64,
    contents: SceneContents,
    stack: u32,
    triangles: usize,
    arrangement: Arrangement,
    buffers: Buffers,
    /// The current pose as paths see it.
    snapshot: Arc<Snapshot>,
}

impl GpuScene {
    /// Builds the trees and uploads the scene in its rest pose. [`GpuScene::update`] moves it.
    ///
    /// # Errors
    /// The error of [`Scene::validate`], or one that names the part of the scene that exceeds the device's textures or storage bindings.
    pub fn new(device: &Device, queue: &Queue, scene: &Scene) -> Result<Self, SceneError> {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        let assembly = Assembly::of(scene, &Capacity::of(device))?;
        let buffers = Buffers::new(device, queue, &assembly);
        let id = NEXT.fetch_add(1, Ordering::Relaxed);
        let Assembly { contents, stack, triangles, pose, arrangement, analytic_lights, .. } = assembly;
        let (visible, placements) = (Arc::new(arrangement.visible(&pose)), arrangement.placements(&pose));
        let corners = Snapshot::upload_corners(device, &arrangement.corners());
        let snapshot = Arc::new(Snapshot::new(device, id, visible, &placements, corners, &analytic_lights));
        Ok(Self { id, contents, stack, triangles, arrangement, buffers, snapshot })
    }

    /// Brings the scene into a pose. A frame in which nothing changes needs no call. Each denoiser compares the pose with the one
    /// that it rendered last, so calls may come in any order and several denoisers may show the scene. Changes are recorded in the
    /// encoder or go into new buffers, so that frames recorded but not yet submitted keep their pose.
    ///
    /// # Errors
    /// Names the element of the pose that does not belong to this scene or is not finite. Nothing has changed then.
    pub fn update(&mut self, device: &Device, encoder: &mut CommandEncoder, pose: &Pose) -> Result<(), SceneError> {
        self.arrangement.check(pose)?;
        let (before, now) = (&self.snapshot.visible, Arc::new(self.arrangement.visible(pose)));
        if now == *before {
            return Ok(());
        }
        let reshaped = if now.is_shaped_as(before) { Vec::new() } else { self.arrangement.reshape(pose) };
        reshaped.iter().for_each(|shape| self.buffers.replace_shape(device, encoder, shape));
        if self.arrangement.instanced && (!reshaped.is_empty() || !now.is_placed_as(before)) {
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
        let corners = match &reshaped[..] {
            [] => self.snapshot.corners.clone(),
            _ => Snapshot::upload_corners(device, &self.arrangement.corners()),
        };
        let placements = self.arrangement.placements(pose);
        self.snapshot = Arc::new(Snapshot::new(device, self.id, now, &placements, corners, &analytic));
        Ok(())
    }

    /// Number of triangles in the lookup table. Instances of a mesh share its triangles.
    pub fn triangles(&self) -> usize {
        self.triangles
    }

    /// Properties of the scene that decide what its passes contain.
    pub fn contents(&self) -> SceneContents {
        self.contents
    }

    /// Bytes of GPU memory that the scene takes.
    pub fn memory(&self) -> u64 {
        self.buffers.memory()
    }

    /// The current pose as paths see it.
    pub(crate) fn snapshot(&self) -> &Arc<Snapshot> {
        &self.snapshot
    }

    /// Origin of the coordinates on the GPU, in the world.
    pub(crate) fn centre(&self) -> [f64; 3] {
        self.arrangement.centre.to_array()
    }

    /// The search for triangles in shaders for these contents, which include the scene's.
    pub(crate) fn traversal(&self, contents: &SceneContents) -> Traversal {
        match self.arrangement.facet_count() {
            Some(count) if contents.few_triangles => Traversal::Every { triangles: count as u32 },
            _ => Traversal::Tree { stack: self.stack },
        }
    }

    /// Makes rays descend the trees however few triangles there are.
    #[cfg(test)]
    pub(crate) fn use_trees(&mut self) {
        self.arrangement.few = None;
        self.contents.few_triangles = false;
    }

    /// The resource behind a binding of shaders/shared/scene.wgsl or blinn_phong.wgsl.
    pub(crate) fn resource(&self, binding: SceneBinding) -> Option<BindingResource<'_>> {
        match binding {
            SceneBinding::AnalyticLights => Some(self.snapshot.analytic_lights.as_entire_binding()),
            _ => self.buffers.resource(binding),
        }
    }
}
