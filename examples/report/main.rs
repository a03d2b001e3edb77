//! Measures error against run time: `cargo run --release --example report -- --help`.

mod baseline;
mod canvas;
mod command;
mod crops;
mod hash;
mod measure;
mod methods;
mod plots;
mod record;
mod score;
mod suite;
mod summary;
mod tables;
mod truth;
mod verdict;
mod words;

#[allow(dead_code, reason = "shared with the other examples")]
#[path = "../support/arguments.rs"]
mod arguments;
#[allow(dead_code, reason = "shared with the other examples")]
#[path = "../support/film.rs"]
mod film;
#[path = "../support/gpu.rs"]
mod gpu;
#[allow(dead_code, reason = "of `render`'s options only what says which scene is shown")]
#[path = "../support/options.rs"]
mod options;
#[path = "../support/stage.rs"]
mod stage;
#[allow(dead_code, reason = "shared with the other examples")]
#[path = "../support/times.rs"]
mod times;
#[path = "../support/tone.rs"]
mod tone;
#[path = "../support/tracing.rs"]
mod tracing;

use arguments::Usage;
use command::{Command, Request};
use gpu::Gpu;
use indicatif::{ProgressBar, ProgressStyle};
use measure::Output;
use methods::{DEFAULT, Group, Method, ONE_PATH};
use record::Run;
use std::error::Error;
use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};
use suite::{Sequence, TURN};
use summary::Summary;
use truth::{Rgb, Truth};
use words::{Chapter, Context};

/// The constant α that pictures show.
const CONSTANT: &str = "svgf 0.2";
/// The frame that pictures show, just after the turn.
const SHOWN: u32 = TURN + 1;

