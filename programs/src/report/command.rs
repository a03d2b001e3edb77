//! The command line of `report`.

use crate::arguments::{Usage, Value};
use crate::report::suite::Suite;
use lexopt::ValueExt as _;
use std::ffi::OsString;
use std::path::PathBuf;

/// Text that `--help` prints.
pub const HELP: &str = "\
Measures error against run time, and writes tables, plots and pictures of it.

Usage: cargo run --release --example report -- [OPTIONS]

With `--features flip` (which needs a C++ compiler) the report has FLIP and its maps too.

  --suite NAME          quick: three sequences and a choice of methods, in minutes on a
                        software adapter; full: everything                      [quick]
  --scene SCENE         only this scene: cornell, pillars, gloss, textured, still-life,
                        or a .gltf, .glb or .obj file with its first animation
                                                                    [the suite's scenes]
  --animations NAMES    only these, separated by commas, as in static,blink
                                                             [the suite's animations]
  --methods NAMES       only these, separated by commas, as in 1 spp,a-svgf
                                                                     [the suite's methods]
  --size WxH            pixels                          [quick 96x54, full 640x360]
  --paths N             paths per pixel of the references      [quick 256, full 8192]
  --repeats N           timed runs after the first run, which has the errors; with 0, the
                        first run is timed, without its first frames  [quick 3, full 5]
  --budget MINUTES      approximate limit of the time: repeats are dropped first, then the
                        size is halved, then methods are dropped, and the report lists
                        the dropped parts                                        [none]
  --growth              also measure how time and memory grow with pixels and triangles
  --out DIR             folder for everything; made if missing           [target/report]
  --baseline NAME=DIR   also score another denoiser's frames. DIR/SEQUENCE/ holds
                        denoised_0022.exr, …, and may hold times.txt with the
                        milliseconds of each frame, one per line; the report adds
                        those of tracing it. May be repeated
  --sequences           also write the frames, as `denoise` reads them, and
                        their references: DIR/sequences/SEQUENCE/
  -h, --help            print this

Writes report.md, report.csv, report.json, plots (.svg and .png) and comparisons (.png).
Measurements are kept in DIR/runs, so that an interrupted report continues where it stopped;
references are kept in target/references.
Exit status: 0 done, 1 failed, 2 wrong usage.
";

/// Request of the command line.
pub enum Request {
    Help,
    Report(Command),
}

pub struct Command {
    pub suite: Suite,
    /// In minutes.
    pub budget: Option<f64>,
    pub out: PathBuf,
    pub baselines: Vec<Baseline>,
    /// True to write the frames too.
    pub export: bool,
    /// True to measure the growth of costs too.
    pub growth: bool,
}

/// Another denoiser's output.
pub struct Baseline {
    pub name: String,
    pub folder: PathBuf,
}

/// Options with a value.
const VALUED: [&str; 10] =
    ["suite", "scene", "animations", "methods", "size", "paths", "repeats", "budget", "out", "baseline"];

/// Reads the arguments after the program's name.
pub fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Request, Usage> {
    let mut suite = Suite::quick();
    let (mut scene, mut animations, mut methods) = (None, None, None);
    let (mut size, mut paths, mut repeats) = (None, None, None);
    let (mut export, mut growth) = (false, false);
    let (mut budget, mut out, mut baselines) = (None, PathBuf::from("target/report"), Vec::new());
    let mut parser = lexopt::Parser::from_args(arguments);
    while let Some(argument) = parser.next()? {
        let name = match argument {
            lexopt::Arg::Short('h') | lexopt::Arg::Long("help") => return Ok(Request::Help),
            lexopt::Arg::Long("sequences") => {
                export = true;
                continue;
            }
            lexopt::Arg::Long("growth") => {
                growth = true;
                continue;
            }
            lexopt::Arg::Long(name) if VALUED.contains(&name) => name.to_owned(),
            _ => return Err(argument.unexpected().into()),
        };
        if name == "out" {
            out = parser.value()?.into();
            continue;
        }
        let value = Value { text: parser.value()?.string()?, option: name };
        match value.option.as_str() {
            "suite" => suite = value.one_of(&[("quick", Suite::quick as fn() -> Suite), ("full", Suite::full)])?(),
            "scene" => scene = Some(value.text),
            "animations" => animations = Some(value),
            "methods" => methods = Some(value),
            "size" => size = Some(pixels(&value)?),
            "paths" => paths = Some(value.whole(1..=1_000_000)?),
            "repeats" => repeats = Some(value.whole(0..=1000)?),
            "budget" => budget = Some(value.number(0.1..=1e5)?.into()),
            _ => baselines.push(baseline(&value)?),
        }
    }
    if let Some(scene) = scene {
        suite.only(&scene);
    }
    if let Some(names) = animations {
        suite.sequences = chosen(&suite.sequences, &names, |sequence| sequence.animation.as_deref().unwrap_or(""))?;
    }
    if let Some(names) = methods {
        suite.methods = chosen(&suite.methods, &names, |method| &method.name)?;
    }
    suite.size = size.unwrap_or(suite.size);
    suite.paths = paths.unwrap_or(suite.paths);
    suite.repeats = repeats.unwrap_or(suite.repeats);
    Ok(Request::Report(Command { suite, budget, out, baselines, export, growth }))
}

/// Returns the named items, in their own order.
fn chosen<T: Clone>(all: &[T], names: &Value, name: impl Fn(&T) -> &str) -> Result<Vec<T>, Usage> {
    let wanted: Vec<_> = names.text.split(',').map(str::trim).collect();
    if wanted.iter().any(|wanted| !all.iter().any(|one| name(one) == *wanted)) {
        let mut known: Vec<_> = all.iter().map(&name).collect();
        known.dedup();
        return Err(names.wrong(format!("must be of {}", known.join(", "))));
    }
    Ok(all.iter().filter(|one| wanted.contains(&name(one))).cloned().collect())
}

fn pixels(value: &Value) -> Result<[u32; 2], Usage> {
    let sides = value.text.split_once(['x', '×']).map(|(width, height)| [width, height].map(|side| side.parse().ok()));
    match sides {
        // SSIM's window is 11 pixels wide; films larger than 4K do not fit.
        Some([Some(width @ 11..=4096), Some(height @ 11..=4096)]) => Ok([width, height]),
        _ => Err(value.wrong("must be WIDTHxHEIGHT, as in 96x54, 11 to 4096 each")),
    }
}

fn baseline(value: &Value) -> Result<Baseline, Usage> {
    match value.text.split_once('=') {
        Some((name, folder)) if !name.is_empty() => Ok(Baseline { name: name.into(), folder: folder.into() }),
        _ => Err(value.wrong("must be NAME=DIR")),
    }
}
