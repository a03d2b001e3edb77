//! What `render` prints of scenes and plans.

use crate::options::{Options, Source};
use asvgf::plan::{Features, Grid, Plan};
use asvgf::scene::{Scene, builtin};
use std::fmt::Write as _;

/// What the last frame ran.
pub fn plan(plan: &Plan, traits: &asvgf::plan::Traits) -> String {
    let list = |features: Features| features.iter().map(|f| format!("{f:?}")).collect::<Vec<_>>().join(" ");
    let mut out = String::from("\nThe scene has\n");
    // One `name: value` each, in the order of the documentation.
    for line in format!("{traits:#?}").lines().filter(|line| line.contains(':')) {
        let (name, value) = line.trim().trim_end_matches(',').split_once(": ").unwrap_or((line, ""));
        let _ = writeln!(out, "  {name:<18}{}", if value == "true" { "yes" } else { "no: left out" });
    }
    let _ = writeln!(out, "\nWith the settings, that makes\n  {}", list(plan.features));
    let _ = writeln!(out, "\nPasses, and what is compiled into each");
    for (i, step) in plan.steps.iter().enumerate() {
        let grid = if step.grid == Grid::Strata { "per 3×3 pixels" } else { "per pixel" };
        let _ = writeln!(out, "{:>3} {:<22}{grid:<16}{}", i + 1, step.pass.name(), list(step.features));
    }
    let _ = writeln!(out, "\nImages");
    for (image, before) in plan.images() {
        let grid = if image.grid() == Grid::Strata { "per 3×3 pixels" } else { "per pixel" };
        let kept = if before { "and the last frame's" } else { "" };
        let line = format!("    {:<22}{grid:<16}{:<14}{kept}", format!("{image:?}"), format!("{:?}", image.format()));
        let _ = writeln!(out, "{}", line.trim_end());
    }
    out
}

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
