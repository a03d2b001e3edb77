//! Denoises a sequence of EXR files: `cargo run --release --example denoise -- --help`.

#[path = "support/arguments.rs"]
mod arguments;
#[allow(dead_code, reason = "shared with `render`, which writes sequences")]
#[path = "support/camera.rs"]
mod camera;
#[path = "support/camera_fit.rs"]
mod camera_fit;
#[path = "support/denoise_options.rs"]
mod denoise_options;
#[path = "support/film.rs"]
mod film;
#[path = "support/gpu.rs"]
mod gpu;
#[path = "support/layers.rs"]
mod layers;
#[path = "support/replay.rs"]
mod replay;
#[path = "support/sequence.rs"]
mod sequence;
#[path = "support/times.rs"]
mod times;

use arguments::{Format, Usage};
use asvgf::{FilterSettings, Gradient, Settings, image_io};
use denoise_options::{Options, Request};
use film::Film;
use gpu::Gpu;
use indicatif::{ProgressBar, ProgressStyle};
use layers::Layer;
use sequence::{Eye, Sequence};
use std::error::Error;
use std::io::Write as _;
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
    let mut sequence = Sequence::open(&options.input, options.names.clone(), options.fov_y, |frames| {
        bar.set_length(frames.into());
        bar.inc(1);
    })?;
    sequence.in_place |= options.in_place;
    bar.finish_and_clear();
    let gradient = source(options, &sequence);
    eprint!("{}", summary(&sequence));

    let gpu = Gpu::new()?;
    let mut film = Film::new(&gpu, sequence.size, settings(options, gradient))?;
    std::fs::create_dir_all(&options.out).map_err(|e| format!("--out {}: {e}", options.out.display()))?;
    let bar = progress("denoising");
    bar.set_length((sequence.last - sequence.first + 1).into());
    let denoised = replay::denoise(&mut film, &sequence, |frame, film| {
        bar.inc(1);
        write(options, film, frame)
    })?;
    bar.finish_and_clear();
    if let Some(frame) = denoised.repeated {
        eprintln!(
            "note: frames before {frame} are the same, to the last bit, wherever nothing moves: frames are denoised by themselves \
             from there on, as long as that is so; let the renderer take another seed in each, and averages over time are possible"
        );
    }
    say(&times::table(&denoised.times, None, sequence.size, &gpu));
    say(&format!("{} frames in {}\n", denoised.times.len(), options.out.display()));
    Ok(())
}

/// What makes α adaptive: what there is.
fn source(options: &Options, sequence: &Sequence) -> Gradient {
    match options.constant {
        Some(_) => Gradient::Off,
        None if sequence.has(Layer::GradientCurrent) => Gradient::Pairs,
        None if sequence.has(Layer::Lambda) => Gradient::Lambda,
        None => Gradient::Statistics,
    }
}

fn settings(options: &Options, gradient: Gradient) -> Settings {
    let filter = FilterSettings { gradient, ..options.preset.clone() };
    let settings = Settings { filter, ..Settings::adaptive() };
    match options.constant {
        Some(alpha) => settings.constant(alpha),
        None => settings,
    }
}

/// What was found, what was not, and what that means.
fn summary(sequence: &Sequence) -> String {
    let list = |wanted: bool| {
        let layers = Layer::ALL.into_iter().filter(|&layer| sequence.has(layer) == wanted);
        layers.map(Layer::name).collect::<Vec<_>>().join(", ")
    };
    let [width, height] = sequence.size;
    let mut out = format!("frames {} to {}, {width}×{height}, with {}\n", sequence.first, sequence.last, list(true));
    let absent = list(false);
    if !absent.is_empty() {
        out += &format!("left out, as the files do not have it: {absent}\n");
    }
    out += match sequence.eye {
        Eye::Given => "",
        Eye::Fitted => {
            "note: no cameras in manifest.json: they were derived from normals and depth, but for where they are\n"
        }
        Eye::Assumed => {
            "note: no cameras in manifest.json: one at the origin is taken, that looks along -Z with +Y up; normals should be in \
             its space, and --fov-y right\n"
        }
    };
    if !sequence.has(Layer::Motion) {
        out += match sequence.eye {
            Eye::Given => "note: motion is absent: only the camera is taken to move\n",
            Eye::Fitted | Eye::Assumed => "note: motion is absent: the camera is taken to turn, and nothing to move\n",
        };
    }
    out
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

/// Writes the images of the last frame in each format.
fn write(options: &Options, film: &mut Film<'_>, frame: u32) -> Result<(), Box<dyn Error>> {
    let [width, height] = film.denoiser.size();
    for &(name, view) in &options.outputs {
        for &format in &options.formats {
            let path = |extension: &str| options.out.join(format!("{name}_{frame:04}.{extension}"));
            match format {
                Format::Png => {
                    image_io::write_png(path("png"), width, height, &film.picture(view, options.exposure)?)?;
                }
                Format::Exr => image_io::write_exr_rgb(path("exr"), width, height, &film.numbers(view)?)?,
            }
        }
    }
    Ok(())
}
