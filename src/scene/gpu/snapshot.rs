//! A scene in one pose, as paths see it.

use super::light::analytic::AnalyticLight;
use super::memory::buffers::storage;
use super::memory::folded::Texel;
use super::visible::Visible;
use crate::passes::SceneBinding;
use std::sync::Arc;
use wgpu::{BindingResource, Buffer, Device};

/// The scene as a denoiser rendered it last. The denoiser compares it with the next frame's to find out what has moved. The scene
/// itself knows no last frame, because several denoisers may show it, each in its own time.
#[derive(Debug)]
pub(crate) struct Snapshot {
    /// The scene's number in this process.
    pub scene: u64,
    /// Positions of all that is seen, and the strength of all that emits.
    pub visible: Arc<Visible>,
    /// Placements of the instances: three rows of an affine matrix each.
    pub placements: Buffer,
    /// Corners of the triangles that change their shape, if there are any.
    pub corners: Option<Buffer>,
    /// The lights that the Blinn–Phong gradient evaluates.
    pub analytic_lights: Buffer,
}

impl Snapshot {
    /// Uploads the placements and lights of the scene with this number. [`Snapshot::upload_corners`] has uploaded the corners.
    pub fn new(
        device: &Device,
        scene: u64,
        visible: Arc<Visible>,
        placements: &[Texel],
        corners: Option<Buffer>,
        lights: &[AnalyticLight],
    ) -> Self {
        let placements = storage(device, "placements", placements, 3 * size_of::<Texel>());
        let analytic_lights = storage(device, "analytic lights", lights, size_of::<AnalyticLight>());
        Self { scene, visible, placements, corners, analytic_lights }
    }

    /// Uploads the corners of the triangles that change their shape.
    pub fn upload_corners(device: &Device, corners: &[[[f32; 3]; 3]]) -> Option<Buffer> {
        (!corners.is_empty()).then(|| storage(device, "corners", corners, size_of::<[[f32; 3]; 3]>()))
    }

    /// The resource behind a binding that reads the last frame's scene.
    pub fn resource(&self, binding: SceneBinding) -> Option<BindingResource<'_>> {
        match binding {
            SceneBinding::PlacementsBefore => Some(self.placements.as_entire_binding()),
            SceneBinding::CornersBefore => Some(self.corners.as_ref()?.as_entire_binding()),
            SceneBinding::AnalyticLightsBefore => Some(self.analytic_lights.as_entire_binding()),
            _ => None,
        }
    }
}
