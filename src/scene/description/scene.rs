//! The whole scene.

use super::{Animation, Environment, Image, Light, Material, Mesh, Node, Perspective, Skin, Target};

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
    /// Factors on the emission of materials and on the intensity of lights ([`Target::Emission`] and the three like it) where no channel
    /// of the animation changes them; 1 for all others. A strength has three equal ones. A lamp that an animation lights up has its
    /// greatest emission in its material and is darkened here, because the emission of a material decides how often a light is sampled.
    pub resting_factors: Vec<(Target, [f32; 3])>,
}

impl Scene {
    /// Removes the back faces of all materials that are not [`double_sided`](Material::double_sided), as rasterizers do. Models whose
    /// outlines are hulls turned inside out need this, and rooms that are seen from outside.
    ///
    /// The skin of a body of glass keeps its back faces, because light leaves the body through them.
    pub fn cull_back_faces(&mut self) {
        for material in &mut self.materials {
            material.culled = !material.double_sided && !material.is_skin();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::description::Interior;

    #[test]
    fn light_leaves_a_body_whose_back_faces_would_be_culled() {
        let glass = |absorption| Material { interior: Interior { index: 1.5, absorption }, ..Default::default() };
        let materials = vec![
            Material { transmission: 1.0, ..glass(Some([0.0; 3])) },
            Material { transmission: 1.0, ..glass(None) },
            glass(Some([0.0; 3])),
            Material { double_sided: true, ..Default::default() },
        ];
        let mut scene = Scene { materials, ..Default::default() };
        scene.cull_back_faces();
        let culled: Vec<bool> = scene.materials.iter().map(|material| material.culled).collect();
        assert_eq!(culled, [false, true, true, false]);
    }
}
