//! An albedo that is noisy itself, denoised before it divides.
//!
//! Failure: Cycles' albedo of a metal is that of what one path saw in it, with zeros and values above 10; light over that is noise of its own, and
//! the metal of `blender_room` had twice the error. Reason: radiance and albedo are two random numbers of one path, and the quotient of their means is the smooth
//! thing, not the mean of their quotients. Rule: where an albedo changes from frame to frame beyond what lies around it, it is averaged as light is,
//! with stops that are tighter because its noise is less.

use crate::camera::{Camera, Raster, dot};
use crate::film::Film;
use crate::gpu::Gpu;
use crate::parallel;
use crate::replay::upload;
use crate::sequence::Pixels;
use crate::sequence::layers::Layer;
use asvgf::{Error, FilterSettings, Gradient, Settings, Shading, Surfaces, View};

/// σ of the luminance stop for an albedo.
const SIGMA_LUMINANCE: f32 = 1.0;

/// Pixels to each side of a splinter over which noise is counted.
const AROUND: usize = 3;

/// Pixels of a surface that may be off for any reason.
const FEW: u32 = 3;

/// Of the 8 neighbours of a black pixel, those with an albedo that make it one by chance: a pixel of a line of ink has two black ones.
const LONELY: usize = 7;

/// Part of a surface that is off, from which on its albedo is noise in part, and wholly. Independent noise is off in one pixel of five.
const NOISY: [f32; 2] = [0.01, 0.03];

/// Denoises the albedo of a sequence, if there is any need.
pub struct CleanAlbedo<'g> {
    gpu: &'g Gpu,
    size: [u32; 2],
    film: Option<Film<'g>>,
    played: u32,
}

/// How a frame is seen, and how it follows the last one.
struct Frame<'a> {
    camera: Camera,
    raster: Raster,
    motion: &'a [f32],
    continues: bool,
}

impl<'g> CleanAlbedo<'g> {
    pub fn new(gpu: &'g Gpu, size: [u32; 2]) -> Self {
        Self { gpu, size, film: None, played: 0 }
    }

    /// Cleans a frame's albedo, with what the last frame's was along the motion. Returns how far each pixel's was noise, 0…1, or nothing where none was.
    pub fn clean(
        &mut self,
        now: &mut Pixels,
        last: Option<&Pixels>,
        motion: &[f32],
        camera: Camera,
        raster: Raster,
    ) -> Result<Vec<f32>, Error> {
        let Some(albedo) = now.get(Layer::Albedo).map(<[f32]>::to_vec) else { return Ok(Vec::new()) };
        let noise = noise(now, &albedo, last, motion, self.size);
        if self.film.is_none() && noise.iter().all(|&part| part <= NOISY[0]) {
            return Ok(Vec::new());
        }
        let view = Frame { camera, raster, motion, continues: last.is_some() };
        let clean = self.denoise(now, &albedo, &view)?;
        let weights: Vec<f32> =
            noise.into_iter().map(|part| ((part - NOISY[0]) / (NOISY[1] - NOISY[0])).clamp(0.0, 1.0)).collect();
        let mixed = albedo.as_chunks::<3>().0.iter().zip(&clean).zip(&weights).flat_map(|((given, clean), &weight)| {
            let given = given.map(|x| if x.is_finite() { x } else { 1.0 });
            std::array::from_fn::<f32, 3, _>(|c| given[c] + weight * (clean[c] - given[c]))
        });
        let mixed = mixed.collect();
        now.set(Layer::Albedo, Some(mixed));
        Ok(weights)
    }

    fn denoise(&mut self, now: &Pixels, albedo: &[f32], frame: &Frame<'_>) -> Result<Vec<[f32; 3]>, Error> {
        let mut film = match self.film.take() {
            Some(film) => film,
            None => Film::new(self.gpu, self.size, settings())?,
        };
        if !frame.continues {
            film.denoiser.reset();
        }
        let texture = |layer: Layer, samples: &[f32]| upload(self.gpu, self.size, layer, samples);
        let given = |layer: Layer| now.get(layer).map(|samples| texture(layer, samples));
        let depth = texture(Layer::Depth, now.get(Layer::Depth).unwrap_or_default());
        let normal = texture(Layer::Normal, now.get(Layer::Normal).unwrap_or_default());
        let (motion, color, id) =
            (texture(Layer::Motion, frame.motion), texture(Layer::Albedo, albedo), given(Layer::Id));
        let (device, number) = (&self.gpu.device, self.played);
        film.expose(|denoiser, encoder, target, after| {
            let camera = frame.camera.viewpoint(frame.raster);
            let surfaces =
                Surfaces { instance: id.as_ref(), ..Surfaces::new(camera, number, &depth, &normal, &motion) };
            denoiser.begin_frame_stepwise(device, encoder, &surfaces, &mut *after)?;
            denoiser.denoise_stepwise(device, encoder, &Shading::new(&color, target), after)
        })?;
        self.played += 1;
        let clean = film.numbers(View::Denoised)?;
        self.film = Some(film);
        Ok(clean)
    }
}

fn settings() -> Settings {
    let filter = FilterSettings {
        gradient: Gradient::Statistics,
        sigma_luminance: SIGMA_LUMINANCE,
        outlier_limit: 0.0,
        ..FilterSettings::default()
    };
    Settings { filter, ..Settings::adaptive() }
}

