//! Denoises a sequence of EXR files: `cargo run --release --example denoise -- --help`.

#[path = "support/antialias.rs"]
mod antialias;
#[path = "support/arguments.rs"]
mod arguments;
#[path = "support/blend_in_time.rs"]
mod blend_in_time;
#[allow(dead_code, reason = "shared with `render`, which writes sequences")]
#[path = "support/camera.rs"]
mod camera;
#[path = "support/clean_albedo.rs"]
mod clean_albedo;
#[path = "support/denoise_options.rs"]
mod denoise_options;
#[path = "support/film.rs"]
mod film;
#[path = "support/fixed_seed.rs"]
mod fixed_seed;
#[path = "support/gpu.rs"]
mod gpu;
#[path = "support/grid.rs"]
mod grid;
#[path = "support/inverted_motion.rs"]
mod inverted_motion;
#[path = "support/look_ahead.rs"]
mod look_ahead;
#[path = "support/output.rs"]
mod output;
#[path = "support/parallel.rs"]
mod parallel;
#[path = "support/replay.rs"]
mod replay;
#[path = "support/sequence/mod.rs"]
mod sequence;
#[path = "support/summary.rs"]
mod summary;
#[path = "support/times.rs"]
mod times;
#[path = "support/tone.rs"]
mod tone;
#[path = "support/upload.rs"]
mod upload;

use arguments::Usage;
use asvgf::{FilterSettings, Gradient, Settings};
use denoise_options::{Options, Request};
use film::Film;
use gpu::Gpu;
use indicatif::{ProgressBar, ProgressStyle};
use look_ahead::Ahead;
use output::Files;
use sequence::Sequence;
use sequence::layers::Layer;
use std::collections::HashSet;
use std::error::Error;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

fn main() -> ExitCode {
    let result = match denoise_options::parse(std::env::args_os().skip(1)) {
        Ok(Request::Help) => {
            say(denoise_options::HELP);
            Ok(())
        }
        Ok(Request::Denoise(options)) => run(&options),
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

fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let bar = progress("looking at frames");
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

/// The frames themselves are never written over.
fn refuse_to_overwrite(options: &Options, sequence: &Sequence) -> Result<(), String> {
    let frames: HashSet<PathBuf> = sequence.files.iter().filter_map(|file| file.path.canonicalize().ok()).collect();
    let outputs = (0..sequence.frames()).flat_map(|index| output::paths(options, sequence, index));
    let written = outputs.into_iter().find(|path| path.canonicalize().is_ok_and(|path| frames.contains(&path)));
    match written {
        Some(path) => Err(format!("--out: would write over the frame {}: let it be another folder", path.display())),
        None => Ok(()),
    }
}

/// α adapts by what there is.
fn settings(options: &Options, sequence: &Sequence) -> Settings {
    let gradient = match options.constant {
        Some(_) => Gradient::Off,
        None if sequence.has(Layer::GradientCurrent) => Gradient::Pairs,
        None if sequence.has(Layer::Lambda) => Gradient::Lambda,
        None => Gradient::Statistics,
    };
    let mut filter = FilterSettings { gradient, ..options.preset.clone() };
    if !sequence.has_surfaces() {
        // Without depths no plane is known to be one.
        (filter.sigma_depth, filter.sigma_foreshortening) = (1e6, 0.0);
    }
    let settings = Settings { filter, ..Settings::adaptive() };
    match options.constant {
        Some(alpha) => settings.constant(alpha),
        None => settings,
    }
}

/// Prints; whoever reads may have seen enough, as `head` does.
fn say(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}

/// A bar of frames. It does not show where there is no terminal.
fn progress(what: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:32} {pos} of {len}  {msg}  {elapsed} gone, {eta} to go");
    let bar = ProgressBar::new(0).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar.with_message(what)
}
