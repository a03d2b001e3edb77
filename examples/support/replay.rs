//! Frames of a sequence on a film, as a host with a renderer of its own hands them in, forwards or backwards in time.

use crate::blend_in_time::Estimate;
use crate::camera::{Camera, Raster};
use crate::clean_albedo::CleanAlbedo;
use crate::film::Film;
use crate::gpu::Gpu;
use crate::parallel;
use crate::sequence::layers::Layer;
use crate::sequence::motion::{self, Matches};
use crate::sequence::{Pixels, Sequence};
use crate::times::PassTimes;
use asvgf::wgpu::{self, TextureFormat, TextureUsages, TextureView};
use asvgf::{Error, FilterSettings, Gradient, Lambda, Pairs, Settings, Shading, Surfaces, View};

/// A frame that is played, and how it follows the one before.
pub struct Played<'a> {
    /// Its place in the sequence.
    pub index: usize,
    pub pixels: &'a Pixels,
    /// Whether it continues the frame that was played before.
    pub continues: bool,
}

/// What became of a frame.
pub struct Exposed {
    pub estimate: Estimate,
    /// Its layers as the filter had them.
    pub shown: Pixels,
    /// To the frame that was played before, in pixels.
    pub motion: Vec<f32>,
    /// It did not continue that frame.
    pub begins: bool,
    pub times: PassTimes,
    /// It has the noise of the frame before, as so many before it: it was denoised by itself.
    pub repeated: bool,
    /// Hardly any of its surfaces was there in the frame before: it was denoised as the first of a shot.
    pub cut: bool,
    /// Where motion leads, by all readings of it. Empty if there is nothing to tell.
    pub readings: Vec<Matches>,
}

/// Plays frames in one direction of time.
pub struct Player<'a, 'g> {
    film: &'a mut Film<'g>,
    sequence: &'a Sequence,
    backwards: bool,
    last: Option<(usize, Pixels)>,
    seed: FixedSeed,
    /// The number of the next frame: the denoiser's numbers follow one another, whatever those of the files do.
    played: u32,
    albedo: CleanAlbedo<'g>,
    /// For surfaces whose albedo is noise.
    gloss: Option<Film<'g>>,
}

/// Whether a renderer takes the same random numbers in each frame, as those with a fixed seed do. One frame that is held tells
/// nothing; two in a row do, until two in a row differ: a light may change in between.
#[derive(Default)]
struct FixedSeed {
    fixed: bool,
    same: u32,
    other: u32,
}

impl FixedSeed {
    fn observe(&mut self, repeats: bool) -> bool {
        (self.same, self.other) = if repeats { (self.same + 1, 0) } else { (0, self.other + 1) };
        self.fixed = if self.fixed { self.other < 2 } else { self.same >= 2 };
        self.fixed
    }
}

/// Part of the surfaces that are not where motion leads, from which on a frame begins another shot. Fast motion without vectors loses
/// as much: then a history is worth nothing either.
const CUT: f64 = 0.95;

impl<'a, 'g> Player<'a, 'g> {
    pub fn new(film: &'a mut Film<'g>, sequence: &'a Sequence, backwards: bool) -> Self {
        let albedo = CleanAlbedo::new(film.gpu, sequence.size);
        Self {
            film,
            sequence,
            backwards,
            last: None,
            seed: FixedSeed::default(),
            played: sequence.files[0].number,
            albedo,
            gloss: None,
        }
    }

