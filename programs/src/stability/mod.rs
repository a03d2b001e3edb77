//! The program `stability`: measures the filter's distance from its bounds, prints a table and writes
//! docs/stability.md. The test of the same name asserts the same bounds.

pub mod cases;
// The library's own tests stay in its package, with the helpers that they share with these.
#[path = "../../../tests/gpu/common/mod.rs"]
pub mod common;
mod long;
mod table;

use crate::arguments::Usage;
use crate::program::say;
use std::error::Error;
use std::ffi::OsString;

/// Groups, in the order of the table.
const GROUPS: [(&str, &[cases::Case]); 14] = [
    ("Range of radiance", cases::radiance::CASES),
    ("Missing, infinite and repeated samples", cases::samples::CASES),
    ("Outliers", cases::outliers::CASES),
    ("Stiff dynamics", cases::dynamics::CASES),
    ("Geometry", cases::geometry::CASES),
    ("Skins and morph targets", cases::deformation::CASES),
    ("Glass", cases::glass::CASES),
    ("Specular light", cases::gloss::CASES),
    ("Mirrors", cases::mirrors::CASES),
    ("Shapes of the image", cases::shapes::CASES),
    ("Events", cases::events::CASES),
    ("Hostile input", cases::hostile::CASES),
    ("Devices", cases::limits::CASES),
    ("Long runs", long::CASES),
];

const HELP: &str = "\
Measures how far the filter is from its bounds, and prints and writes a table of it.

Usage: cargo run --release --example stability -- [--long] [GROUP]

The table goes to standard output and into docs/stability.md. With GROUP, the beginning of a
group's title, only that group is measured, and no file is written.

  --long                measure the long runs too: ten minutes on two cores of a software
                        adapter
  -h, --help            print this
";

/// Runs the program with the arguments after its name.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = arguments.into_iter().map(|a| a.to_string_lossy().into_owned()).collect();
    let (options, names): (Vec<&str>, Vec<&str>) =
        arguments.iter().map(String::as_str).partition(|a| a.starts_with('-'));
    if options.iter().any(|option| ["-h", "--help"].contains(option)) {
        say(HELP);
        return Ok(());
    }
    if let Some(option) = options.iter().find(|option| **option != "--long") {
        return Err(Usage(format!("invalid option '{option}'")).into());
    }
    if let [_, second, ..] = names.as_slice() {
        return Err(Usage(format!("{second}: a second GROUP; one is measured at a time")).into());
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
        table.write()?;
    }
    match table.broken {
        0 => Ok(()),
        broken => Err(format!("{broken} cases are beyond their bound").into()),
    }
}
