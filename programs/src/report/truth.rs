//! Truth of a sequence: its converged frames, its surfaces, and their changes.

use crate::film::Film;
use crate::gpu::Gpu;
use crate::report::hash::Hash;
use crate::report::script::Script;
use crate::report::suite::{Sequence, Suite};
use crate::sequence::export::{self, Export};
use crate::tracing::{self, Reference};
use asvgf::image_io::{Channels, ImageError, read_exr, write_exr, write_exr_rgb};
use asvgf::scene::{GpuScene, Pose};
use asvgf::{Camera, Settings, View, metrics};
use std::error::Error;
use std::path::Path;

/// Change of luminance, as a part, from which on a surface counts as relit: above the noise of the references.
pub const RELIT: f64 = 0.25;

/// Part of the depth by which the same surface may differ, half a pixel aside.
const SAME_DEPTH: f32 = 0.05;

pub type Rgb = [f32; 3];

/// A frame, before any method.
pub struct Moment {
    pub index: u32,
    pub pose: Pose,
    pub camera: Camera,
    pub reference: Vec<Rgb>,
    /// Mean of the first half of the reference's paths. On average, its squared distance from the reference equals the
    /// reference's squared distance from the truth: a half's variance is twice the whole's, and half and whole differ
    /// by half of the halves' difference.
    pub half: Vec<Rgb>,
    /// True for pixels that are neither an emitter nor a miss: those bypass every filter.
    pub counted: Vec<bool>,
    /// Pixel of the last frame, for still surfaces with the same light.
    pub steady: Vec<Option<usize>>,
    /// Frames since a pixel's surface was disoccluded or relit.
    pub ages: Vec<u32>,
}

/// A sequence with its truth.
pub struct Truth {
    pub scene: GpuScene,
    pub moments: Vec<Moment>,
    /// Hash of the scene and of all settings that references depend on.
    pub hash: Hash,
}

impl Truth {
    /// Reads the references that are kept, and traces the others. Calls back after each frame. With a folder for the
    /// export, writes there all data that a denoiser needs, in the form that `denoise` and `score` read.
    pub fn find(
        gpu: &Gpu,
        suite: &Suite,
        sequence: &Sequence,
        export: Option<&Path>,
        mut done: impl FnMut(u32),
    ) -> Result<Self, Box<dyn Error>> {
        let script = Script::load(suite, sequence)?;
        let mut scene = GpuScene::new(&gpu.device, &gpu.queue, &script.stage.scene)?;
        let settings = Settings::adaptive();
        let mut film = Film::new(gpu, suite.size, settings.clone())?;
        let mut reference = Reference::new(gpu, suite.size, &settings)?;
        let mut moments: Vec<Moment> = Vec::new();
        let mut seen = None;
        let mut frames = Export::default();
        for index in suite.first()..suite.first() + suite.frames {
            let (pose, camera) = script.frame(index);
            move_to(gpu, &mut scene, &pose)?;
            tracing::render(&mut film, &scene, camera, index)?;
            let path = script.reference(&pose, &camera);
            let [converged, half] = match read_layers(&path, suite.size, ["", "half."]) {
                Ok(layers) => layers,
                // The file does not exist, or is unusable.
                Err(_) => {
                    let halves = converge(&mut reference, &scene, camera, suite.paths)?;
                    path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
                    write_layers(&path, suite.size, ["", "half."], &halves)?;
                    halves
                }
            };
            if let Some(folder) = export {
                frames.write(&folder.join(format!("frame_{index:04}.exr")), &mut film)?;
                let path = folder.join(format!("reference_{index:04}.exr"));
                write_exr_rgb(path, suite.size[0], suite.size[1], &converged)?;
            }
            let last = moments.last().zip(seen.as_ref());
            let (moment, now) = observe(&mut film, Moment::new(index, pose, camera, [converged, half]), last)?;
            moments.push(moment);
            seen = Some(now);
            done(1);
        }
        if let Some(folder) = export {
            let cameras: Vec<_> = moments.iter().map(|moment| moment.camera).collect();
            export::write_manifest(folder, suite.size, &cameras)?;
        }
        Ok(Self { scene, moments, hash: script.hash })
    }
}

impl Moment {
    fn new(index: u32, pose: Pose, camera: Camera, [reference, half]: [Vec<Rgb>; 2]) -> Self {
        Self { index, pose, camera, reference, half, counted: Vec::new(), steady: Vec::new(), ages: Vec::new() }
    }
}

/// Traces a reference: returns the mean of all paths, and that of their first half.
fn converge(
    reference: &mut Reference<'_>,
    scene: &GpuScene,
    camera: Camera,
    paths: u32,
) -> Result<[Vec<Rgb>; 2], asvgf::Error> {
    // All frames share their random numbers, so that a reference is independent of earlier tracing.
    reference.rewind();
    let mut half = || reference.converge(scene, camera, paths.div_ceil(2), |_| {});
    let (first, second) = (half()?, half()?);
    let mean = first.iter().zip(&second).map(|(a, b)| std::array::from_fn(|c| 0.5 * (a[c] + b[c])));
    Ok([mean.collect(), first])
}

