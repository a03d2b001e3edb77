//! The program `render`: renders a scene, denoises it, and writes pictures.

pub mod comparison;
mod listing;
pub mod options;

use crate::arguments::{Format, Usage};
use crate::film::Film;
use crate::gpu::Gpu;
use crate::program::say;
use crate::sequence::export::{self, Export};
use crate::stage::{self, Stage};
use crate::tracing::{self, Reference};
use crate::{times, tone};
use asvgf::scene::GpuScene;
use asvgf::{Gradient, Settings, View, image_io};
use comparison::Tile;
use indicatif::{ProgressBar, ProgressStyle};
use options::{Options, Request, Viewpoint};
use std::error::Error;
use std::ffi::OsString;
use std::path::PathBuf;

/// Runs the program with the arguments after its name.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> Result<(), Box<dyn Error>> {
    match options::parse(arguments)? {
        Request::Help => say(options::HELP),
        Request::Render(options) => render(&options)?,
    }
    Ok(())
}

fn render(options: &Options) -> Result<(), Box<dyn Error>> {
    if options.list {
        say(&listing::list(options, &stage::read(options)?));
        return Ok(());
    }
    let stage = Stage::load(options)?;
    std::fs::create_dir_all(&options.out).map_err(|e| format!("--out {}: {e}", options.out.display()))?;
    let gpu = Gpu::new()?;
    let mut scene = GpuScene::new(&gpu.device, &gpu.queue, &stage.scene)?;
    let mut film = Film::new(&gpu, options.size, options.settings.clone())?;
    // The other kind of α gets the same noise.
    let mut other = options.compare.map(|_| Film::new(&gpu, options.size, other(&options.settings))).transpose()?;
    let mut reference = options.reference.map(|_| Reference::new(&gpu, options.size, &options.settings)).transpose()?;

    let bar = progress(options);
    let mut timed = Vec::new();
    let mut cameras = Vec::new();
    let mut export = Export::default();
    let mut truth = Vec::new();
    let last = options.start_frame + options.frames - 1;
    for frame in options.start_frame..=last {
        bar.set_message(format!("frame {frame} of {}…{last}", options.start_frame));
        let pose = stage.pose(frame);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        scene.update(&gpu.device, &mut encoder, &pose)?;
        gpu.queue.submit([encoder.finish()]);
        let camera = stage.camera(&pose, frame);
        timed.push(tracing::render(&mut film, &scene, camera, frame).map_err(|e| blame(e, &options.viewpoint))?);
        bar.inc(options.settings.tracer.samples.into());
        for &view in &options.outputs {
            match write(options, &mut film, view, frame) {
                Err(error) if options.every_output && is_absent(&*error) => {}
                result => result?,
            }
        }
        if options.sequence {
            export.write(&options.out.join(format!("frame_{frame:04}.exr")), &mut film)?;
            cameras.push(camera);
        }
        if let Some(other) = &mut other {
            tracing::render(other, &scene, camera, frame)?;
            bar.inc(options.settings.tracer.samples.into());
        }
        let traced = |paths: u32| bar.inc(paths.into());
        if let (Some(reference), Some(paths)) = (&mut reference, options.reference) {
            bar.set_message(format!("reference of frame {frame}"));
            truth = reference.converge(&scene, camera, paths, traced)?;
            write_reference(options, &truth, frame)?;
        }
        if let Some(paths) = options.denoised_reference().filter(|_| frame == last) {
            bar.set_message(format!("reference of frame {frame}"));
            truth = tracing::converge_denoised(&gpu, options.size, &options.settings, &scene, camera, paths, traced)?;
        }
    }
    if let Some(other) = &mut other {
        write_comparison(options, &mut film, other, truth)?;
    }
    if options.sequence {
        export::write_manifest(&options.out, options.size, &cameras)?;
    }
    bar.finish_and_clear();
    if let Some(plan) = film.denoiser.plan().filter(|_| options.explain) {
        say(&format!("\n{plan}\nThe same as a Mermaid graph\n\n{}", plan.graph()));
    }
    let rays = film.numbers(View::Rays)?.iter().map(|pixel| f64::from(pixel[0])).sum();
    say(&times::table(&timed, Some(rays), options.size, &gpu));
    say(&format!("{} frames in {}\n", options.frames, options.out.display()));
    if options.compare.is_some() {
        let file = options.out.join("comparison.png");
        say(&format!("Comparison of the last frame in {}; {}\n", file.display(), reference_in_words(options)));
    }
    Ok(())
}