/// Of each pixel, the part of its surface whose albedo is noise: not a number of 0…1, black in the middle of what is not, or not within what the 3×3 pixels of
/// the surface were in the last frame. A texture that moves stays within them. Of the whole surface that is seen in one piece: where a metal shows a wall
/// of one colour, no pixel differs from others by chance, but paths do.
pub fn noise(
    pixels: &Pixels,
    albedo: &[f32],
    last: Option<&Pixels>,
    motion: &[f32],
    [width, height]: [u32; 2],
) -> Vec<f32> {
    let [width, height] = [width, height].map(|side| side as usize);
    let (now, _) = albedo.as_chunks::<3>();
    let is_same = |last: &Pixels, i: usize, j: usize| {
        let normals = [three(pixels, Layer::Normal, i), three(last, Layer::Normal, j)].map(|n| n.map(f64::from));
        one(pixels, Layer::Id, i) == one(last, Layer::Id, j)
            && (one(last, Layer::Depth, j) / one(pixels, Layer::Depth, i) - 1.0).abs() < 0.1
            && dot(normals[0], normals[1]) > 0.8
    };
    let is_off = |i: usize| {
        let a = now[i];
        // A light that reflects nothing is black by itself.
        if three(pixels, Layer::Emission, i) != [0.0; 3] {
            return false;
        }
        if a.iter().any(|x| !x.is_finite() || *x > 1.05) {
            return true;
        }
        let near = |at: usize, side: usize| at.saturating_sub(1)..=(at + 1).min(side - 1);
        let around = || near(i / width, height).flat_map(|y| near(i % width, width).map(move |x| y * width + x));
        let lit = |j: usize| now[j] != [0.0; 3] && is_same(pixels, i, j);
        if a == [0.0; 3] && around().filter(|&j| lit(j)).count() >= LONELY {
            return true;
        }
        let Some(last) = last else { return false };
        let place = [(i % width) as f32 + motion[2 * i], (i / width) as f32 + motion[2 * i + 1]].map(f32::round);
        if !(place[0] >= 0.0 && place[1] >= 0.0 && place[0] < width as f32 && place[1] < height as f32) {
            return false;
        }
        let (mut low, mut high, mut count) = ([f32::MAX; 3], [f32::MIN; 3], 0);
        for y in near(place[1] as usize, height) {
            for x in near(place[0] as usize, width).filter(|x| is_same(last, i, y * width + x)) {
                let there = three(last, Layer::Albedo, y * width + x);
                low = std::array::from_fn(|c| low[c].min(there[c]));
                high = std::array::from_fn(|c| high[c].max(there[c]));
                count += 1;
            }
        }
        // 2 % of rounding and of sampling between pixels. Fewer than all may miss what lies between.
        count == 9 && (0..3).any(|c| a[c] < 0.98 * low[c] - 0.02 || a[c] > 1.02 * high[c] + 0.02)
    };
    let off = parallel::map(now.len(), is_off);
    let surfaces = surfaces(width, now.len(), |i, j| is_same(pixels, i, j));
    let mut counts = vec![[0_u32; 2]; now.len()];
    for (&surface, &off) in surfaces.iter().zip(&off) {
        counts[surface][0] += 1;
        counts[surface][1] += u32::from(off);
    }
    // What is seen in splinters, as the rim of a sphere, is judged by what lies around it.
    let around = |i: usize| {
        let near = |at: usize, side: usize| at.saturating_sub(AROUND)..=(at + AROUND).min(side - 1);
        let pixels = near(i / width, height).flat_map(|y| near(i % width, width).map(move |x| y * width + x));
        let (count, off) = pixels.fold((0, 0), |(n, sum), j| (n + 1, sum + u32::from(off[j])));
        off as f32 / count as f32
    };
    let part = |i: usize| match counts[surfaces[i]] {
        [size, _] if size < SPLINTER => around(i),
        [size, off] => off.saturating_sub(FEW) as f32 / size as f32,
    };
    (0..now.len()).map(part).collect()
}

/// Pixels below which a surface is a splinter.
const SPLINTER: u32 = 32;

/// Of each pixel, the first pixel of the surface that it is part of: neighbours in a row or a column that are the same one are connected.
fn surfaces(width: usize, count: usize, is_same: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    fn root(parents: &mut [usize], mut i: usize) -> usize {
        while parents[i] != i {
            parents[i] = parents[parents[i]];
            i = parents[i];
        }
        i
    }
    let mut parents: Vec<usize> = (0..count).collect();
    for i in 0..count {
        let left = (!i.is_multiple_of(width)).then(|| i - 1);
        for j in [left, i.checked_sub(width)].into_iter().flatten().filter(|&j| is_same(i, j)) {
            let (a, b) = (root(&mut parents, i), root(&mut parents, j));
            parents[a.max(b)] = a.min(b);
        }
    }
    (0..count).map(|i| root(&mut parents, i)).collect()
}

/// A layer's number in a pixel, 0 if there is none.
fn one(pixels: &Pixels, layer: Layer, i: usize) -> f32 {
    pixels.get(layer).and_then(|samples| samples.get(i).copied()).unwrap_or_default()
}

/// A layer's three numbers in a pixel.
fn three(pixels: &Pixels, layer: Layer, i: usize) -> [f32; 3] {
    let samples = pixels.get(layer).unwrap_or_default();
    std::array::from_fn(|c| samples.get(3 * i + c).copied().unwrap_or_default())
}
