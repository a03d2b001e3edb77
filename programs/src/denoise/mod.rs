//! The program `denoise`: denoises a sequence of EXR files.

mod antialias;
mod blend_in_time;
pub mod clean_albedo;
mod fixed_seed;
mod grid;
mod inverted_motion;
mod lobes;
pub mod look_ahead;
pub mod options;
pub mod output;
mod parallel;
mod replay;
mod summary;
mod upload;

use crate::film::Film;
use crate::gpu::Gpu;
use crate::program::say;
use crate::sequence::Sequence;
use crate::sequence::layers::Layer;
use crate::times;
use asvgf::{FilterSettings, Gradient, Settings};
use indicatif::{ProgressBar, ProgressStyle};
use look_ahead::Ahead;
use options::{Options, Request};
use output::Files;
use std::collections::HashSet;
use std::error::Error;
use std::ffi::OsString;
use std::path::PathBuf;

/// Runs the program with the arguments after its name.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> Result<(), Box<dyn Error>> {
    match options::parse(arguments)? {
        Request::Help => say(options::HELP),
        Request::Denoise(options) => denoise(&options)?,
    }
    Ok(())
}

fn denoise(options: &Options) -> Result<(), Box<dyn Error>> {
    let bar = progress("checking frames");
    let mut sequence = Sequence::open(options.source.clone(), |frames| {
        bar.set_length(frames.into());
        bar.inc(1);
    })?;
    sequence.in_place |= options.in_place;
    bar.finish_and_clear();
    refuse_to_overwrite(options, &sequence)?;
    let settings = settings(options, &sequence);
    let ahead = (!options.causal).then(|| Ahead {
        settings: look_ahead::settings(&settings),
        smooth_edges: options.smooth_edges.unwrap_or(sequence.area.is_some()),
    });
    eprint!("{}", summary::before(&sequence, &settings, ahead.as_ref()));

    let gpu = Gpu::new()?;
    let mut film = Film::new(&gpu, sequence.size, settings)?;
    std::fs::create_dir_all(&options.out).map_err(|e| format!("--out {}: {e}", options.out.display()))?;
    let bar = progress("denoising");
    bar.set_length(sequence.frames() as u64);
    let mut files = Files { options, sequence: &sequence, after: &|| bar.inc(1) };
    let denoised = look_ahead::denoise(&mut film, ahead.as_ref(), &sequence, &mut files)?;
    bar.finish_and_clear();
    eprint!("{}", summary::after(&denoised));
    say(&times::table(&denoised.times, None, sequence.size, &gpu));
    say(&format!("{} frames in {}\n", denoised.times.len(), options.out.display()));
    Ok(())
}

/// Refuses outputs that would overwrite the frames themselves.
fn refuse_to_overwrite(options: &Options, sequence: &Sequence) -> Result<(), String> {
    let frames: HashSet<PathBuf> = sequence.files.iter().filter_map(|file| file.path.canonicalize().ok()).collect();
    let outputs = (0..sequence.frames()).flat_map(|index| output::paths(options, sequence, index));
    let written = outputs.into_iter().find(|path| path.canonicalize().is_ok_and(|path| frames.contains(&path)));
    match written {
        Some(path) => Err(format!("--out: would overwrite the frame {}: give another folder", path.display())),
        None => Ok(()),
    }
}

/// Returns the settings; the layers of the files decide how α adapts.
fn settings(options: &Options, sequence: &Sequence) -> Settings {
    let gradient = match options.constant {
        Some(_) => Gradient::Off,
        None if sequence.has(Layer::GradientCurrent) => Gradient::Pairs,
        None if sequence.has(Layer::Lambda) => Gradient::Lambda,
        None => Gradient::Statistics,
    };
    let mut filter = FilterSettings { gradient, ..options.preset.clone() };
    if !sequence.has_surfaces() {
        // Without depths, no surface is known to be a plane.
        (filter.sigma_depth, filter.sigma_foreshortening) = (1e6, 0.0);
    }
    let settings = Settings { filter, ..Settings::adaptive() };
    match options.constant {
        Some(alpha) => settings.constant(alpha),
        None => settings,
    }
}

/// Returns a bar of frames. It stays hidden without a terminal.
fn progress(what: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:32} {pos} of {len}  {msg}  {elapsed} gone, {eta} to go");
    let bar = ProgressBar::new(0).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar.with_message(what)
}