    pub fn film(&mut self) -> &mut Film<'g> {
        self.film
    }

    /// Denoises a frame and waits for it.
    pub fn play(&mut self, frame: &Played<'_>) -> Result<Exposed, Error> {
        let Played { index, pixels, .. } = *frame;
        let (sequence, raster) = (self.sequence, self.sequence.raster);
        let last = self.last.take().filter(|_| frame.continues);
        let before = last.as_ref().map_or(index, |(index, _)| *index);
        let cameras = [index, before].map(|index| self.camera(index));
        let motion = self.motion(pixels, last.as_ref().map(|(_, last)| last), cameras);
        let at = |i: usize| Some([motion[2 * i], motion[2 * i + 1]]).filter(|m| m.iter().all(|x| x.is_finite()));
        let told = last.as_ref().filter(|_| sequence.has_surfaces());
        let found = told.map_or(Matches::default(), |(_, last)| motion::matches(pixels, last, raster, false, at));
        let cut = found.compared > 0 && found.lost() >= CUT;
        let readings = match told.filter(|_| sequence.has(Layer::Motion) && !self.backwards) {
            Some((_, last)) => motion::readings(pixels, last, &motion, raster),
            None => Vec::new(),
        };
        let repeats = last.as_ref().is_some_and(|(_, last)| repeats_noise(last, pixels, raster.size[0], cameras));
        // Such frames are one sample, however many there are: an average of them is no better, and looks as if it were.
        let repeated = self.seed.observe(repeats);
        let begins = last.is_none() || repeated || cut;
        if begins {
            self.film.denoiser.reset();
        }
        let mut shown = pixels.clone();
        let known = last.as_ref().filter(|_| !begins).map(|(_, last)| last);
        let noise = self.albedo.clean(&mut shown, known, &motion, cameras[0], raster)?;
        let views = Views::new(self.film.gpu, sequence, &shown, &motion, self.backwards);
        let times = expose(self.film, &views, cameras[0], raster, self.played, sequence.in_place)?;
        let mut estimate = estimate(self.film)?;
        if self.gloss.is_some() || noise.iter().any(|&part| part > 0.0) {
            let mut film = match self.gloss.take() {
                Some(film) => film,
                None => Film::new(self.film.gpu, sequence.size, glossy(self.film.denoiser.settings()))?,
            };
            if begins {
                film.denoiser.reset();
            }
            expose(&mut film, &views, cameras[0], raster, self.played, sequence.in_place)?;
            estimate.mix(&self::estimate(&mut film)?, &noise);
            self.gloss = Some(film);
        }
        self.played += 1;
        self.last = Some((index, pixels.clone()));
        Ok(Exposed { estimate, shown, motion, begins, times, repeated, cut, readings })
    }

    /// The camera of a frame. Without depths, all is a wall in front of one that rests.
    fn camera(&self, index: usize) -> Camera {
        if self.sequence.has_surfaces() {
            self.sequence.camera(index)
        } else {
            Camera::at_rest(0.8, self.sequence.raster)
        }
    }

    /// The motion from a frame to the one that was played before.
    fn motion(&self, now: &Pixels, last: Option<&Pixels>, cameras: [Camera; 2]) -> Vec<f32> {
        let size = self.sequence.size;
        let given = if self.backwards {
            last.and_then(|next| next.get(Layer::Motion)).map(|motion| inverted(motion, size))
        } else {
            now.get(Layer::Motion).map(<[f32]>::to_vec)
        };
        if let Some(motion) = given {
            return motion;
        }
        let raster = self.sequence.raster;
        let pixel = |i: usize| [i as u32 % size[0], i as u32 / size[0]];
        let [camera, before] = cameras;
        let at_rest = |(i, &z): (usize, &f32)| camera.motion_to(&before, pixel(i), z.into(), raster).map(|m| m as f32);
        now.get(Layer::Depth).unwrap_or_default().iter().enumerate().flat_map(at_rest).collect()
    }
}

/// What the last frame on a film became.
fn estimate(film: &mut Film<'_>) -> Result<Estimate, Error> {
    let lengths = film.numbers(View::HistoryLength)?.into_iter().map(|[length, ..]| length).collect();
    Ok(Estimate { image: film.numbers(View::Denoised)?, lengths })
}

/// σ of the luminance stop on gloss.
const GLOSSY: f32 = 1.5;

/// Settings for surfaces that show others. Failure: the lamp in a metal sphere was blurred to twice its size. Reason: what they show has borders of light that no
/// guide knows, and noise that is less than that of diffuse light. Rule: a tighter stop, and no plane through the light, which overshoots at such borders.
fn glossy(settings: &Settings) -> Settings {
    let sigma_luminance = settings.filter.sigma_luminance.min(GLOSSY);
    let filter = FilterSettings { sigma_luminance, local_linear_fit: false, ..settings.filter.clone() };
    Settings { filter, ..settings.clone() }
}

/// Rounds in which a motion is inverted.
const ROUNDS: usize = 6;

