//! Rows of the cases, as Markdown.

use crate::program::repository;
use crate::stability::cases::{Breaks, Case};
use std::fmt::Write as _;

/// File of the table.
const FILE: &str = "docs/stability.md";

/// Marks in the file, around the table.
const MARKS: [&str; 2] = ["<!-- table -->\n", "<!-- end of table -->"];

#[derive(Default)]
pub struct Table {
    text: String,
    cases: usize,
    inputs: u32,
    /// Number of broken bounds.
    pub broken: usize,
}

impl Table {
    /// Measures the cases of a group and prints each row as soon as it is known.
    pub fn group(&mut self, title: &str, cases: &[Case]) {
        let head = format!(
            "\n### {title}\n\n| case | varied over | measured | | bound, and why | margin | breaking point |\n|---|---|---|---|---|---|---|\n"
        );
        print!("{head}");
        self.text += &head;
        for case in cases {
            let found = (case.measure)();
            let breaks = match case.breaks {
                Breaks::Never(reason) => format!("none: {reason}"),
                Breaks::Known(reason) => reason.to_owned(),
                Breaks::Found(search) => search(),
            };
            self.cases += 1;
            self.inputs += found.inputs;
            self.broken += usize::from(found.value > case.bound);
            let row = format!(
                "| {} | {} | {} | {} ({}) | {}: {} | {} | {} |\n",
                case.name,
                case.varied,
                case.quantity,
                number(found.value),
                found.at,
                number(case.bound),
                case.origin,
                margin(found.value, case.bound),
                breaks
            );
            print!("{row}");
            self.text += &row;
        }
    }

    /// Puts the table into its file, between the marks.
    pub fn write(&self) -> Result<(), String> {
        let path = repository().join(FILE);
        let old = std::fs::read_to_string(&path).unwrap_or_else(|_| MARKS.concat());
        let (Some(start), Some(end)) = (old.find(MARKS[0]), old.find(MARKS[1])) else {
            return Err(format!("{FILE} has lost the marks between which the table stands"));
        };
        let mut new = old[..start + MARKS[0].len()].to_owned();
        let _ = write!(
            new,
            "{} cases of {} inputs, {} beyond their bound.\n{}\n",
            self.cases, self.inputs, self.broken, self.text
        );
        new += &old[end..];
        std::fs::write(&path, new).map_err(|e| format!("{FILE}: cannot be written: {e}"))?;
        println!("\nin {FILE}");
        Ok(())
    }
}

/// Formats a number with three digits.
fn number(x: f64) -> String {
    if x == 0.0 || (0.01..1e4).contains(&x.abs()) { format!("{x:.3}") } else { format!("{x:.1e}") }
}

/// Returns the factor by which the measurement could grow.
fn margin(value: f64, bound: f64) -> String {
    match () {
        () if value > bound => "**broken**".into(),
        () if value == 0.0 => "exact".into(),
        () => format!("{:.1}×", bound / value),
    }
}
