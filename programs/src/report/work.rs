//! Measurement under way: sequence by sequence, method by method, within the available time.

use crate::gpu::Gpu;
use crate::report::command::Command;
use crate::report::growth::Growth;
use crate::report::measure::{self, Output};
use crate::report::methods::{DEFAULT, Group, Method, ONE_PATH};
use crate::report::record::Run;
use crate::report::suite::{Sequence, Suite, TURN};
use crate::report::summary::Summary;
use crate::report::truth::{self, Rgb, Truth};
use crate::report::words::Chapter;
use crate::report::{baseline, budget, crops, identity, plots, verdict, words_growth};
use indicatif::{ProgressBar, ProgressStyle};
use std::error::Error;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// Method with a constant α in the pictures.
const CONSTANT: &str = "svgf 0.2";
/// Frame in the pictures, just after the turn.
const SHOWN: u32 = TURN + 1;

/// Measurements under way, and their budget.
pub struct Work<'a> {
    command: &'a Command,
    gpu: &'a Gpu,
    bar: ProgressBar,
    deadline: Option<Instant>,
    /// Runs that remain.
    left: usize,
    /// Parts that the budget did not allow.
    dropped: Vec<String>,
}

impl<'a> Work<'a> {
    /// Begins; the budget counts from `start`.
    pub fn new(command: &'a Command, gpu: &'a Gpu, start: Instant, dropped: Vec<String>) -> Self {
        let suite = &command.suite;
        let deadline = command.budget.map(|minutes| start + Duration::from_secs_f64(60.0 * minutes));
        let left = suite.sequences.len() * suite.methods.len();
        Self { command, gpu, bar: progress(suite), deadline, left, dropped }
    }

    /// Returns the parts that the budget did not allow.
    pub fn finish(self) -> Vec<String> {
        self.bar.finish_and_clear();
        self.dropped
    }

    /// Measures a sequence, and draws it; `None` if no time is left for any of it.
    pub fn chapter(&mut self, sequence: &Sequence) -> Result<Option<Chapter>, Box<dyn Error>> {
        let Command { suite, out, baselines, .. } = self.command;
        let name = sequence.name.clone();
        let runs = out.join("runs");
        let folder = runs.join(&name);
        fs::create_dir_all(&folder)?;
        // Kept results take no time.
        if self.time() == Some(Duration::ZERO) && fs::read_dir(&folder)?.next().is_none() {
            self.dropped.push(format!("{name} as a whole"));
            return Ok(None);
        }
        self.bar.set_message(format!("{name}: references"));
        let export = self.command.export.then(|| out.join("sequences").join(&name));
        if let Some(folder) = &export {
            fs::create_dir_all(folder)?;
        }
        let counting = |frames: u32| self.bar.inc(frames.into());
        // Each sequence gets its own device. With one device for all, lavapipe took 100 ms for a temporal pass of 4 ms
        // from the 120th method on, as if it compiled it in each frame: it keeps a limited number of compiled shaders
        // per device.
        let gpu = Gpu::new()?;
        let mut truth = Truth::find(&gpu, suite, sequence, export.as_deref(), counting)?;
        let (mut summaries, mut repeats) = (Vec::new(), Vec::new());
        for method in &suite.methods {
            self.bar.set_message(format!("{name}: {}", method.name));
            let run = self.run(&gpu, &name, method, &mut truth, &runs)?;
            repeats.push((method.name.as_str(), run.as_ref().map(|run| run.repeats)));
            summaries.extend(run.map(|run| Summary::of(&run, &method.name, method.group)));
            self.left -= 1;
            self.bar.inc(suite.frames.into());
        }
        self.dropped.extend(budget::shortfall(&name, &repeats, suite.repeats));
        let traced = verdict::find(&summaries, ONE_PATH).map_or(Vec::new(), |summary| summary.passes.clone());
        for baseline in baselines {
            if let Some(run) = baseline::run(baseline, &name, &truth.moments, suite.size, &traced)? {
                summaries.push(Summary::of(&run, &baseline.name, Group::Baseline));
            }
        }
        let plots = plots::draw(out, &name, &summaries)?;
        let picture = self.picture(&name, &truth, &folder)?;
        Ok(Some(Chapter { sequence: name, summaries, plots, picture }))
    }

    /// Measures the growth of costs, and draws it; returns it in words.
    pub fn growth(&self) -> Result<String, Box<dyn Error>> {
        let out = &self.command.out;
        let next = |what: &str| self.bar.set_message(format!("growth: {what}"));
        let growth = Growth::find(self.gpu, &out.join("runs/growth.json"), next)?;
        let plots = plots::draw_growth(out, &growth)?;
        Ok(words_growth::growth(&growth, &plots))
    }

    /// Returns the remaining time, if there is a budget.
    fn time(&self) -> Option<Duration> {
        self.deadline.map(|deadline| deadline.saturating_duration_since(Instant::now()))
    }

    /// Returns a kept run, or a new one; `None` if there is no time for it.
    fn run(
        &self,
        gpu: &Gpu,
        sequence: &str,
        method: &Method,
        truth: &mut Truth,
        runs: &Path,
    ) -> Result<Option<Run>, Box<dyn Error>> {
        let Command { suite, .. } = self.command;
        let key = identity::key(truth.hash, suite, method, gpu)?;
        let path = identity::path(runs, sequence, method);
        // Without a budget, runs that an earlier budget cut short are measured again.
        let complete = |run: &Run| self.deadline.is_some() || run.repeats >= suite.repeats;
        if let Some(run) = Run::load(&path, &key).filter(complete) {
            return Ok(Some(run));
        }
        // Each remaining run gets its part of the remaining time, and repeats within that.
        let time = self.time();
        if time == Some(Duration::ZERO) {
            return Ok(None);
        }
        let share = time.map(|time| time / self.left as u32);
        let Output { run, images } = measure::run(gpu, suite, truth, (sequence, method), key, share)?;
        if let Some(shown) = truth.moments.iter().position(|moment| moment.index == SHOWN) {
            let [width, height] = suite.size;
            asvgf::image_io::write_exr_rgb(path.with_extension("exr"), width, height, &images[shown])?;
        }
        run.save(&path)?;
        Ok(Some(run))
    }

    /// Writes one path per pixel, a constant and an adaptive α, and the truth, side by side.
    fn picture(&self, sequence: &str, truth: &Truth, folder: &Path) -> Result<Option<String>, Box<dyn Error>> {
        let size = self.command.suite.size;
        let Some(moment) = truth.moments.iter().find(|moment| moment.index == SHOWN) else { return Ok(None) };
        let mut tiles: Vec<(String, Vec<Rgb>)> = Vec::new();
        for method in [ONE_PATH, CONSTANT, DEFAULT] {
            // A budget may have dropped the method.
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

/// Returns a bar of frames, references included. It stays hidden without a terminal.
fn progress(suite: &Suite) -> ProgressBar {
    let runs = suite.sequences.len() * (suite.methods.len() + 1);
    let style = ProgressStyle::with_template("{bar:32} {percent:>3} %  {msg}  {elapsed} gone, {eta} to go");
    let bar = ProgressBar::new(runs as u64 * u64::from(suite.frames));
    bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
