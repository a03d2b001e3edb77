//! The parts of the shaders that a scene needs.

use super::geometry::attributes::Layout;
use crate::plan::SceneContents;
use crate::scene::description::{Alpha, Material, Scene};

/// Collects the contents that materials and meshes in use require of the shaders.
pub(crate) fn contents(scene: &Scene, layout: Layout) -> SceneContents {
    let used = || {
        let placed: Vec<usize> = scene.nodes.iter().flat_map(|n| n.meshes.iter().copied()).collect();
        scene
            .meshes
            .iter()
            .enumerate()
            .filter(move |(i, _)| placed.contains(i))
            .map(|(_, m)| &scene.materials[m.material])
    };
    SceneContents {
        textures: used().any(|m| m.textures().next().is_some()),
        shading_normals: layout.normals,
        normal_maps: layout.tangents && used().any(|m| m.normal_maps().next().is_some()),
        vertex_colors: layout.color.is_some(),
        specular: used().any(Material::mirrors),
        transmission: used().any(Material::transmits),
        clearcoat: used().any(Material::is_coated),
        clear_glass: used().any(Material::is_clear),
        alpha_blend: used().any(Material::is_blended),
        alpha_mask: used().any(|m| matches!(m.alpha, Alpha::Mask(_)) || m.is_blended() || m.culled),
        emitters: used().any(Material::is_emitter),
        unlit: used().any(|m| m.unlit),
        ..Default::default()
    }
}
