//! The command line of `render`.

use crate::arguments::{Format, Usage, Value};
use asvgf::scene::builtin;
use asvgf::{Gradient, Mode, Settings, View};
use asvgf_fallbacks::shipped;
use lexopt::ValueExt as _;
use std::ffi::OsString;
use std::path::PathBuf;
use std::str::FromStr;

/// Text that `--help` prints.
pub const HELP: &str = "\
Renders a path-traced scene, denoises it with A-SVGF and writes pictures.

Usage: cargo run --release --example render -- [SCENE] [OPTIONS]

Without any argument: frames 30 to 61 of the built-in scene `cornell`, and a comparison
(--compare) of the last one, just after the lamp came back on.

Scene
  SCENE                 a .gltf, .glb or .obj file, or a scene that comes along: cornell,
                        pillars, gloss, textured, still-life                    [cornell]
  --animation NAME      name or number (from 0) of an animation, or static
                             [cornell, pillars, gloss: all; files: the first, if any]
  --environment FILE    light from all around: HDR, EXR, PNG, JPEG …, equirectangular;
                        or sky, a cloudy one            [sky, if the scene has no light]
  --cull                leave out the back faces of materials that are not double-sided, as
                        rasterizers do
  --list                print scenes and animations, all meshes and materials of SCENE, and
                        their unread parts; render nothing

Camera                                 [the file's own, else one that frames the scene]
  --eye X,Y,Z           its position, in metres, +Y up
  --target X,Y,Z        the point in the picture's middle      [with --eye: the centre]
  --up X,Y,Z            the direction that is up in the picture                [0,1,0]
  --fov-y DEGREES       vertical field of view, 0.01…179
  --jitter              move the samples within the pixels from frame to frame
                        (Halton 2, 3); else they are at the pixels' centres

Frames
  --size WxH            pixels                                               [640x360]
  --frames N            number of frames; time advances by 1/30 s each            [32]
  --start-frame N       number of the first frame                                  [0]

Path tracer
  --spp N               paths per pixel and frame, 1…65536                         [1]
  --bounces N           reflections after the first surface, 0…1024; 0 is direct
                        light only                                                 [3]
  --seed N              another number gives other noise                           [0]

Denoiser
  --preset NAME         default, or classic: the formulas as published       [default]
  --alpha KIND          adaptive, or constant:A with 0…1 as the weight of each new
                        frame (constant alone: 0.2)                         [adaptive]
  --gradient KIND       source of the adaptive alpha: reshade (repeated paths), statistics
                        (new samples against their history: no path is repeated),
                        blinn-phong (lights without shadows), off (the same as a
                        constant alpha)                                      [reshade]
  --iterations N        spatial filter iterations, 0…8          [default 4+1, classic 5]
  --outlier-limit X     largest brightness of a sample over that of its surroundings,
                        unless several samples around are as bright, 0…10⁶; 0: no limit
                                                                 [default 40, classic 0]

Output
  --out DIR             folder for everything; made if missing                   [out]
  --outputs LIST        images to write, separated by commas, or all        [denoised]
                        denoised, noisy, albedo, normal, depth, triangle-id, motion,
                        gradient, lambda, alpha, history-length, variance, non-finite,
                        rays, motion-error, emission, object, pair-now, pair-before,
                        outliers; of what shines: diffuse-noisy, specular-noisy, specular,
                        specular-albedo, roughness, hit-distance, reflection-motion,
                        agreement, specular-history-length, specular-pair-now,
                        specular-pair-before
  --format LIST         png (tone-mapped), exr (numbers: linear radiance and the like
                        as 32-bit floats in R, G, B), or both as png,exr         [png]
  --exposure X          factor on radiance in PNG files                            [1]
  --sequence            also write the denoiser's input, as a sequence that `denoise`
                        reads: frame_0000.exr … and manifest.json
  --reference SPP       also trace each frame with SPP paths per pixel, unfiltered
  --compare[=SPP]       end with comparison.png: noisy, constant alpha, adaptive alpha
                        and reference of the last frame; brightened where it is dark,
                        unless --exposure is given. The reference has SPP paths per
                        pixel [64] and is denoised: 64 paths alone are noisier than the
                        results. If --reference traces at least as many paths, its
                        image takes this place, unfiltered
  --explain             print the compiled features, and the passes with their images

  -h, --help            print this

Files are named DIR/OUTPUT_FRAME.EXT, as in out/denoised_0031.png.
A table of times goes to standard output, everything else to standard error.
Exit status: 0 done, 1 failed, 2 wrong usage.
";

/// Default paths per pixel of a comparison's reference.
const REFERENCE: u32 = 64;

/// Request of the command line.
#[derive(Debug)]
pub enum Request {
    Help,
    Render(Box<Options>),
}

/// Source of a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    BuiltIn(String),
    /// A file that comes along with the programs.
    Shipped(String),
    File(PathBuf),
}