/// The motion to the next frame, n, of the motion m from there: what is at p now is at p + n then, so that n(p) = −m(p + n(p)), solved by
/// iteration from n = −m.
pub fn inverted(motion: &[f32], [width, height]: [u32; 2]) -> Vec<f32> {
    let (m, _) = motion.as_chunks::<2>();
    let finite = |m: [f32; 2]| m.map(|x| if x.is_finite() { x } else { 0.0 });
    let at = |x: i64, y: i64| {
        let (x, y) = (x.clamp(0, i64::from(width) - 1), y.clamp(0, i64::from(height) - 1));
        finite(m[y as usize * width as usize + x as usize])
    };
    let bilinear = |x: f32, y: f32| {
        let (left, top) = (x.floor(), y.floor());
        let (u, v) = (x - left, y - top);
        let (left, top) = (left as i64, top as i64);
        let [a, b, c, d] = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| at(left + i, top + j));
        [0, 1].map(|k| (a[k] * (1.0 - u) + b[k] * u) * (1.0 - v) + (c[k] * (1.0 - u) + d[k] * u) * v)
    };
    let invert = |i: usize| {
        let (x, y) = ((i as u32 % width) as f32, (i as u32 / width) as f32);
        let mut n = finite(m[i]).map(|c| -c);
        for _ in 0..ROUNDS {
            n = bilinear(x + n[0], y + n[1]).map(|c| -c);
        }
        n
    };
    parallel::map(m.len(), invert).into_iter().flatten().collect()
}

/// Pixels at rest that have to show the same noise, of those with light, before it is taken to be repeated.
const REPEATED: f32 = 0.5;

/// Fewest pixels at rest that tell anything.
const FEWEST: usize = 64;

/// Difference of a pixel to the mean of its neighbours, over that mean, from which on it is noise.
const NOISY: f32 = 0.05;

/// Whether a frame has the random numbers of the last one, as those of renderers with a fixed seed have: then what is at rest shows
/// the same noise to the last bit.
fn repeats_noise(last: &Pixels, now: &Pixels, width: u32, [camera, before]: [Camera; 2]) -> bool {
    let radiance = |pixels| Pixels::get(pixels, Layer::Color).unwrap_or_default();
    let (was, is) = (radiance(last), radiance(now));
    let depth = now.get(Layer::Depth).unwrap_or_default();
    let motion = now.get(Layer::Motion);
    let rests = |i: usize| match motion {
        Some(motion) => motion[2 * i].abs().max(motion[2 * i + 1].abs()) < 1e-3,
        None => camera == before,
    };
    let brightness = |i: usize| is[3 * i..3 * i + 3].iter().sum::<f32>();
    // Between two neighbours in a row; an image without noise may well stay what it is.
    let is_noisy = |i: usize| {
        let column = i as u32 % width;
        let inside = column > 0 && column + 1 < width;
        let around = if inside { 0.5 * (brightness(i - 1) + brightness(i + 1)) } else { brightness(i) };
        (brightness(i) - around).abs() > NOISY * around
    };
    let (mut counted, mut same, mut noisy) = (0, 0, 0);
    for (i, (a, b)) in was.chunks_exact(3).zip(is.chunks_exact(3)).enumerate() {
        if depth[i] > 0.0 && rests(i) && b.iter().any(|x| *x != 0.0) {
            counted += 1;
            same += usize::from(a == b);
            noisy += usize::from(is_noisy(i));
        }
    }
    let most = REPEATED * counted as f32;
    counted >= FEWEST && same as f32 > most && noisy as f32 > most
}

/// A frame's layers on the GPU.
struct Views {
    views: Vec<Option<TextureView>>,
    motion: TextureView,
}

impl Views {
    /// Uploads a frame. Backwards, what is known of the last frame is of the next one here, and left out.
    fn new(gpu: &Gpu, sequence: &Sequence, pixels: &Pixels, motion: &[f32], backwards: bool) -> Self {
        let size = sequence.size;
        let forwards = |layer: Layer| {
            !matches!(
                layer,
                Layer::PreviousDepth | Layer::GradientCurrent | Layer::GradientPrevious | Layer::Lambda | Layer::Motion
            ) || (layer == Layer::PreviousDepth && !sequence.has_surfaces())
        };
        let wanted = |layer: Layer| !backwards || forwards(layer);
        let mut views = Layer::ALL.map(|layer| {
            let samples = pixels.get(layer).filter(|_| wanted(layer) && layer != Layer::Motion);
            samples.map(|samples| upload(gpu, size, layer, samples))
        });
        let (depth, albedo) = surfaces(pixels, size);
        views[Layer::Depth as usize] = Some(upload(gpu, size, Layer::Depth, &depth));
        views[Layer::Albedo as usize] = albedo.map(|albedo| upload(gpu, size, Layer::Albedo, &albedo));
        Self { views: views.into(), motion: upload(gpu, size, Layer::Motion, motion) }
    }

    fn get(&self, layer: Layer) -> Option<&TextureView> {
        self.views[layer as usize].as_ref()
    }
}

