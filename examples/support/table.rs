//! What is printed: times, the plan, and what there is to render.

use crate::film::{Clock, PassTimes};
use crate::gpu::Gpu;
use crate::options::{Options, Source};
use asvgf::plan::{Features, Grid, Plan};
use asvgf::scene::{Scene, builtin};
use std::fmt::Write as _;

/// Frames that are not counted: shaders are compiled and caches filled during the first ones.
const WARM_UP: usize = 3;

/// Milliseconds per pass, medians over the frames; and the speed that goes with the `rays` of one frame.
pub fn times(frames: &[PassTimes], rays: f64, options: &Options, gpu: &Gpu) -> String {
    let skipped = WARM_UP.min(frames.len().saturating_sub(1));
    let counted = &frames[skipped..];
    let Some(first) = counted.first() else { return String::new() };
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in first {
        if !names.contains(name) {
            names.push(name);
        }
    }
    let sum = |frame: &PassTimes, wanted: &[&str]| {
        frame.iter().filter(|(name, _)| wanted.contains(name)).map(|(_, ms)| ms).sum::<f64>()
    };
    let typical = |wanted: &[&str]| median(counted.iter().map(|frame| sum(frame, wanted)).collect());
    let total = typical(&names);
    let mut out = format!("\n{:<24}{:>10}{:>9}\n", "pass", "ms", "share");
    for name in &names {
        let dispatches = first.iter().filter(|(other, _)| other == name).count();
        let label = if dispatches > 1 { format!("{name} × {dispatches}") } else { (*name).to_owned() };
        let ms = typical(&[name]);
        let _ = writeln!(out, "{label:<24}{ms:>10.3}{:>7.1} %", 100.0 * ms / total.max(1e-9));
    }
    let _ = writeln!(out, "{:<24}{total:>10.3}", "all");
    let clock = match Clock::of(gpu) {
        Clock::Timestamps => "GPU timestamps at the passes' boundaries",
        Clock::Waiting => "each pass submitted and waited for by itself, as this adapter has no honest timestamps",
    };
    let [width, height] = options.size;
    let _ = writeln!(out, "Medians of {} frames of {width}×{height} after {skipped} to warm up.", counted.len());
    let _ = writeln!(out, "Measured by {clock}.");
    let traced = typical(&["visibility", "trace"]) * 1e-3;
    if traced > 0.0 {
        let (million, speed) = (rays * 1e-6, rays * 1e-6 / traced);
        let _ = writeln!(
            out,
            "{speed:.2} million rays/s in visibility and trace: the last frame's {million:.2} million were counted, shadow rays \
             included."
        );
    }
    let adapter = &gpu.adapter;
    let _ = writeln!(out, "{} ({:?}), {} {}", adapter.name, adapter.backend, adapter.driver, adapter.driver_info);
    out
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => 0.0,
        n if n % 2 == 1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    }
}

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
