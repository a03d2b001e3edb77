//! The plan of the last frame: its passes, and the reason for each feature that was included or left out.

use asvgf::plan::Plan;
use eframe::egui::{RichText, Ui};

/// Shows the passes in order, the included features, and those left out.
pub fn show(ui: &mut Ui, plan: &Plan) {
    let passes: Vec<&str> = plan.steps.iter().map(|step| step.pass.name()).collect();
    ui.label(format!("passes: {}", passes.join(", ")));
    for (heading, included) in [("in", true), ("left out", false)] {
        ui.label(RichText::new(heading).strong());
        for decision in plan.decisions.iter().filter(|d| d.included == included) {
            ui.label(format!("{:?}: {}", decision.feature, decision.reason));
        }
    }
}
