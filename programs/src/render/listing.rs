//! Lists that `render` prints of scenes.

use crate::render::options::{Options, Source};
use asvgf::scene::{Alpha, Interior, Loaded, Material, Mesh, Scene, Texture, builtin};
use asvgf_fallbacks::shipped;
use std::fmt::Write as _;

/// Lists the built-in scenes, and the contents of the given scene.
pub fn list(options: &Options, loaded: &Loaded) -> String {
    let scene = &loaded.scene;
    let mut out = String::from("Built-in scenes\n");
    for name in builtin::NAMES {
        let _ = writeln!(out, "  {name:<8} with the animations {}", builtin::animations(name).join(", "));
    }
    let _ = writeln!(out, "Files that come along: {}", shipped::NAMES.join(", "));
    let name = match &options.source {
        Source::BuiltIn(name) | Source::Shipped(name) => name.clone(),
        Source::File(path) => path.display().to_string(),
    };
    let _ = writeln!(out, "\n{name}");
    let image = |e: &asvgf::scene::Environment| format!("{}×{} texels", e.width, e.height);
    let facts = [
        ("triangles", scene.triangle_count().to_string()),
        ("meshes", scene.meshes.len().to_string()),
        ("materials", scene.materials.len().to_string()),
        ("images", scene.images.len().to_string()),
        ("lights", scene.nodes.iter().filter(|n| n.light.is_some()).count().to_string()),
        ("cameras", scene.nodes.iter().filter(|n| n.camera.is_some()).count().to_string()),
        ("environment", scene.environment.as_ref().map_or("none".into(), image)),
    ];
    for (what, value) in facts {
        let _ = writeln!(out, "  {what:<13}{value}");
    }
    for (i, animation) in scene.animations.iter().enumerate() {
        let _ = writeln!(out, "  animation {i}  \"{}\", {:.2} s", animation.name, scene.duration(Some(i)));
    }
    for (i, material) in scene.materials.iter().enumerate() {
        let _ = writeln!(out, "  material {i}  \"{}\": {}", material.name, surface(material, scene));
    }
    for (i, mesh) in scene.meshes.iter().enumerate() {
        let _ = writeln!(out, "  mesh {i}  \"{}\": {}", mesh.name, vertices(mesh));
    }
    if !loaded.details.is_empty() {
        let _ = writeln!(out, "not read, or replaced");
    }
    for warning in &loaded.details {
        let _ = writeln!(out, "  {}: {}", warning.element, warning.reason);
    }
    out
}

/// Describes a material in one line: its differences from a grey Lambertian surface.
fn surface(material: &Material, scene: &Scene) -> String {
    let texture = |texture: Option<Texture>| match texture.and_then(|texture| scene.images.get(texture.image)) {
        Some(image) => format!(" × \"{}\" ({}×{})", image.name, image.width, image.height),
        None => String::new(),
    };
    let [r, g, b, a] = material.base_color;
    let mut parts = vec![format!("colour {r:.3} {g:.3} {b:.3}{}", texture(material.base_color_texture))];
    if material.metallic > 0.0 || material.specular != [0.0; 3] {
        let maps = texture(material.metallic_roughness_texture);
        parts.push(format!("metallic {:.2}, roughness {:.2}{maps}", material.metallic, material.roughness));
        let [r, g, b] = material.specular;
        let maps = texture(material.specular_texture) + &texture(material.specular_color_texture);
        parts.push(format!("reflectance {r:.3} {g:.3} {b:.3}{maps}"));
    }
    if material.normal_texture.is_some() {
        let map = texture(material.normal_texture);
        parts.push(format!("normal map{map}, scale {:.2}", material.normal_scale));
    }
    if material.transmission > 0.0 {
        let map = texture(material.transmission_texture);
        let Interior { index, absorption } = material.interior;
        let form = match absorption {
            None => "as a pane".to_owned(),
            Some([r, g, b]) => format!("as a body that absorbs {r:.3} {g:.3} {b:.3} per unit of length"),
        };
        parts.push(format!("transmits {:.2}{map}, index {index:.2}, {form}", material.transmission));
    }
    let coat = &material.clearcoat;
    if coat.weight > 0.0 {
        let (weight, roughness) = (texture(coat.weight_texture), texture(coat.roughness_texture));
        let normals =
            coat.normal_texture.map_or(String::new(), |_| ", normal map".to_owned() + &texture(coat.normal_texture));
        parts.push(format!(
            "clear coat {:.2}{weight}, roughness {:.2}{roughness}{normals}",
            coat.weight, coat.roughness
        ));
    }
    if material.emissive != [0.0; 3] {
        let [r, g, b] = material.emissive;
        parts.push(format!("emits {r:.3} {g:.3} {b:.3}{}", texture(material.emissive_texture)));
    }
    match material.alpha {
        Alpha::Mask(cutoff) => parts.push(format!("opacity {a:.2}, holes below {cutoff:.2}")),
        Alpha::Blend => parts.push(format!("opacity {a:.2}")),
        _ => {}
    }
    let flags =
        [(material.unlit, "unlit"), (material.double_sided, "double-sided"), (material.culled, "without back faces")];
    parts.extend(flags.into_iter().filter(|(holds, _)| *holds).map(|(_, name)| name.to_owned()));
    parts.join("; ")
}

/// Describes a mesh in one line.
fn vertices(mesh: &Mesh) -> String {
    let arrays = [
        ("normals", mesh.normals.is_empty()),
        ("tangents", mesh.tangents.is_empty()),
        ("TEXCOORD_0", mesh.uvs[0].is_empty()),
        ("TEXCOORD_1", mesh.uvs[1].is_empty()),
        ("colours", mesh.colors.is_empty()),
    ];
    let arrays: Vec<&str> = arrays.into_iter().filter(|(_, absent)| !absent).map(|(name, _)| name).collect();
    let with = if arrays.is_empty() { String::new() } else { format!(" with {}", arrays.join(", ")) };
    let (triangles, vertices, material) = (mesh.triangles.len(), mesh.positions.len(), mesh.material);
    format!("{triangles} triangles, {vertices} vertices{with}, material {material}")
}