/// Options that override the scene's own camera.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Viewpoint {
    pub eye: Option<[f64; 3]>,
    pub target: Option<[f64; 3]>,
    pub up: Option<[f32; 3]>,
    /// In radians.
    pub fov_y: Option<f32>,
}

#[derive(Clone, Debug)]
pub struct Options {
    pub source: Source,
    pub animation: Option<String>,
    pub environment: Option<PathBuf>,
    pub viewpoint: Viewpoint,
    pub jitter: bool,
    pub size: [u32; 2],
    pub frames: u32,
    pub start_frame: u32,
    pub settings: Settings,
    pub out: PathBuf,
    pub outputs: Vec<View>,
    /// True if `--outputs all` was given: images that a scene does not have are passed over.
    pub every_output: bool,
    pub formats: Vec<Format>,
    pub exposure: Option<f32>,
    pub reference: Option<u32>,
    /// Paths per pixel of the comparison's reference.
    pub compare: Option<u32>,
    pub sequence: bool,
    pub explain: bool,
    pub cull: bool,
    pub list: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            source: Source::BuiltIn("cornell".into()),
            animation: None,
            environment: None,
            viewpoint: Viewpoint::default(),
            jitter: false,
            size: [640, 360],
            frames: 32,
            start_frame: 0,
            settings: Settings::adaptive(),
            out: "out".into(),
            outputs: vec![View::Denoised],
            every_output: false,
            formats: vec![Format::Png],
            exposure: None,
            reference: None,
            compare: None,
            sequence: false,
            explain: false,
            cull: false,
            list: false,
        }
    }
}

impl Options {
    /// Returns the paths per pixel of a reference for the comparison alone, which is denoised. `None` if there is no
    /// comparison, or if an unfiltered reference of at least as many paths is traced anyway.
    pub fn denoised_reference(&self) -> Option<u32> {
        self.compare.filter(|&paths| self.reference.is_none_or(|traced| traced < paths))
    }
}

/// Reads the arguments after the program's name.
pub fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Request, Usage> {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let mut options = Options::default();
    if arguments.is_empty() {
        // The lamp of the built-in scenes comes back on in frame 60, the last frame but one.
        options = Options { compare: Some(REFERENCE), start_frame: 30, ..options };
    }
    let mut filter = Filter::default();
    let mut source = None;
    let mut parser = lexopt::Parser::from_args(arguments);
    while let Some(argument) = parser.next()? {
        let name = match argument {
            lexopt::Arg::Short('h') | lexopt::Arg::Long("help") => return Ok(Request::Help),
            lexopt::Arg::Long(name) => name.to_owned(),
            lexopt::Arg::Value(text) if source.is_none() => {
                source = Some(scene_source(text)?);
                continue;
            }
            lexopt::Arg::Value(text) => {
                return Err(Usage(format!("{}: a second SCENE; one is rendered at a time", text.to_string_lossy())));
            }
            lexopt::Arg::Short(_) => return Err(argument.unexpected().into()),
        };
        match name.as_str() {
            "jitter" => options.jitter = true,
            "compare" => {
                options.compare = match parser.optional_value() {
                    Some(text) => Some(Value { text: text.string()?, option: name }.whole(1..=1_000_000)?),
                    None => Some(REFERENCE),
                };
            }
            "sequence" => options.sequence = true,
            "explain" => options.explain = true,
            "cull" => options.cull = true,
            "list" => options.list = true,
            "environment" => options.environment = Some(parser.value()?.into()),
            "out" => options.out = parser.value()?.into(),
            _ if !VALUED.contains(&name.as_str()) => return Err(lexopt::Arg::Long(&name).unexpected().into()),
            _ => {
                let value = Value { text: parser.value()?.string()?, option: name };
                value.read(&mut options, &mut filter)?;
            }
        }
    }
    if let Some(source) = source {
        options.source = source;
    }
    filter.apply(&mut options)?;
    check(&options)?;
    Ok(Request::Render(Box::new(options)))
}

