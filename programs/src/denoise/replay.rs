//! Plays frames of a sequence on a film, forwards or backwards in time, as a host with its own renderer hands them in.

use crate::denoise::blend_in_time::Estimate;
use crate::denoise::clean_albedo::CleanAlbedo;
use crate::denoise::fixed_seed::{FixedSeed, repeats_noise};
use crate::denoise::inverted_motion::inverted;
use crate::denoise::lobes;
use crate::denoise::upload::Views;
use crate::film::Film;
use crate::sequence::camera::{Camera, Raster};
use crate::sequence::layers::Layer;
use crate::sequence::motion::{self, Matches};
use crate::sequence::{Pixels, Sequence};
use crate::times::PassTimes;
use asvgf::{Error, FilterSettings, Gloss, Gradient, Lambda, Pairs, Settings, Shading, Surfaces, View};

/// A frame to play, and its link to the one before.
pub struct Played<'a> {
    /// Its place in the sequence.
    pub index: usize,
    pub pixels: &'a Pixels,
    /// True if it continues the frame that was played before.
    pub continues: bool,
}

/// Result of a played frame.
pub struct Exposed {
    pub estimate: Estimate,
    /// Its layers as the filter had them.
    pub shown: Pixels,
    /// Motion to the frame that was played before, in pixels.
    pub motion: Vec<f32>,
    /// True if it did not continue that frame.
    pub begins: bool,
    pub times: PassTimes,
    /// True if it has the noise of the frame before, as did enough frames before it: it was denoised by itself.
    pub repeated: bool,
    /// True if hardly any of its surfaces was there in the frame before: it was denoised as the first of a shot.
    pub cut: bool,
    /// Matches along the motion, for all readings of the vectors. Empty if nothing was compared.
    pub readings: Vec<Matches>,
}

/// Plays frames in one direction of time.
pub struct Player<'a, 'g> {
    film: &'a mut Film<'g>,
    sequence: &'a Sequence,
    backwards: bool,
    last: Option<(usize, Pixels)>,
    seed: FixedSeed,
    /// Number of the next frame: the denoiser's numbers follow one another, whatever the files' numbers do.
    played: u32,
    albedo: CleanAlbedo<'g>,
    /// Film for surfaces whose albedo is noise.
    gloss: Option<Film<'g>>,
}

/// Part of lost surfaces, to which the motion does not lead, from which on a frame begins another shot. Fast motion
/// without vectors loses as much: its history is worthless as well.
const CUT: f64 = 0.95;

impl<'a, 'g> Player<'a, 'g> {
    pub fn new(film: &'a mut Film<'g>, sequence: &'a Sequence, backwards: bool) -> Self {
        let albedo = CleanAlbedo::new(film.gpu, sequence.size);
        Self { film, sequence, backwards, last: None, seed: FixedSeed::default(), played: 0, albedo, gloss: None }
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
        let cut = found.tells() && found.lost() >= CUT;
        let readings = match told.filter(|_| sequence.has(Layer::Motion) && !self.backwards) {
            Some((_, last)) => motion::readings(pixels, last, &motion, raster),
            None => Vec::new(),
        };
        let repeats = last.as_ref().is_some_and(|(_, last)| repeats_noise(last, pixels, raster.size[0], cameras));
        // All repeated frames are one sample: their average is no better, and only looks better.
        let repeated = self.seed.observe(repeats);
        let begins = last.is_none() || repeated || cut;
        if begins {
            self.film.denoiser.reset();
        }
        let mut shown = pixels.clone();
        lobes::split(&mut shown);
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

    /// Returns the camera of a frame. Without depths, everything is a wall in front of a camera at rest.
    fn camera(&self, index: usize) -> Camera {
        if self.sequence.has_surfaces() {
            self.sequence.camera(index)
        } else {
            Camera::at_rest(0.8, self.sequence.raster)
        }
    }

    /// Returns the motion from a frame to the one that was played before.
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

/// Returns the estimate of the last frame on a film.
fn estimate(film: &mut Film<'_>) -> Result<Estimate, Error> {
    let lengths = film.numbers(View::HistoryLength)?.into_iter().map(|[length, ..]| length).collect();
    Ok(Estimate { image: film.numbers(View::Denoised)?, lengths })
}

/// σ of the luminance stop on gloss.
const GLOSSY: f32 = 1.5;

/// Returns settings for surfaces that show others. Failure: the lamp in a metal sphere was blurred to twice its size.
/// Reason: reflections have borders of light that no guide knows, and less noise than diffuse light. Rule: a tighter
/// stop, and no plane through the light, because planes overshoot at such borders.
fn glossy(settings: &Settings) -> Settings {
    let sigma_luminance = settings.filter.sigma_luminance.min(GLOSSY);
    let filter = FilterSettings { sigma_luminance, local_linear_fit: false, ..settings.filter.clone() };
    Settings { filter, ..settings.clone() }
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
        let specular = [Layer::SpecularGradientCurrent, Layer::SpecularGradientPrevious].map(|layer| views.get(layer));
        let specular_pairs =
            specular[0].zip(specular[1]).map(|(current, previous)| Pairs { current, previous, in_place });
        let gloss = Gloss {
            radiance: views.get(Layer::Specular),
            reflectance: views.get(Layer::SpecularAlbedo),
            roughness: views.get(Layer::Roughness),
            hit_distance: views.get(Layer::HitDistance),
            motion: views.get(Layer::SpecularMotion),
            pairs: specular_pairs.filter(|_| gradient == Gradient::Pairs),
        };
        let shading = Shading {
            gloss: Some(gloss),
            albedo: views.get(Layer::Albedo),
            emission: views.get(Layer::Emission),
            pairs: pairs.filter(|_| gradient == Gradient::Pairs),
            lambda: lambda.filter(|_| gradient == Gradient::Lambda),
            ..Shading::new(required(Layer::Color)?, target)
        };
        let mut denoiser = denoiser.stepwise(after);
        denoiser.begin_frame(device, encoder, &surfaces)?;
        denoiser.denoise(device, encoder, &shading)
    })
}
