//! Denoised frames as files: all of the input except the noise.

use crate::arguments::Format;
use crate::denoise::look_ahead::Sink;
use crate::denoise::options::Options;
use crate::film::Film;
use crate::sequence::Sequence;
use crate::tone;
use asvgf::View;
use asvgf::image_io::{self, Channels};
use std::error::Error;
use std::path::{Path, PathBuf};

/// Writes the files that a command line requests.
pub struct Files<'a> {
    pub options: &'a Options,
    pub sequence: &'a Sequence,
    /// Called after each frame.
    pub after: &'a dyn Fn(),
}

impl Sink for Files<'_> {
    fn played(&mut self, index: usize, film: &mut Film<'_>) -> Result<(), Box<dyn Error>> {
        let Self { options, sequence, .. } = *self;
        let [width, height] = sequence.size;
        for &(name, view) in options.outputs.iter().filter(|(_, view)| *view != View::Denoised) {
            for &format in &options.formats {
                let path = path(options, sequence, index, name, format);
                match format {
                    Format::Exr => image_io::write_exr_rgb(path, width, height, &film.numbers(view)?)?,
                    Format::Png => image_io::write_png(path, width, height, &film.picture(view, options.exposure)?)?,
                }
            }
        }
        Ok(())
    }

    fn denoised(&mut self, index: usize, image: &[[f32; 3]]) -> Result<(), Box<dyn Error>> {
        let Self { options, sequence, .. } = *self;
        let [width, height] = sequence.size;
        for &(name, _) in options.outputs.iter().filter(|(_, view)| *view == View::Denoised) {
            for &format in &options.formats {
                let path = path(options, sequence, index, name, format);
                match format {
                    Format::Exr => write_denoised(options, sequence, index, image, &path)?,
                    Format::Png => {
                        let pixels: Vec<_> = image.iter().map(|&color| tone::pixel(color, options.exposure)).collect();
                        image_io::write_png(path, width, height, &pixels)?;
                    }
                }
            }
        }
        (self.after)();
        Ok(())
    }
}

/// Returns all files of a frame.
pub fn paths(options: &Options, sequence: &Sequence, index: usize) -> Vec<PathBuf> {
    let names = options.outputs.iter().flat_map(|&(name, _)| options.formats.iter().map(move |&format| (name, format)));
    names.map(|(name, format)| path(options, sequence, index, name, format)).collect()
}

/// Returns the file of a frame's image.
fn path(options: &Options, sequence: &Sequence, index: usize, name: &str, format: Format) -> PathBuf {
    let file = &sequence.files[index];
    let extension = match format {
        Format::Png => "png",
        Format::Exr => "exr",
    };
    if options.same_names && name == "denoised" {
        let stem = file.path.file_name().unwrap_or_default();
        return options.out.join(stem).with_extension(extension);
    }
    options.out.join(format!("{name}_{:0>4}.{extension}", file.digits))
}

/// Writes the frame's file with other colours: with everything else as it was, or with these and its alpha alone.
fn write_denoised(
    options: &Options,
    sequence: &Sequence,
    index: usize,
    denoised: &[[f32; 3]],
    path: &Path,
) -> Result<(), Box<dyn Error>> {
    let file = sequence.file(index)?;
    let image = file.channels();
    let names = sequence.color_names(index, &image)?;
    let window = file.data_window();
    let place = |c: usize| {
        let samples: Vec<f32> = denoised.iter().map(|pixel| pixel[c]).collect();
        sequence.window.place(&samples, window, 0.0)
    };
    let alpha = alpha(&image, &names[0]);
    let mut colors = names.clone();
    colors.extend(alpha.as_ref().map(|(name, _)| name.clone()));
    let mut written = if options.keep_channels {
        let mut whole = file;
        let placed: Vec<_> = names.iter().enumerate().map(|(c, name)| (name.clone(), place(c))).collect();
        whole.replace(&placed);
        whole
    } else {
        let mut channels: Vec<(String, Vec<f32>)> =
            ["R", "G", "B"].iter().enumerate().map(|(c, name)| ((*name).to_owned(), place(c))).collect();
        channels.extend(alpha.map(|(_, samples)| ("A".to_owned(), samples)));
        colors = channels.iter().map(|(name, _)| name.clone()).collect();
        file.with_channels(&names[0], &channels)
    };
    if let Some(sample_type) = options.sample_type {
        written.set_sample_type(sample_type, &colors);
    }
    if let Some(compression) = options.compression {
        written.set_compression(compression);
    }
    written.write(path)?;
    Ok(())
}

/// Returns the alpha of a colour, by the name of the colour's first channel, with the alpha's own name.
fn alpha(image: &Channels, color: &str) -> Option<(String, Vec<f32>)> {
    let front = color.rsplit_once('.').map_or(String::new(), |(front, _)| format!("{front}."));
    ["A", "a"].map(|name| format!("{front}{name}")).into_iter().find_map(|name| {
        let samples = image.get(&name)?.to_vec();
        Some((name, samples))
    })
}