/// The options whose value is text that [`Value::read`] understands.
const VALUED: [&str; 20] = [
    "alpha",
    "animation",
    "bounces",
    "exposure",
    "eye",
    "format",
    "fov-y",
    "frames",
    "gradient",
    "iterations",
    "outlier-limit",
    "outputs",
    "preset",
    "reference",
    "seed",
    "size",
    "spp",
    "start-frame",
    "target",
    "up",
];

/// Options of the filter; they depend on one another, but not on their order.
#[derive(Default)]
struct Filter {
    classic: bool,
    constant: Option<f32>,
    adaptive: bool,
    gradient: Option<Gradient>,
    /// Settings by name with their values, independent of the preset.
    changes: Vec<(&'static str, Value)>,
    every_output: bool,
}

impl Filter {
    fn apply(self, options: &mut Options) -> Result<(), Usage> {
        let preset = if self.classic { Settings::classic() } else { Settings::adaptive() };
        let mut settings = Settings { tracer: options.settings.tracer.clone(), ..preset };
        if let Some(gradient) = self.gradient {
            settings.filter.gradient = gradient;
        }
        for (setting, value) in &self.changes {
            value.set(setting, &mut settings)?;
        }
        match (self.constant, self.gradient) {
            (Some(_), Some(Gradient::Reshade | Gradient::Statistics | Gradient::BlinnPhong)) => {
                return Err(Usage("--alpha constant has no gradient: leave out --gradient or set it to off".into()));
            }
            (None, Some(Gradient::Off)) if self.adaptive => {
                return Err(Usage(
                    "--alpha adaptive needs a gradient: --gradient reshade, statistics or blinn-phong".into(),
                ));
            }
            (Some(alpha), _) => settings = settings.constant(alpha),
            (None, _) => {}
        }
        options.settings = settings;
        if self.every_output {
            options.every_output = true;
            options.outputs = View::ALL.iter().copied().filter(|&view| exists(view, &options.settings)).collect();
        }
        Ok(())
    }
}

/// True if a frame with these settings has this image.
fn exists(view: View, settings: &Settings) -> bool {
    match view {
        View::Gradient => settings.filter.gradient != Gradient::Off,
        View::Mean => settings.mode == Mode::Reference,
        View::Outliers => settings.filter.outlier_limit > 0.0,
        _ => true,
    }
}

/// Values that only renderings have.
impl Value {
    fn read(self, options: &mut Options, filter: &mut Filter) -> Result<(), Usage> {
        match self.option.as_str() {
            "animation" => options.animation = Some(self.text.clone()),
            "eye" => options.viewpoint.eye = Some(self.vector()?),
            "target" => options.viewpoint.target = Some(self.vector()?),
            "up" => options.viewpoint.up = Some(self.vector()?),
            "fov-y" => options.viewpoint.fov_y = Some(self.number(0.01..=179.0)?.to_radians()),
            "size" => options.size = self.size()?,
            "frames" => options.frames = self.whole(1..=1_000_000)?,
            "start-frame" => options.start_frame = self.whole(0..=1_000_000_000)?,
            "spp" => self.set("tracer.samples", &mut options.settings)?,
            "bounces" => self.set("tracer.bounces", &mut options.settings)?,
            "seed" => self.set("tracer.seed", &mut options.settings)?,
            "iterations" => filter.changes.push(("filter.iterations", self)),
            "outlier-limit" => filter.changes.push(("filter.outlier_limit", self)),
            "reference" => options.reference = Some(self.whole(1..=1_000_000)?),
            "exposure" => options.exposure = Some(self.number(1e-6..=1e6)?),
            "preset" => filter.classic = self.one_of(&[("default", false), ("classic", true)])?,
            "gradient" => filter.gradient = Some(self.gradient()?),
            "alpha" => {
                filter.constant = self.alpha()?;
                filter.adaptive = filter.constant.is_none();
            }
            "format" => options.formats = self.list(|v| v.one_of(&[("png", Format::Png), ("exr", Format::Exr)]))?,
            "outputs" if self.text == "all" => filter.every_output = true,
            "outputs" => {
                let known: Vec<_> = View::ALL.iter().map(|&view| (view.name(), view)).collect();
                options.outputs = self.list(|v| v.one_of(&known))?;
                filter.every_output = false;
            }
            _ => return Err(self.wrong("is unknown")),
        }
        Ok(())
    }

