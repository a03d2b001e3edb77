//! The parts of a scene on the GPU that follow its pose, as plain data.

use super::geometry::deforming::{Deforming, Reshaped};
use super::geometry::facets::{self, Facet};
use super::geometry::instances::{self, Instance};
use super::header::Header;
use super::light::analytic::AnalyticLight;
use super::light::table::Lights;
use super::memory::folded::Texel;
use super::surface::materials::materials;
use super::surface::places::Place;
use super::visible::Visible;
use crate::scene::description::{Material, Pose, SceneError};
use glam::DVec3;

/// Everything that moves or dims, and the data that any pose needs.
#[derive(Debug)]
pub(crate) struct Arrangement {
    /// Origin of the coordinates on the GPU, in the world. It never changes, because the last frame's coordinates share it.
    pub centre: DVec3,
    /// True if there are two levels of trees.
    pub instanced: bool,
    /// The constants without the grid, which [`Arrangement::top_level`] adds.
    pub header: Header,
    pub instances: Vec<Instance>,
    /// Meshes whose shape follows the pose.
    pub deforming: Vec<Deforming>,
    /// Most levels of the top level that the traversal's stack has room for.
    pub deepest: u32,
    pub lights: Lights,
    pub materials: Vec<Material>,
    pub images: Vec<Place>,
    /// Corners of each row, if the scene has so few triangles that each is tested.
    pub few: Option<Vec<[[f32; 3]; 3]>>,
    /// Lengths of the lists of a pose, and of the weights of each node.
    pub lengths: Lengths,
}

/// The top level of the trees and the instances' records in a pose.
pub(crate) struct TopLevel {
    pub header: Header,
    /// Empty if there is only one level.
    pub texels: Vec<Texel>,
    pub depth: u32,
}

/// All triangles in world space.
pub(crate) struct Facets {
    pub facets: Vec<Facet>,
    /// Row of the lookup table and number of the instance.
    pub owners: Vec<[u32; 4]>,
}

/// Lengths of the lists of a pose, and of the weights of each node.
type Lengths = ([usize; 3], Vec<usize>);

/// Lengths of the lists of a pose.
pub(crate) fn lengths(pose: &Pose) -> Lengths {
    let lists = [pose.world.len(), pose.emission.len(), pose.intensity.len()];
    (lists, pose.weights.iter().map(Vec::len).collect())
}

impl Arrangement {
    /// Checks that a pose belongs to this scene and is finite.
    pub fn check(&self, pose: &Pose) -> Result<(), SceneError> {
        let wrong =
            |element: String, reason: &str| Err(SceneError { file: "pose".into(), element, reason: reason.into() });
        if lengths(pose) != self.lengths {
            return wrong("lengths".into(), "differ from the scene's: make it with `Scene::pose` of the same scene");
        }
        // Beyond the range of f32, a number is infinite in shaders.
        let finite = |x: &f64| x.abs() <= f64::from(f32::MAX);
        if let Some(i) = pose.world.iter().position(|m| !m.iter().flatten().all(finite)) {
            return wrong(format!("world[{i}]"), "is not finite");
        }
        if let Some(i) = pose.weights.iter().position(|weights| !weights.iter().all(|w| w.is_finite())) {
            return wrong(format!("weights[{i}]"), "is not finite");
        }
        if pose.emission.iter().chain(&pose.intensity).flatten().any(|f| !(f.is_finite() && *f >= 0.0)) {
            return wrong("emission or intensity".into(), "is negative or not finite");
        }
        Ok(())
    }

    /// The part of a pose that paths see: nodes with triangles or lights.
    pub fn visible(&self, pose: &Pose) -> Visible {
        let nodes = self.instances.iter().filter_map(|i| i.node).chain(self.lights.nodes());
        Visible::new(pose, nodes, self.deforming.iter().map(|deforming| &deforming.source))
    }

    /// Gives meshes the shapes of a pose. Returns those that changed.
    pub fn reshape(&mut self, pose: &Pose) -> Vec<Reshaped> {
        let mut changed = Vec::new();
        for deforming in &mut self.deforming {
            let Some(reshaped) = deforming.follow(pose) else { continue };
            let instance = &mut self.instances[deforming.instance];
            (instance.bounds, instance.grid) = (deforming.tree.bounds, deforming.tree.grid);
            self.lights.reshape(deforming.instance, deforming.emitters());
            if let Some(few) = &mut self.few {
                let rows = &mut few[deforming.first_row as usize..];
                rows.iter_mut().zip(&deforming.corners).for_each(|(row, c)| *row = c.map(|p| p.to_array()));
            }
            changed.push(reshaped);
        }
        changed
    }

    /// Corners of all triangles that change their shape.
    pub fn corners(&self) -> Vec<[[f32; 3]; 3]> {
        let corners = self.deforming.iter().flat_map(|deforming| &deforming.corners);
        corners.map(|triangle| triangle.map(|p| p.to_array())).collect()
    }

    pub fn top_level(&self, pose: &Pose) -> TopLevel {
        if !self.instanced {
            let header = self.header.with_grid(self.instances[0].grid);
            return TopLevel { header, texels: Vec::new(), depth: 0 };
        }
        let placed = instances::place(&self.instances, pose, self.centre, self.header.root(), self.deepest);
        TopLevel { header: self.header.with_grid(placed.grid), texels: placed.texels, depth: placed.depth }
    }

    /// Three rows of an affine matrix for each instance.
    pub fn placements(&self, pose: &Pose) -> Vec<Texel> {
        instances::rows_of(&self.instances, pose, self.centre)
    }

    pub fn materials(&self, pose: &Pose) -> Vec<Texel> {
        materials(&self.materials, &pose.emission, &self.images)
    }

    /// Places the lights in a pose. Returns those that the Blinn–Phong gradient evaluates.
    pub fn place_lights(&mut self, pose: &Pose) -> Vec<AnalyticLight> {
        let placement = |instance: usize| self.instances[instance].placement(pose, self.centre);
        self.lights.place(&self.materials, pose, self.centre, placement)
    }

    /// Number of facets for which the shaders are compiled, if each triangle is tested.
    pub fn facet_count(&self) -> Option<usize> {
        let rows = || self.instances.iter().map(|instance| instance.row_count as usize).sum();
        self.few.is_some().then(|| facets::padded(rows()))
    }

    /// The triangles of all instances in world space, if each is tested.
    pub fn facets(&self, pose: &Pose) -> Option<Facets> {
        let (corners, count) = (self.few.as_ref()?, self.facet_count()?);
        let (mut facets, mut owners) = (Vec::new(), Vec::new());
        for (number, instance) in self.instances.iter().enumerate() {
            let placement = instance.placement(pose, self.centre);
            for row in instance.first_row..instance.first_row + instance.row_count {
                facets.push(Facet::new(corners[row as usize], placement));
                owners.push([row, number as u32, 0, 0]);
            }
        }
        facets.resize(count, Facet::default());
        owners.resize(count, [0; 4]);
        Some(Facets { facets, owners })
    }
}
