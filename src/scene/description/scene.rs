//! The whole scene.

use super::{Animation, Environment, Image, Light, Material, Mesh, Node, Perspective, Skin};

/// Everything that the path tracer draws: geometry stored once per [`Mesh`], placed by [`Node`]s.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Triangle lists, each with one material.
    pub meshes: Vec<Mesh>,
    /// Surfaces that meshes refer to by index.
    pub materials: Vec<Material>,
    /// Images that materials refer to by index.
    pub images: Vec<Image>,
    /// The hierarchy that places meshes, lights and cameras. A parent comes before its children.
    pub nodes: Vec<Node>,
    /// Joints that nodes refer to by index.
    pub skins: Vec<Skin>,
    /// Lights without area.
    pub lights: Vec<Light>,
    /// Perspective cameras.
    pub cameras: Vec<Perspective>,
    /// Light from infinitely far away, which primary rays that hit nothing see too. `None` is black.
    pub environment: Option<Environment>,
    /// Motions. [`Scene::pose`] plays one of them.
    pub animations: Vec<Animation>,
}

impl Scene {
    /// Removes the back faces of all materials that are not [`double_sided`](Material::double_sided), as rasterizers do. Models whose
    /// outlines are hulls turned inside out need this, and rooms that are seen from outside.
    pub fn cull_back_faces(&mut self) {
        self.materials.iter_mut().for_each(|material| material.culled = !material.double_sided);
    }
}
