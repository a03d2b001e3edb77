//! The command line of `denoise`.

use crate::arguments::{Format, Usage, Value};
use crate::layers::{Layer, Names};
use asvgf::{FilterSettings, View};
use lexopt::ValueExt as _;
use std::ffi::OsString;
use std::path::PathBuf;

/// What `--help` prints.
pub const HELP: &str = "\
Denoises a sequence of images that any path tracer has rendered.

Usage: cargo run --release --example denoise -- IN_DIR --out OUT_DIR [OPTIONS]

IN_DIR holds frame_0000.exr, frame_0001.exr, … (16- or 32-bit), each with the channels
  R,G,B                     noisy linear radiance, emission included
  normal.X,Y,Z              world space, unit; zero where nothing was hit
  depth.Z                   linear, along the view axis; 0 or infinite: nothing was hit
and, as far as there are any (what is absent is left out of the filter, and told),
  albedo.R,G,B              reflectance, 0…1
  emission.R,G,B            what the visible surface or the sky emits
  motion.X,Y                previous − current position in pixels, x right, y down
  prev_depth.Z              linear depth that the point had in the last frame's camera
  id.I                      number of the object
  gradient.current.R,G,B    radiance of a surface sample of the last frame, shaded again in
                            this frame with last frame's random numbers, in the pixel where
                            it is now; −1 where there is none; at most one in each 3×3
  gradient.previous.R,G,B   what it was in the last frame
  lambda.Y                  or, instead of these two, how much history to drop, 0…1
The names that Blender (Combined, Denoising Albedo, Denoising Normal, Depth, Vector, …) and
Mitsuba (sh_normal, depth.T, shape_index, …) use are known too.
IN_DIR/manifest.json says where the cameras are: {\"cameras\": [{\"o\": eye, \"fw\": forward,
\"r\": right, \"up\": up, \"th\": tangent of half the horizontal field of view}, …]}.

Input
  --map LAYER=NAME      where a layer is in the files: the channels NAME.R, NAME.G, NAME.B and
                        the like, or the one channel NAME. LAYER is color, or what stands
                        before the dot above. May be given more than once
  --fov-y DEGREES       vertical field of view, 0.01…179, of a camera that looks along −Z of
                        the normals' space, where there is no manifest  [derived from the
                        frames: normals and depth of planes tell, else 45]
  --in-place            the gradient's paths are those of the pixels themselves, and so no
                        samples of their own        [what manifest.json says, if anything]

Denoiser
  --preset NAME         default, or classic: the formulas as published       [default]
  --alpha KIND          adaptive, or constant:A with 0…1 as the weight of each new
                        frame (constant alone: 0.2)                         [adaptive]
  --iterations N        spatial filter iterations, 0…8          [default 4+1, classic 5]
  --outlier-limit X     how many times as bright as its surroundings a sample may be, if
                        not several around are, 0…10⁶; 0: any    [default 40, classic 0]

Output
  --out DIR             folder for everything; made if missing
  --outputs LIST        which images, separated by commas                   [denoised]
                        denoised, lambda, history (its length in frames), alpha,
                        gradient, variance, noisy, albedo, normal, depth, motion,
                        motion-error, non-finite, outliers
  --format LIST         exr (32-bit floats in R, G, B), png (tone-mapped), or exr,png  [exr]
  --exposure X          factor on radiance in PNG files                            [1]

  -h, --help            print this

Files are named OUT_DIR/OUTPUT_FRAME.EXT, as in out/denoised_0031.exr. Every frame is looked
at before the first is written. A table of times goes to standard output.
`cargo run --release --example score -- OUT_DIR IN_DIR` compares the result with references.
Exit status: 0 done, 1 failed, 2 wrong usage.
";

/// What can be written, and what the files are called.
const OUTPUTS: [(&str, View); 14] = [
    ("denoised", View::Denoised),
    ("lambda", View::Lambda),
    ("history", View::HistoryLength),
    ("alpha", View::Alpha),
    ("gradient", View::Gradient),
    ("variance", View::Variance),
    ("noisy", View::Noisy),
    ("albedo", View::Albedo),
    ("normal", View::Normal),
    ("depth", View::Depth),
    ("motion", View::Motion),
    ("motion-error", View::MotionError),
    ("non-finite", View::NonFinite),
    ("outliers", View::Outliers),
];

