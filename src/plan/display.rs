//! A plan for people: a table, and a graph.

use super::{Grid, Plan, Slot};
use std::collections::BTreeMap;
use std::fmt::{self, Write as _};

/// The size of the picture that memory is quoted for.
const FULL_HD: [u32; 2] = [1920, 1080];

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bytes = self.bytes(FULL_HD, false) as f64 / f64::from(FULL_HD[0] * FULL_HD[1]);
        writeln!(f, "{} dispatches, {bytes:.1} bytes per pixel at 1920×1080", self.steps.len())?;
        writeln!(f, "\nPasses: what each reads → writes, and what is compiled into it")?;
        for (number, step) in self.steps.iter().enumerate() {
            let list = |out| {
                let images = step.bindings.iter().filter(|bound| bound.written == out);
                images.map(|bound| slot_name(bound.slot)).collect::<Vec<_>>().join(", ")
            };
            let per = if step.grid() == Grid::Strata { "3×3 pixels" } else { "pixel" };
            writeln!(f, "{:>3} {:<22}per {per:<12}{} → {}", number + 1, step.pass.name(), list(false), list(true))?;
            if step.features.iter().next().is_some() {
                let features: Vec<_> = step.features.iter().map(|feature| format!("{feature:?}")).collect();
                writeln!(f, "    {:<38}{}", "", features.join(" "))?;
            }
        }
        for (title, included) in [("In, and why", true), ("Left out, and why", false)] {
            writeln!(f, "\n{title}")?;
            for decision in self.decisions.iter().filter(|d| d.included == included) {
                writeln!(f, "    {decision}")?;
            }
        }
        Ok(())
    }
}

impl Plan {
    /// The plan as a Mermaid flow chart: passes blue, images yellow; iterations are one node.
    pub fn graph(&self) -> String {
        let mut passes: Vec<(&str, usize)> = Vec::new();
        let mut images = BTreeMap::new();
        let mut edges: Vec<String> = Vec::new();
        for step in &self.steps {
            let pass = step.pass.name();
            match passes.iter_mut().find(|(name, _)| *name == pass) {
                Some((_, count)) => *count += 1,
                None => passes.push((pass, 1)),
            }
            for bound in &step.bindings {
                let label = slot_name(bound.slot);
                let id = format!("i_{}", label.replace(' ', "_"));
                let edge = if bound.written { format!("{pass} --> {id}") } else { format!("{id} --> {pass}") };
                images.insert(id, label);
                if !edges.contains(&edge) {
                    edges.push(edge);
                }
            }
        }
        let mut out = String::from("flowchart TD\n");
        let _ = writeln!(out, "    classDef pass fill:#cfe2ff,stroke:#2b6cb0,color:#000");
        let _ = writeln!(out, "    classDef image fill:#fff3bf,stroke:#b7791f,color:#000");
        for (pass, count) in passes {
            let times = if count > 1 { format!(" ×{count}") } else { String::new() };
            let _ = writeln!(out, "    {pass}[\"{pass}{times}\"]:::pass");
        }
        for (id, label) in images {
            let _ = writeln!(out, "    {id}([\"{label}\"]):::image");
        }
        for edge in edges {
            let _ = writeln!(out, "    {edge}");
        }
        out
    }
}

/// The name of an image: `last` is the previous frame's.
fn slot_name(slot: Slot) -> String {
    match slot {
        Slot::Now(image) => image.name(),
        Slot::Before(image) => format!("last {}", image.name()),
        Slot::Target => "target".into(),
        Slot::Host(view) => format!("host's {}", view.name()),
    }
}
