//! What ran in the last frame, and why each piece was in or left out.

use asvgf::plan::Plan;
use eframe::egui::{RichText, Ui};

/// Passes in order, then what is in, then what is not.
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