    fn vector<T: FromStr + Copy + Into<f64>>(&self) -> Result<[T; 3], Usage> {
        let numbers: Option<Vec<T>> =
            self.text.split(',').map(|t| t.trim().parse().ok().filter(|&x: &T| x.into().is_finite())).collect();
        let vector = numbers.and_then(|numbers| numbers.try_into().ok());
        vector.ok_or_else(|| self.wrong("must be three numbers, as in 0,1.5,4"))
    }

    fn size(&self) -> Result<[u32; 2], Usage> {
        // Limits of one device texture by default, and of 8K in all: the denoiser takes about 300 bytes per pixel.
        let (side, area) = (8192, 7680 * 4320);
        let parts = self.text.split_once(['x', '×']);
        let size = parts.and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
        let size = size.filter(|&[width, height]: &[u32; 2]| {
            (1..=side).contains(&width) && (1..=side).contains(&height) && width * height <= area
        });
        let reason = || format!("must be WIDTHxHEIGHT, as in 640x360, 1 to {side} each and 7680x4320 pixels in all");
        size.ok_or_else(|| self.wrong(reason()))
    }

    fn gradient(&self) -> Result<Gradient, Usage> {
        let known = [Gradient::Reshade, Gradient::Statistics, Gradient::BlinnPhong, Gradient::Off];
        self.one_of(&known.map(|gradient| (gradient.name(), gradient)))
    }
}

fn scene_source(text: OsString) -> Result<Source, Usage> {
    if let Some(name) = text.to_str().filter(|name| builtin::NAMES.contains(name)) {
        return Ok(Source::BuiltIn(name.into()));
    }
    if let Some(name) = text.to_str().filter(|name| shipped::NAMES.contains(name)) {
        return Ok(Source::Shipped(name.into()));
    }
    let path = PathBuf::from(text);
    if path.extension().is_none() && !path.exists() {
        let (name, known) = (path.display(), [&builtin::NAMES[..], &shipped::NAMES].concat().join(", "));
        return Err(Usage(format!("{name}: no such scene; known are {known}, files end in .gltf, .glb or .obj")));
    }
    Ok(Source::File(path))
}

/// Checks combinations of options, after all are read.
fn check(options: &Options) -> Result<(), Usage> {
    let viewpoint = &options.viewpoint;
    if viewpoint.eye.is_some() && viewpoint.eye == viewpoint.target {
        return Err(Usage("--eye and --target are the same point: the camera has no direction".into()));
    }
    if viewpoint.up == Some([0.0; 3]) {
        return Err(Usage("--up 0,0,0: has no direction".into()));
    }
    if let (Source::BuiltIn(scene), Some(name)) = (&options.source, &options.animation)
        && !builtin::animations(scene).contains(&name.as_str())
    {
        let known = builtin::animations(scene).join(", ");
        return Err(Usage(format!("--animation {name}: {scene} has {known}")));
    }
    match options.outputs.iter().find(|&&view| !exists(view, &options.settings)) {
        Some(view) => Err(Usage(format!("--outputs {}: there is none with a constant alpha", view.name()))),
        None => Ok(()),
    }
}
