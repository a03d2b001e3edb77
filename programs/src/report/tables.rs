//! report.csv and report.json: one row for each sequence, method and frame; and the facts about the report.

use crate::gpu::Gpu;
use crate::report::command::Command;
use crate::report::record::{COLUMNS, Row};
use crate::times::Clock;

/// Cargo option of the printed command, so that it yields the same columns.
const FEATURES: &str = if cfg!(feature = "flip") { "--features flip " } else { "" };

/// Formats rows as CSV. A missing number is an empty field.
pub fn csv(rows: &[Row]) -> String {
    let names: Vec<&str> = COLUMNS.iter().map(|(name, _)| *name).collect();
    let mut out = format!("sequence,method,frame,{}\n", names.join(","));
    for row in rows {
        let numbers = COLUMNS.map(|(_, number)| number(row).map_or(String::new(), |number| number.to_string()));
        // Quotes are doubled, because a method may have any name.
        let [sequence, method] = [&row.sequence, &row.method].map(|name| format!("\"{}\"", name.replace('"', "\"\"")));
        out += &format!("{sequence},{method},{},{}\n", row.frame, numbers.join(","));
    }
    out
}

/// Formats rows as JSON. A missing number is null.
pub fn json(rows: &[Row]) -> serde_json::Result<String> {
    Ok(serde_json::to_string_pretty(rows)? + "\n")
}

/// Lists the settings, the machine and the command.
pub fn facts(command: &Command, gpu: &Gpu) -> Vec<String> {
    let suite = &command.suite;
    let ([width, height], adapter) = (suite.size, &gpu.adapter);
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    vec![
        format!(
            "Suite {}: {width}×{height}, frames {} to {}",
            suite.name,
            suite.first(),
            suite.first() + suite.frames - 1
        ),
        format!("References of {} paths per pixel, with random numbers of their own", suite.paths),
        format!("{} ({:?}), {} {}", adapter.name, adapter.backend, adapter.driver, adapter.driver_info),
        format!("Times from {}", Clock::of(gpu).name()),
        format!("`cargo run --release {FEATURES}--example report -- {}`", arguments.join(" ")),
        format!("Version {} of the crate", env!("CARGO_PKG_VERSION")),
    ]
}