/// Moves everything to its place in a frame.
pub fn move_to(gpu: &Gpu, scene: &mut GpuScene, pose: &Pose) -> Result<(), Box<dyn Error>> {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    scene.update(&gpu.device, &mut encoder, pose)?;
    gpu.queue.submit([encoder.finish()]);
    Ok(())
}

/// Images that distinguish surfaces.
struct Seen {
    depth: Vec<Rgb>,
    /// `None` if there is only one object.
    objects: Option<Vec<Rgb>>,
}

impl Seen {
    /// True if a point at the distance `depth` in the last frame is the surface that the pixel saw then.
    fn had(&self, pixel: usize, depth: f32) -> bool {
        (self.depth[pixel][0] - depth).abs() <= SAME_DEPTH * depth
    }
}

/// Classifies a frame's pixels, given the last frame.
fn observe(
    film: &mut Film<'_>,
    mut moment: Moment,
    last: Option<(&Moment, &Seen)>,
) -> Result<(Moment, Seen), Box<dyn Error>> {
    let size = film.denoiser.size();
    let emission = optional(film, View::Emission)?;
    let seen = Seen { depth: film.numbers(View::Depth)?, objects: optional(film, View::Object)? };
    let emits = |pixel: usize| emission.as_ref().is_some_and(|e| e[pixel].iter().any(|&x| x > 0.0));
    moment.counted = seen.depth.iter().enumerate().map(|(pixel, z)| z[0] > 0.0 && !emits(pixel)).collect();
    let Some((before, then)) = last else {
        moment.steady = vec![None; seen.depth.len()];
        moment.ages = vec![u32::MAX; seen.depth.len()];
        return Ok((moment, seen));
    };
    // Without an image of motion, nothing moves.
    let motion = optional(film, View::Motion)?;
    let moved = motion.unwrap_or_else(|| seen.depth.iter().map(|z| [0.0, 0.0, z[0]]).collect());
    let flat: Vec<_> = moved.iter().map(|m| [m[0], m[1]]).collect();
    let objects = seen.objects.as_ref().zip(then.objects.as_ref());
    let origins = metrics::origins(size, &flat, |pixel, origin| {
        objects.is_none_or(|(now, then)| now[pixel] == then[origin]) && then.had(origin, moved[pixel][2])
    })?;
    moment.ages = metrics::ages(&moment.reference, &before.reference, &origins, RELIT, Some(&before.ages))?;
    let steady = origins.iter().zip(&moment.ages).map(|(&origin, &age)| origin.filter(|_| age > 0));
    moment.steady = steady.collect();
    Ok((moment, seen))
}

/// Returns an image of the last frame, if there is one.
pub fn optional(film: &mut Film<'_>, view: View) -> Result<Option<Vec<Rgb>>, asvgf::Error> {
    match film.numbers(view) {
        Ok(numbers) => Ok(Some(numbers)),
        Err(asvgf::Error::NoView { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}

/// Reads R, G and B of a file.
pub fn read_colors(path: &Path, size: [u32; 2]) -> Result<Vec<Rgb>, Box<dyn Error>> {
    read_layers(path, size, [""]).map(|[colors]| colors)
}

/// Reads R, G and B of a file's layers.
fn read_layers<const N: usize>(path: &Path, size: [u32; 2], names: [&str; N]) -> Result<[Vec<Rgb>; N], Box<dyn Error>> {
    let image = read_exr(path)?;
    if [image.width, image.height] != size {
        return Err(format!("{}: is {}×{} pixels", path.display(), image.width, image.height).into());
    }
    let mut layers = [const { Vec::new() }; N];
    for (layer, name) in layers.iter_mut().zip(names) {
        let channel = |color| {
            let name = format!("{name}{color}");
            image.get(&name).ok_or_else(|| format!("{}: has no channel {name}", path.display()))
        };
        let (r, g, b) = (channel("R")?, channel("G")?, channel("B")?);
        *layer = (0..r.len()).map(|i| [r[i], g[i], b[i]]).collect();
    }
    Ok(layers)
}

/// Writes R, G and B of layers.
fn write_layers<const N: usize>(
    path: &Path,
    [width, height]: [u32; 2],
    names: [&str; N],
    layers: &[Vec<Rgb>; N],
) -> Result<(), ImageError> {
    let layers = names.into_iter().zip(layers);
    let channels = layers.flat_map(|(name, layer)| {
        ["R", "G", "B"].into_iter().enumerate().map(move |(c, color)| {
            let values = layer.iter().map(|pixel| pixel[c]).collect();
            (format!("{name}{color}"), values)
        })
    });
    write_exr(path, &Channels { width, height, channels: channels.collect() })
}