/// Denoises a frame and waits for it.
fn expose(
    film: &mut Film<'_>,
    views: &Views,
    camera: Camera,
    raster: Raster,
    number: u32,
    in_place: bool,
) -> Result<PassTimes, Error> {
    let device = &film.gpu.device;
    film.expose(|denoiser, encoder, target, after| {
        let missing = |view| Error::ViewMissing { view, setting: "a sequence", remedy: "add the layer to its frames" };
        let required = |layer: Layer| views.get(layer).ok_or_else(|| missing(layer.name()));
        let gradient = denoiser.settings().filter.gradient;
        let camera = camera.viewpoint(raster);
        let (depth, normal) = (required(Layer::Depth)?, required(Layer::Normal)?);
        let surfaces = Surfaces {
            previous_depth: views.get(Layer::PreviousDepth),
            instance: views.get(Layer::Id),
            ..Surfaces::new(camera, number, depth, normal, &views.motion)
        };
        let pairs = views.get(Layer::GradientCurrent).zip(views.get(Layer::GradientPrevious));
        let pairs = pairs.map(|(current, previous)| Pairs { current, previous, in_place });
        let lambda = views.get(Layer::Lambda).map(|view| Lambda { view, block: 1, confidence: false });
        let shading = Shading {
            albedo: views.get(Layer::Albedo),
            emission: views.get(Layer::Emission),
            pairs: pairs.filter(|_| gradient == Gradient::Pairs),
            lambda: lambda.filter(|_| gradient == Gradient::Lambda),
            ..Shading::new(required(Layer::Color)?, target)
        };
        denoiser.begin_frame_stepwise(device, encoder, &surfaces, &mut *after)?;
        denoiser.denoise_stepwise(device, encoder, &shading, after)
    })
}

/// The depths and albedos of what is to be filtered. A light that reflects nothing is not: its zeros would darken what lies beside
/// it. What glows and is lit although its albedo is 0, as a mirror is where that is the diffuse one, is filtered undivided.
fn surfaces(pixels: &Pixels, [width, height]: [u32; 2]) -> (Vec<f32>, Option<Vec<f32>>) {
    let mut depths = pixels.get(Layer::Depth).unwrap_or_default().to_vec();
    let layers = (pixels.get(Layer::Albedo), pixels.get(Layer::Emission), pixels.get(Layer::Color));
    let (Some(albedo), Some(emission), Some(color)) = layers else {
        return (depths, layers.0.map(<[f32]>::to_vec));
    };
    let mut albedos = albedo.to_vec();
    let black = |i: usize| albedo[3 * i..3 * i + 3] == [0.0; 3];
    let sum = |image: &[f32], i: usize| image[3 * i..3 * i + 3].iter().sum::<f32>();
    for i in (0..depths.len()).filter(|&i| black(i) && sum(emission, i) != 0.0) {
        // Of pixels like it around, as one path alone may have found nothing.
        let (x, y) = ((i as u32 % width) as i32, (i as u32 / width) as i32);
        let near = |at: i32, size: u32| (at - AROUND).max(0)..=(at + AROUND).min(size as i32 - 1);
        let (mut light, mut emitted) = (0.0, 0.0);
        for j in near(y, height).flat_map(|y| near(x, width).map(move |x| (y * width as i32 + x) as usize)) {
            if black(j) {
                light += (sum(color, j) - sum(emission, j)).max(0.0);
                emitted += sum(emission, j);
            }
        }
        if light <= REFLECTED * emitted {
            depths[i] = 0.0;
        } else {
            albedos[3 * i..3 * i + 3].fill(1.0);
        }
    }
    (depths, Some(albedos))
}

/// Pixels to each side.
const AROUND: i32 = 2;

/// Part of the emission beyond which what comes with it is light, not rounding.
const REFLECTED: f32 = 0.02;

/// A layer as a texture of 32-bit floats. Three channels get a fourth, as there are no textures of three.
pub fn upload(gpu: &Gpu, size: [u32; 2], layer: Layer, samples: &[f32]) -> TextureView {
    let components = layer.components().len();
    let padded: Vec<f32>;
    let (format, texels) = match components {
        1 => (TextureFormat::R32Float, samples),
        2 => (TextureFormat::Rg32Float, samples),
        _ => {
            padded = samples.chunks_exact(3).flat_map(|c| [c[0], c[1], c[2], 0.0]).collect();
            (TextureFormat::Rgba32Float, padded.as_slice())
        }
    };
    let extent = wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(layer.name()),
        size: extent,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let bytes: Vec<u8> = texels.iter().flat_map(|x| x.to_le_bytes()).collect();
    let row = size[0] * 4 * components.next_power_of_two() as u32;
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    gpu.queue.write_texture(texture.as_image_copy(), &bytes, layout, extent);
    texture.create_view(&Default::default())
}