/// Returns a bar that counts paths per pixel, because they take the time. It stays hidden without a terminal.
fn progress(options: &Options) -> ProgressBar {
    let [frames, paths] = [options.frames, options.settings.tracer.samples].map(u64::from);
    let films = if options.compare.is_some() { 2 } else { 1 };
    let [reference, last] =
        [options.reference, options.denoised_reference()].map(|paths| u64::from(paths.unwrap_or(0)));
    let bar = ProgressBar::new(frames * (films * paths + reference) + last);
    let style = ProgressStyle::with_template("{bar:32} {percent:>3} %  {msg}  {elapsed} gone, {eta} to go");
    bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

fn is_constant(settings: &Settings) -> bool {
    settings.filter.gradient == Gradient::Off
}

/// Returns the other settings of a comparison: constant if these are adaptive, and the other way round.
fn other(settings: &Settings) -> Settings {
    let settings = settings.clone();
    if !is_constant(&settings) {
        return settings.constant(0.2);
    }
    let preset = Settings::adaptive().filter;
    let filter = asvgf::FilterSettings {
        gradient: preset.gradient,
        alpha: preset.alpha,
        max_history: preset.max_history,
        ..settings.filter.clone()
    };
    Settings { filter, ..settings }
}

/// Attributes an error of the camera to the options that made it.
fn blame(error: asvgf::Error, viewpoint: &Viewpoint) -> Box<dyn Error> {
    match error {
        asvgf::Error::Camera { .. } if *viewpoint != Viewpoint::default() => {
            Usage(format!("--eye, --target, --up, --fov-y: {error}")).into()
        }
        _ => error.into(),
    }
}

/// True if a requested image does not exist in the scene.
fn is_absent(error: &(dyn Error + 'static)) -> bool {
    matches!(error.downcast_ref(), Some(asvgf::Error::NoView { .. }))
}

fn path(options: &Options, name: &str, frame: u32, format: Format) -> PathBuf {
    let extension = if format == Format::Png { "png" } else { "exr" };
    options.out.join(format!("{name}_{frame:04}.{extension}"))
}

/// Writes an image of the last frame in each format.
fn write(options: &Options, film: &mut Film<'_>, view: View, frame: u32) -> Result<(), Box<dyn Error>> {
    let [width, height] = options.size;
    for &format in &options.formats {
        let path = path(options, view.name(), frame, format);
        match format {
            Format::Png => {
                let pixels = film.picture(view, options.exposure.unwrap_or(1.0))?;
                image_io::write_png(path, width, height, &pixels)?;
            }
            Format::Exr => image_io::write_exr_rgb(path, width, height, &film.numbers(view)?)?,
        }
    }
    Ok(())
}

/// Writes a converged image in each format.
fn write_reference(options: &Options, colors: &[[f32; 3]], frame: u32) -> Result<(), Box<dyn Error>> {
    let [width, height] = options.size;
    for &format in &options.formats {
        let path = path(options, "reference", frame, format);
        match format {
            Format::Png => {
                let exposure = options.exposure.unwrap_or(1.0);
                let pixels: Vec<[u8; 4]> = colors.iter().map(|&color| tone::pixel(color, exposure)).collect();
                image_io::write_png(path, width, height, &pixels)?;
            }
            Format::Exr => image_io::write_exr_rgb(path, width, height, colors)?,
        }
    }
    Ok(())
}

/// Writes the last frame of both kinds of α and the truth, side by side.
fn write_comparison<'a>(
    options: &Options,
    film: &mut Film<'a>,
    other: &mut Film<'a>,
    truth: Vec<[f32; 3]>,
) -> Result<(), Box<dyn Error>> {
    let (adaptive, constant) = if is_constant(&options.settings) { (other, film) } else { (film, other) };
    let samples = options.settings.tracer.samples;
    let exposure = options.exposure.unwrap_or_else(|| comparison::exposure(&truth));
    let alpha = constant.denoiser.settings().filter.alpha;
    let label = match options.denoised_reference() {
        Some(_) => "reference, denoised".into(),
        None => reference_in_words(options),
    };
    let tiles = [
        // Shows the input of the constant α, because the adaptive one repeats some of the last frame's paths.
        Tile { label: format!("noisy, {samples} spp"), colors: constant.numbers(View::Noisy)? },
        Tile { label: format!("constant alpha {alpha}"), colors: constant.numbers(View::Denoised)? },
        Tile { label: "adaptive alpha".into(), colors: adaptive.numbers(View::Denoised)? },
        Tile { label, colors: truth },
    ];
    comparison::write(&options.out.join("comparison.png"), options.size, &tiles, exposure)?;
    Ok(())
}

/// Describes the reference of a comparison: its paths per pixel, and whether it is denoised.
fn reference_in_words(options: &Options) -> String {
    match options.denoised_reference() {
        Some(paths) => format!("reference, {paths} spp, denoised"),
        None => format!("reference, {} spp", options.reference.unwrap_or(0)),
    }
}
