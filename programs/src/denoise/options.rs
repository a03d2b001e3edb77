//! The command line of `denoise`.

use crate::arguments::{Format, Usage, Value};
use crate::sequence::Source;
use crate::sequence::layers::{Layer, Mapping, Meaning};
use asvgf::image_io::{Compression, SampleType};
use asvgf::{FilterSettings, Settings, View};
use lexopt::ValueExt as _;
use std::ffi::OsString;
use std::path::PathBuf;

/// Text that `--help` prints.
pub const HELP: &str = "\
Denoises a sequence of images that any path tracer has rendered.

Usage: cargo run --release --example denoise -- IN --out OUT_DIR [OPTIONS]

IN is a folder of EXR files with a number in their names (frame_0001.exr, shot.1001.exr,
0001.exr), any one of them, or a pattern as in DIR/shot.####.exr. Each has some of these
channels:
  R,G,B                     noisy linear radiance, emission included; the only ones required
  normal.X,Y,Z              world space, unit; zero where nothing was hit
  depth.Z                   linear, along the view axis; 0 or infinite: nothing was hit
  albedo.R,G,B              reflectance, 0…1
  emission.R,G,B            radiance that the visible surface or the sky emits
  motion.X,Y                previous − current position in pixels, x right, y down
  prev_depth.Z              linear depth that the point had in the last frame's camera
  id.I                      number of the object
  gradient.current.R,G,B    radiance of a surface sample of the last frame, shaded again in
                            this frame with last frame's random numbers, in the pixel where
                            it is now; −1 where there is none; at most one in each 3×3
  gradient.previous.R,G,B   its radiance in the last frame
  lambda.Y                  instead of these two: the part of the history to drop, 0…1
The names of Blender (Noisy Image, Combined, Denoising Albedo, Depth, Vector, …), of Mitsuba
(sh_normal, depth.T, shape_index, …) and of others (rgba, beauty, N, Z, …) are known too.
The filter does without the absent ones or derives them from the others, and reports it.
docs/sequences.md has a recipe for each renderer.
manifest.json beside the frames holds the cameras: {\"cameras\": [{\"o\": eye,
\"fw\": forward, \"r\": right, \"up\": up, \"th\": tangent of half the horizontal field of
view}, …]}, and the frames that begin other shots: \"cuts\": [31, …].

Input
  --map LAYER=NAME      the channels of a layer in the files: NAME.R, NAME.G, NAME.B and the
                        like, the one channel NAME, or a list, color=ch00,ch01,ch02. LAYER is
                        color, or the part before the dot above. After a colon follows the
                        meaning of the numbers: motion=NAME:up or :down (y), depth=NAME:ray
                        (along the pixel's ray) or :axis   [the one that NAME implies]
  --layer NAME          view layer to take all channels from
                        [the first with colour, normals and depth; never Composite]
  --frames A-B          numbers of the first and the last frame to denoise           [all]
  --cut N,…             frames that begin another shot        [those of manifest.json, and
                        frames in which no surface is where it was]
  --fov-y DEGREES       vertical field of view, 0.01…179, if neither manifest.json nor the
                        files' attributes have cameras       [derived from the normals and
                        depths of planes in the frames, else 45]
  --in-place            the gradient's paths are those of the pixels themselves, and so no
                        additional samples                         [as in manifest.json]

