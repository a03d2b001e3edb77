//! What the filter bears, as a table: `cargo run --release --example stability [-- --long]` prints it and writes
//! docs/stability.md. The test of the same name asserts the same bounds.

#[allow(dead_code, reason = "shared with the tests, which use the rest")]
#[path = "../../tests/common/mod.rs"]
mod common;

#[path = "../../tests/stability/cases/mod.rs"]
mod cases;

mod long;
mod table;

use std::process::ExitCode;

/// The groups, in the order of the table.
const GROUPS: [(&str, &[cases::Case]); 10] = [
    ("Range of radiance", cases::radiance::CASES),
    ("Missing, infinite and repeated samples", cases::samples::CASES),
    ("Outliers", cases::outliers::CASES),
    ("Stiff dynamics", cases::dynamics::CASES),
    ("Geometry", cases::geometry::CASES),
    ("Shapes of the image", cases::shapes::CASES),
    ("Events", cases::events::CASES),
    ("Hostile input", cases::hostile::CASES),
    ("Devices", cases::limits::CASES),
    ("Long runs", long::CASES),
];

const HELP: &str = "\
usage: stability [--long] [GROUP]

Measures how far the filter is from its bounds, prints a table and writes docs/stability.md. With --long, the long runs too (ten
minutes on two cores of a software adapter). With the beginning of a group's title, only that group, and no file.
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (options, names): (Vec<&str>, Vec<&str>) =
        arguments.iter().map(String::as_str).partition(|a| a.starts_with('-'));
    if options.iter().any(|option| *option != "--long") || names.len() > 1 {
        eprint!("{HELP}");
        return ExitCode::from(2);
    }
    let long = !options.is_empty();
    let mut table = table::Table::default();
    for (title, cases) in GROUPS {
        let chosen = names.first().is_none_or(|name| title.starts_with(name));
        if chosen && (title != "Long runs" || long) {
            table.group(title, cases);
        }
    }
    if names.is_empty() {
        table.write();
    }
    if table.broken == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
