//! What `render` prints of scenes.

use crate::options::{Options, Source};
use asvgf::scene::{Scene, builtin};
use std::fmt::Write as _;

/// What can be rendered, and what is in the scene that was named.
pub fn list(options: &Options, scene: &Scene) -> String {
    let mut out = String::from("Built-in scenes\n");
    for name in builtin::NAMES {
        let _ = writeln!(out, "  {name}");
    }
    let _ = writeln!(out, "with the animations\n  {}", builtin::ANIMATIONS.join(", "));
    let name = match &options.source {
        Source::BuiltIn(name) => name.clone(),
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
    out
}