fn main() -> ExitCode {
    let result = match command::parse(std::env::args_os().skip(1)) {
        Ok(Request::Help) => {
            say(command::HELP);
            Ok(())
        }
        Ok(Request::Report(command)) => report(&command),
        Err(usage) => Err(usage.into()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if error.is::<Usage>() => {
            eprintln!("error: {error}\n(--help lists all options)");
            ExitCode::from(2)
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn report(command: &Command) -> Result<(), Box<dyn Error>> {
    let suite = &command.suite;
    fs::create_dir_all(command.out.join("runs")).map_err(|e| format!("--out {}: {e}", command.out.display()))?;
    let gpu = Gpu::new()?;
    let bar = progress(suite);
    let deadline = command.budget.map(|minutes| Instant::now() + Duration::from_secs_f64(60.0 * minutes));
    let mut work = Work { command, gpu: &gpu, bar: &bar, deadline, left: suite.sequences.len() * suite.methods.len() };
    let (mut chapters, mut rows, mut dropped) = (Vec::new(), Vec::new(), Vec::new());
    for sequence in &suite.sequences {
        let chapter = work.chapter(sequence, &mut dropped)?;
        rows.extend(chapter.summaries.iter().flat_map(|summary| summary.rows.clone()));
        chapters.push(chapter);
    }
    bar.finish_and_clear();
    write(command, "report.csv", &tables::csv(&rows))?;
    write(command, "report.json", &tables::json(&rows)?)?;
    let context = Context { facts: tables::facts(command, &gpu), dropped, paths: suite.paths };
    write(command, "report.md", &words::report(&context, &chapters))?;
    say(&format!("{}\n", command.out.join("report.md").display()));
    Ok(())
}

/// Measuring under way.
struct Work<'a> {
    command: &'a Command,
    gpu: &'a Gpu,
    bar: &'a ProgressBar,
    deadline: Option<Instant>,
    /// Runs that are still to do.
    left: usize,
}

impl Work<'_> {
    /// Measures a sequence, and draws it.
    fn chapter(&mut self, sequence: &Sequence, dropped: &mut Vec<String>) -> Result<Chapter, Box<dyn Error>> {
        let Command { suite, out, baselines, .. } = self.command;
        let name = sequence.name.clone();
        let folder = out.join("runs").join(&name);
        fs::create_dir_all(&folder)?;
        self.bar.set_message(format!("{name}: references"));
        let mut truth = Truth::find(self.gpu, suite, sequence, |frames| self.bar.inc(frames.into()))?;
        let mut summaries = Vec::new();
        for method in &suite.methods {
            self.bar.set_message(format!("{name}: {}", method.name));
            match self.run(&name, method, &mut truth, &folder)? {
                Some(run) => {
                    if run.repeats < suite.repeats {
                        let missing = suite.repeats - run.repeats;
                        dropped.push(format!("{name}, {}: {missing} of {} repeats", method.name, suite.repeats));
                    }
                    summaries.push(Summary::of(&run, &method.name, method.group));
                }
                None => dropped.push(format!("{name}, {}", method.name)),
            }
            self.left -= 1;
            self.bar.inc(suite.frames.into());
        }
        for baseline in baselines {
            if let Some(run) = baseline::run(baseline, &name, &truth.moments, suite.size)? {
                summaries.push(Summary::of(&run, &baseline.name, Group::Baseline));
            }
        }
        let plots = plots::draw(out, &name, &summaries)?;
        let picture = self.picture(&name, &truth, &folder)?;
        Ok(Chapter { sequence: name, summaries, plots, picture })
    }

    /// A run that was kept, or a new one; `None` where there is no time for it.
    fn run(
        &self,
        sequence: &str,
        method: &Method,
        truth: &mut Truth,
        folder: &Path,
    ) -> Result<Option<Run>, Box<dyn Error>> {
        let Command { suite, .. } = self.command;
        let key = truth.hash.and(&method.settings).and(&suite.frames).and(&self.gpu.adapter.name).to_string();
        let path = folder.join(format!("{}.json", method.name));
        // Without a budget, what an earlier one cut short is measured again.
        let complete = |run: &Run| self.deadline.is_some() || run.repeats >= suite.repeats;
        if let Some(run) = Run::load(&path, &key).filter(complete) {
            return Ok(Some(run));
        }
        // Each run that is left gets its part of the time that is left, and repeats within that.
        let time = self.deadline.map(|deadline| deadline.saturating_duration_since(Instant::now()));
        if time == Some(Duration::ZERO) {
            return Ok(None);
        }
        let share = time.map(|time| time / self.left as u32);
        let Output { run, images } = measure::run(self.gpu, suite, truth, (sequence, method), key, share)?;
        if let Some(shown) = truth.moments.iter().position(|moment| moment.index == SHOWN) {
            let [width, height] = suite.size;
            let path = folder.join(format!("{}.exr", method.name));
            asvgf::image_io::write_exr_rgb(path, width, height, &images[shown])?;
        }
        run.save(&path)?;
        Ok(Some(run))
    }

    /// One path per pixel, a constant and an adaptive α, and the truth, side by side.
    fn picture(&self, sequence: &str, truth: &Truth, folder: &Path) -> Result<Option<String>, Box<dyn Error>> {
        let size = self.command.suite.size;
        let Some(moment) = truth.moments.iter().find(|moment| moment.index == SHOWN) else { return Ok(None) };
        let mut tiles: Vec<(String, Vec<Rgb>)> = Vec::new();
        for method in [ONE_PATH, CONSTANT, DEFAULT] {
            // A budget may have left it out.
            if let Ok(colors) = truth::read_colors(&folder.join(format!("{method}.exr")), size) {
                tiles.push((method.into(), colors));
            }
        }
        tiles.push((format!("reference, {} spp", self.command.suite.paths), moment.reference.clone()));
        let name = format!("{sequence}-comparison.png");
        crops::write(&self.command.out.join(&name), size, &tiles)?;
        Ok(Some(name))
    }
}

/// A bar of frames, references included. It does not show where there is no terminal.
fn progress(suite: &suite::Suite) -> ProgressBar {
    let runs = suite.sequences.len() * (suite.methods.len() + 1);
    let style = ProgressStyle::with_template("{bar:32} {percent:>3} %  {msg}  {elapsed} gone, {eta} to go");
    let bar = ProgressBar::new(runs as u64 * u64::from(suite.frames));
    bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

fn write(command: &Command, name: &str, text: &str) -> Result<(), String> {
    let path = command.out.join(name);
    fs::write(&path, text).map_err(|e| format!("{}: cannot be written: {e}", path.display()))
}

/// Prints; whoever reads may have seen enough, as `head` does.
fn say(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}
