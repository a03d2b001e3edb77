//! The program `report`: measures error against run time.
//!
//! [`suite`] and [`methods`] say what to measure, as data, and [`budget`] fits it into the time. [`truth`],
//! [`measure`], [`score`] and [`growth`] measure it, [`verdict`] concludes, and [`words`], [`plots`] and [`crops`]
//! present it.

pub mod baseline;
pub mod budget;
pub mod canvas;
pub mod command;
pub mod crops;
pub mod fit;
pub mod growth;
pub mod hash;
pub mod identity;
pub mod keep;
pub mod measure;
pub mod methods;
pub mod pace;
pub mod plots;
pub mod record;
pub mod score;
pub mod script;
pub mod suite;
pub mod summary;
pub mod tables;
pub mod tessellation;
pub mod truth;
pub mod verdict;
pub mod words;
pub mod words_growth;
pub mod work;

use crate::gpu::Gpu;
use crate::program::say;
use command::{Command, Request};
use std::error::Error;
use std::ffi::OsString;
use std::fs;
use std::time::Instant;
use words::Context;
use work::Work;

/// Runs the program with the arguments after its name.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> Result<(), Box<dyn Error>> {
    match command::parse(arguments)? {
        Request::Help => say(command::HELP),
        Request::Report(command) => report(command)?,
    }
    Ok(())
}

fn report(mut command: Command) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    fs::create_dir_all(command.out.join("runs")).map_err(|e| format!("--out {}: {e}", command.out.display()))?;
    let gpu = Gpu::new()?;
    let dropped = budget::fit(&mut command, &gpu)?.into_iter().collect();
    let (command, suite) = (&command, &command.suite);
    let mut work = Work::new(command, &gpu, start, dropped);
    let chapters = suite.sequences.iter().filter_map(|sequence| work.chapter(sequence).transpose());
    let chapters = chapters.collect::<Result<Vec<_>, _>>()?;
    let growth = command.growth.then(|| work.growth()).transpose()?;
    let dropped = work.finish();
    let rows: Vec<_> = chapters.iter().flat_map(|chapter| &chapter.summaries).flat_map(|s| s.rows.clone()).collect();
    write(command, "report.csv", &tables::csv(&rows))?;
    write(command, "report.json", &tables::json(&rows)?)?;
    let context = Context { facts: tables::facts(command, &gpu), dropped };
    let text = words::report(&context, &chapters) + &growth.unwrap_or_default();
    write(command, "report.md", &text)?;
    say(&format!("{}\n", command.out.join("report.md").display()));
    Ok(())
}

fn write(command: &Command, name: &str, text: &str) -> Result<(), String> {
    let path = command.out.join(name);
    fs::write(&path, text).map_err(|e| format!("{}: cannot be written: {e}", path.display()))
}
