//! What ran in the last frame, and what was left out of the shaders.

use crate::documentation;
use asvgf::plan::Plan;
use eframe::egui::{RichText, Ui};
use std::collections::BTreeSet;

/// Passes in order, then what is compiled in, then what is not.
pub fn show(ui: &mut Ui, plan: &Plan) {
    let passes: Vec<&str> = plan.steps.iter().map(|step| step.pass.name()).collect();
    ui.label(format!("passes: {}", passes.join(", ")));
    let present: BTreeSet<String> = plan.features.iter().map(|feature| format!("{feature:?}")).collect();
    let (within, without): (Vec<_>, Vec<_>) =
        documentation::features().into_iter().partition(|(name, _)| present.contains(*name));
    for (heading, list) in [("compiled in", within), ("left out", without)] {
        ui.label(RichText::new(heading).strong());
        for (name, meaning) in list {
            ui.label(format!("{name}: {meaning}"));
        }
    }
}
