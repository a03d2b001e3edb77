//! The whole scene.

use super::{Animation, Environment, Image, Light, Material, Mesh, Node, Perspective};

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
    /// Lights without area.
    pub lights: Vec<Light>,
    /// Perspective cameras.
    pub cameras: Vec<Perspective>,
    /// Light from infinitely far away; also what a primary ray sees that hits nothing. `None` is black.
    pub environment: Option<Environment>,
    /// Motions, one of which may be played with [`Scene::pose`].
    pub animations: Vec<Animation>,
}

impl Scene {
    /// Takes the back faces of all materials that are not [`double_sided`](Material::double_sided) away, as rasterizers do: for
    /// models whose outlines are hulls turned inside out, and for rooms that are looked into from outside.
    pub fn cull_back_faces(&mut self) {
        self.materials.iter_mut().for_each(|material| material.culled = !material.double_sided);
    }
}