Denoiser
  --causal              denoise each frame from itself and earlier ones alone, as in real
                        time; takes half the time [frames use up to 12 … 64 later ones too]
  --edges KIND          smooth, as whole pixels show them, or sharp, as points do
                        [smooth if depths are those of points all over the pixels, or the
                        file is Blender's; sharp with --causal]
  --preset NAME         default, or classic: the formulas as published       [default]
  --alpha KIND          adaptive, or constant:A with 0…1 as the weight of each new
                        frame (constant alone: 0.2)                         [adaptive]
  --iterations N        spatial filter iterations, 0…8          [default 4+1, classic 5]
  --outlier-limit X     largest brightness of a sample over that of its surroundings,
                        unless several samples around are as bright, 0…10⁶; 0: no limit
                                                                 [default 40, classic 0]

Output
  --out DIR             folder for everything; made if missing
  --outputs LIST        images to write, separated by commas                [denoised]
                        denoised, lambda, history (its length in frames), alpha,
                        gradient, variance, noisy, albedo, normal, depth, motion,
                        motion-error, non-finite, outliers; and of specular light, if it is a
                        signal of its own: specular, specular-noisy, diffuse-noisy,
                        specular-albedo, roughness, hit-distance, reflection-motion,
                        agreement, specular-history (its length in frames)
  --format LIST         exr, png (tone-mapped), or exr,png                       [exr]
  --keep-channels       denoised files have all channels and parts of the frame's file, with
                        other colours                               [R, G, B and its A]
  --same-names          denoised files are called as the frames are   [denoised_NUMBER.exr]
  --type KIND           half or float, of denoised files              [as the frame's]
  --compression KIND    none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa or dwab, of denoised
                        files                                         [as the frame's]
  --exposure X          factor on radiance in PNG files                            [1]

  -h, --help            print this

Denoised files keep the frame's windows, alpha and attributes. Other outputs are called
OUT_DIR/OUTPUT_NUMBER.EXT, as in out/lambda_0031.exr. All frames are checked before the first is
written. A table of times goes to standard output.
`cargo run --release --example score -- OUT_DIR IN_DIR` compares the result with references.
Exit status: 0 done, 1 failed, 2 wrong usage.
";

/// Outputs by the names of their files.
pub const OUTPUTS: [(&str, View); 23] = [
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
    ("specular", View::Specular),
    ("specular-noisy", View::SpecularNoisy),
    ("diffuse-noisy", View::DiffuseNoisy),
    ("specular-albedo", View::SpecularAlbedo),
    ("roughness", View::Roughness),
    ("hit-distance", View::HitDistance),
    ("reflection-motion", View::ReflectionMotion),
    ("agreement", View::Agreement),
    ("specular-history", View::SpecularHistoryLength),
];

/// Request of the command line.
#[derive(Debug)]
pub enum Request {
    Help,
    Denoise(Box<Options>),
}

#[derive(Debug)]
pub struct Options {
    pub source: Source,
    pub out: PathBuf,
    pub in_place: bool,
    /// True if frames must not use later ones.
    pub causal: bool,
    /// Choice of edges, if the command line has one: true for those of whole pixels.
    pub smooth_edges: Option<bool>,
    pub preset: FilterSettings,
    /// `None` for an adaptive α.
    pub constant: Option<f32>,
    pub outputs: Vec<(&'static str, View)>,
    pub formats: Vec<Format>,
    pub keep_channels: bool,
    pub same_names: bool,
    pub sample_type: Option<SampleType>,
    pub compression: Option<Compression>,
    pub exposure: f32,
}

/// Compressions of denoised files, by name.
const COMPRESSIONS: [(&str, Compression); 10] = [
    ("none", Compression::None),
    ("rle", Compression::Rle),
    ("zips", Compression::Zips),
    ("zip", Compression::Zip),
    ("piz", Compression::Piz),
    ("pxr24", Compression::Pxr24),
    ("b44", Compression::B44),
    ("b44a", Compression::B44a),
    ("dwaa", Compression::Dwaa),
    ("dwab", Compression::Dwab),
];

/// Reads the arguments after the program's name.
pub fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Request, Usage> {
    let (mut input, mut out) = (None, None);
    let mut options = Options {
        source: Source::default(),
        out: PathBuf::new(),
        in_place: false,
        causal: false,
        smooth_edges: None,
        preset: FilterSettings::default(),
        constant: None,
        outputs: vec![OUTPUTS[0]],
        formats: vec![Format::Exr],
        keep_channels: false,
        same_names: false,
        sample_type: None,
        compression: None,
        exposure: 1.0,
    };
    // Settings by name with their values, independent of the preset.
    let mut changes = Vec::new();
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
                return Err(Usage(format!("{}: a second IN; one is denoised at a time", text.to_string_lossy())));
            }
            lexopt::Arg::Short(_) => return Err(argument.unexpected().into()),
        };
        let mut value = || Ok::<_, Usage>(Value { text: parser.value()?.string()?, option: name.clone() });
        let source = &mut options.source;
        match name.as_str() {
            "in-place" => options.in_place = true,
            "causal" => options.causal = true,
            "edges" => options.smooth_edges = Some(value()?.one_of(&[("smooth", true), ("sharp", false)])?),
            "keep-channels" => options.keep_channels = true,
            "same-names" => options.same_names = true,
            "out" => out = Some(parser.value()?.into()),
            "map" => source.names.push(value()?.mapping()?),
            "layer" => source.view_layer = Some(value()?.text),
            "frames" => source.frames = Some(value()?.range()?),
            "cut" => source.cuts.extend(value()?.list(|v| v.whole(0..=999_999_999).map(i64::from))?),
            "fov-y" => source.fov_y = Some(value()?.number(0.01..=179.0)?.to_radians()),
            "preset" => {
                let classic = value()?.one_of(&[("default", false), ("classic", true)])?;
                options.preset = if classic { FilterSettings::classic() } else { FilterSettings::default() };
            }
            "alpha" => options.constant = value()?.alpha()?,
            "iterations" => changes.push(("filter.iterations", value()?)),
            "outlier-limit" => changes.push(("filter.outlier_limit", value()?)),
            "outputs" => {
                let known = OUTPUTS.map(|output| (output.0, output));
                options.outputs = value()?.list(|v| v.one_of(&known))?;
            }
            "format" => options.formats = value()?.list(|v| v.one_of(&[("png", Format::Png), ("exr", Format::Exr)]))?,
            "type" => {
                let known = [("half", SampleType::Half), ("float", SampleType::Float)];
                options.sample_type = Some(value()?.one_of(&known)?);
            }
            "compression" => options.compression = Some(value()?.one_of(&COMPRESSIONS)?),
            "exposure" => options.exposure = value()?.number(1e-6..=1e6)?,
            _ => return Err(lexopt::Arg::Long(&name).unexpected().into()),
        }
    }
    let mut settings = Settings { filter: options.preset, ..Settings::adaptive() };
    for (setting, value) in changes {
        value.set(setting, &mut settings)?;
    }
    options.preset = settings.filter;
    options.source.input = input.ok_or_else(|| Usage("IN is missing: the folder with the frames".into()))?;
    options.out = out.ok_or_else(|| Usage("--out OUT_DIR is missing: the folder to write to".into()))?;
    Ok(Request::Denoise(Box::new(options)))
}

/// Values that only sequences have.
impl Value {
    fn mapping(&self) -> Result<Mapping, Usage> {
        let parts = self.text.split_once('=').filter(|(_, name)| !name.is_empty());
        let found = parts.and_then(|(key, names)| {
            let layer = Layer::ALL.into_iter().find(|layer| layer.name() == key)?;
            Some((layer, names))
        });
        let known = || Layer::ALL.map(Layer::name).join(", ");
        let wrong = || self.wrong(format!("must be LAYER=NAME, with LAYER one of {}", known()));
        let (layer, names) = found.ok_or_else(wrong)?;
        // Names may contain colons themselves: only these words count as the meaning of the numbers.
        let meanings = match layer {
            Layer::Motion => [(":up", Meaning::Upwards), (":down", Meaning::Same)],
            _ => [(":ray", Meaning::AlongRay), (":axis", Meaning::Same)],
        };
        let meanings = meanings.into_iter().filter(|_| matches!(layer, Layer::Motion | Layer::Depth));
        let said = meanings.filter_map(|(word, meaning)| Some((names.strip_suffix(word)?, meaning))).next();
        let (names, meaning) = said.map_or((names, None), |(names, meaning)| (names, Some(meaning)));
        let names: Vec<String> = names.split(',').map(|name| name.trim().to_owned()).collect();
        if names.iter().any(String::is_empty) { Err(wrong()) } else { Ok(Mapping { layer, names, meaning }) }
    }

    fn range(&self) -> Result<[i64; 2], Usage> {
        // A leading dash is a sign.
        let middle = self.text.char_indices().skip(1).find(|(_, c)| *c == '-').map(|(at, _)| at);
        let parts =
            middle.map_or((self.text.as_str(), self.text.as_str()), |at| (&self.text[..at], &self.text[at + 1..]));
        let numbers = parts.0.trim().parse().ok().zip(parts.1.trim().parse().ok());
        let range = numbers.filter(|(from, to): &(i64, i64)| from <= to).map(|(from, to)| [from, to]);
        range.ok_or_else(|| self.wrong("must be two numbers of frames, as in 101-148"))
    }
}