/// What the command line asks for.
#[derive(Debug)]
pub enum Request {
    Help,
    Denoise(Box<Options>),
}

#[derive(Debug)]
pub struct Options {
    pub input: PathBuf,
    pub out: PathBuf,
    pub names: Names,
    /// In radians.
    pub fov_y: Option<f32>,
    pub in_place: bool,
    pub preset: FilterSettings,
    /// `None` for an adaptive α.
    pub constant: Option<f32>,
    pub outputs: Vec<(&'static str, View)>,
    pub formats: Vec<Format>,
    pub exposure: f32,
}

/// Reads the arguments after the program's name.
pub fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Request, Usage> {
    let (mut input, mut out) = (None, None);
    let mut options = Options {
        input: PathBuf::new(),
        out: PathBuf::new(),
        names: Names::new(),
        fov_y: None,
        in_place: false,
        preset: FilterSettings::default(),
        constant: None,
        outputs: vec![OUTPUTS[0]],
        formats: vec![Format::Exr],
        exposure: 1.0,
    };
    let mut iterations = None;
    let mut outlier_limit = None;
    let mut parser = lexopt::Parser::from_args(arguments);
    while let Some(argument) = parser.next()? {
        let name = match argument {
            lexopt::Arg::Short('h') | lexopt::Arg::Long("help") => return Ok(Request::Help),
            lexopt::Arg::Long(name) => name.to_owned(),
            lexopt::Arg::Value(folder) if input.is_none() => {
                input = Some(folder.into());
                continue;
            }
            lexopt::Arg::Value(text) => {
                return Err(Usage(format!("{}: a second IN_DIR; one is denoised at a time", text.to_string_lossy())));
            }
            lexopt::Arg::Short(_) => return Err(argument.unexpected().into()),
        };
        let mut value = || Ok::<_, Usage>(Value { text: parser.value()?.string()?, option: name.clone() });
        match name.as_str() {
            "in-place" => options.in_place = true,
            "out" => out = Some(parser.value()?.into()),
            "map" => options.names.push(value()?.layer()?),
            "fov-y" => options.fov_y = Some(value()?.number(0.01..=179.0)?.to_radians()),
            "preset" => {
                let classic = value()?.one_of(&[("default", false), ("classic", true)])?;
                options.preset = if classic { FilterSettings::classic() } else { FilterSettings::default() };
            }
            "alpha" => options.constant = value()?.alpha()?,
            "iterations" => iterations = Some(value()?.whole(0..=8)?),
            "outlier-limit" => outlier_limit = Some(value()?.number(0.0..=1e6)?),
            "outputs" => {
                let known = OUTPUTS.map(|output| (output.0, output));
                options.outputs = value()?.list(|v| v.one_of(&known))?;
            }
            "format" => options.formats = value()?.list(|v| v.one_of(&[("png", Format::Png), ("exr", Format::Exr)]))?,
            "exposure" => options.exposure = value()?.number(1e-6..=1e6)?,
            _ => return Err(lexopt::Arg::Long(&name).unexpected().into()),
        }
    }
    options.preset.iterations = iterations.unwrap_or(options.preset.iterations);
    options.preset.outlier_limit = outlier_limit.unwrap_or(options.preset.outlier_limit);
    options.input = input.ok_or_else(|| Usage("IN_DIR is missing: the folder with the frames".into()))?;
    options.out = out.ok_or_else(|| Usage("--out OUT_DIR is missing: the folder to write to".into()))?;
    Ok(Request::Denoise(Box::new(options)))
}

/// What is only said of a sequence.
impl Value {
    fn layer(&self) -> Result<(Layer, String), Usage> {
        let parts = self.text.split_once('=').filter(|(_, name)| !name.is_empty());
        let found = parts.and_then(|(key, name)| {
            let layer = Layer::ALL.into_iter().find(|layer| layer.name() == key)?;
            Some((layer, name.to_owned()))
        });
        let known = || Layer::ALL.map(Layer::name).join(", ");
        found.ok_or_else(|| self.wrong(format!("must be LAYER=NAME, with LAYER one of {}", known())))
    }
}
