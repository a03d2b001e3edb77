//! Reduction of a suite to a budget. Repeats are dropped first, within each run; then the size is reduced, here; then
//! methods are dropped, from the end of the list.

use crate::gpu::Gpu;
use crate::report::command::Command;
use crate::report::identity;
use crate::report::methods::Group;
use crate::report::pace::{self, Load, Pace};
use crate::report::record::Run;
use crate::report::script::Script;
use crate::report::suite::Suite;
use std::collections::{BTreeSet, HashSet};
use std::error::Error;
use std::path::Path;

/// Smallest size: a smaller image shows hardly anything.
const SMALLEST: [u32; 2] = [64, 36];

/// Safety factor on estimates, because scenes differ.
const MARGIN: f64 = 1.25;

/// Returns the first of a size, its half, its quarter, … at which a load is done in time, given the pace at the full
/// size.
pub fn size(full: [u32; 2], seconds: f64, pace: &Pace, mut load: impl FnMut([u32; 2]) -> Load) -> [u32; 2] {
    let mut size = full;
    loop {
        let smaller = size.map(|side| side / 2);
        let part = f64::from(size[0] * size[1]) / f64::from(full[0] * full[1]);
        let fits = MARGIN * pace.seconds(&load(size), part) <= seconds;
        if fits || smaller[0] < SMALLEST[0] || smaller[1] < SMALLEST[1] {
            return size;
        }
        size = smaller;
    }
}

/// Makes a suite smaller if the budget does not hold all its methods once; returns the reduction in words.
pub fn fit(command: &mut Command, gpu: &Gpu) -> Result<Option<String>, Box<dyn Error>> {
    let (full, Some(minutes)) = (command.suite.size, command.budget) else { return Ok(None) };
    let runs = command.out.join("runs");
    let all = load(&command.suite, gpu, &runs)?;
    if all == Load::default() {
        return Ok(None);
    }
    let pace = pace::measure(gpu, &command.suite)?;
    let mut failure = None;
    let chosen = size(full, 60.0 * minutes, &pace, |size| {
        command.suite.size = size;
        load(&command.suite, gpu, &runs).unwrap_or_else(|error| {
            failure = Some(error);
            Load::default()
        })
    });
    command.suite.size = chosen;
    let would = pace.seconds(&all, 1.0) / 60.0;
    let [[width, height], [less_width, less_height]] = [full, chosen];
    let dropped = format!(
        "size: {less_width}×{less_height}, because one run of everything at {width}×{height} would take about \
         {would:.0} minutes"
    );
    failure.map_or(Ok((chosen != full).then_some(dropped)), Err)
}

/// Returns the work that no earlier report has kept.
fn load(suite: &Suite, gpu: &Gpu, runs: &Path) -> Result<Load, Box<dyn Error>> {
    let mut load = Load::default();
    for sequence in &suite.sequences {
        let script = Script::load(suite, sequence)?;
        let frames = suite.first()..suite.first() + suite.frames;
        let references: HashSet<_> =
            frames.map(|index| script.frame(index)).map(|(p, c)| script.reference(&p, &c)).collect();
        let missing = references.iter().filter(|path| !path.exists()).count();
        load.paths += missing as u64 * u64::from(suite.paths);
        for method in &suite.methods {
            let key = identity::key(script.hash, suite, method, gpu)?;
            if Run::load(&identity::path(runs, &sequence.name, method), &key).is_some() {
                continue;
            }
            let frames = u64::from(suite.frames);
            load.runs += 1;
            load.scored += frames;
            match method.group {
                Group::Tracing(paths) => load.paths += frames * u64::from(paths),
                _ => load.filtered += frames,
            }
        }
    }
    Ok(load)
}

/// Describes the dropped parts of a sequence, given the number of repeats of each method, `None` if it was not run at
/// all.
pub fn shortfall(sequence: &str, runs: &[(&str, Option<u32>)], repeats: u32) -> Option<String> {
    let short = |count: Option<u32>| count.is_none_or(|count| count < repeats);
    let counts: BTreeSet<_> = runs.iter().map(|(_, count)| *count).filter(|&count| short(count)).collect();
    let part = |count: Option<u32>| {
        let names: Vec<_> = runs.iter().filter(|run| run.1 == count).map(|run| run.0).collect();
        let names = if names.len() == runs.len() { "all methods".into() } else { names.join(", ") };
        count.map_or(format!("{names} as a whole"), |count| {
            format!("{} of {repeats} repeats of {names}", repeats - count)
        })
    };
    let parts: Vec<String> = counts.into_iter().map(part).collect();
    (!parts.is_empty()).then(|| format!("{sequence}: {}", parts.join("; ")))
}
