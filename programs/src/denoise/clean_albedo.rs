//! Denoises an albedo that is noisy itself, before the denoiser divides by it.
//!
//! Failure: Cycles' albedo of a metal is that of the one surface that each path saw in it, with zeros and values above
//! 10; light divided by it is noise of its own, and the metal of `blender_room` had twice the error. Reason: radiance
//! and albedo are two random numbers of one path, and the quotient of their means is smooth; the mean of their
//! quotients is not. Rule: if an albedo changes from frame to frame beyond the range around it, it is averaged as light
//! is, with tighter stops because its noise is less. An albedo that contradicts the light is not used at all.

use crate::denoise::grid::around;
use crate::denoise::parallel;
use crate::denoise::upload::upload;
use crate::film::Film;
use crate::gpu::Gpu;
use crate::sequence::Pixels;
use crate::sequence::camera::{Camera, Raster};
use crate::sequence::layers::Layer;
use crate::sequence::surfaces::{is_same, one, surfaces, three};
use asvgf::{Error, FilterSettings, Gradient, Settings, Shading, Surfaces, View};

/// σ of the luminance stop for an albedo.
const SIGMA_LUMINANCE: f32 = 1.0;

/// Pixels to each side of a splinter in which noise is counted.
const AROUND: usize = 3;

/// Number of pixels of a surface that may be off for any reason.
const FEW: u32 = 3;

/// Least number of neighbours with an albedo, of 8, that show a black pixel to be black by chance: a pixel of a line of
/// ink has two black neighbours.
const LONELY: usize = 7;

/// Parts of a surface's pixels that are off: its albedo counts as partly noise above the first, wholly above the
/// second. Independent noise is off in one pixel of five.
const NOISY: [f32; 2] = [0.01, 0.03];

/// Denoises the albedo of a sequence, if necessary.
pub struct CleanAlbedo<'g> {
    gpu: &'g Gpu,
    size: [u32; 2],
    film: Option<Film<'g>>,
    played: u32,
    /// True for each pixel of the last frame whose albedo was distrusted.
    distrusted: Vec<bool>,
}

/// The view of a frame, and its link to the last one.
struct Frame<'a> {
    camera: Camera,
    raster: Raster,
    motion: &'a [f32],
    continues: bool,
}

impl<'g> CleanAlbedo<'g> {
    pub fn new(gpu: &'g Gpu, size: [u32; 2]) -> Self {
        Self { gpu, size, film: None, played: 0, distrusted: Vec::new() }
    }

    /// Cleans a frame's albedo with the last frame's along the motion. Returns how far each pixel's was noise or wrong,
    /// 0…1, or nothing if all were right.
    pub fn clean(
        &mut self,
        now: &mut Pixels,
        last: Option<&Pixels>,
        motion: &[f32],
        camera: Camera,
        raster: Raster,
    ) -> Result<Vec<f32>, Error> {
        let Some(mut albedo) = now.get(Layer::Albedo).map(<[f32]>::to_vec) else { return Ok(Vec::new()) };
        fill_lone_black(now, &mut albedo, self.size);
        let surfaces = surfaces(now, self.size);
        let noise = noise(now, &albedo, last, motion, &surfaces, self.size);
        if self.film.is_none() && noise.iter().all(|&part| part <= NOISY[0]) {
            return Ok(self.distrust(now, albedo, motion, &surfaces, last.is_some()));
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
        let wrong = self.distrust(now, mixed, motion, &surfaces, last.is_some());
        Ok(weights
            .into_iter()
            .enumerate()
            .map(|(i, weight)| wrong.get(i).copied().unwrap_or_default().max(weight))
            .collect())
    }

    /// Gives a frame its albedo, except for surfaces whose albedo is wrong: returns 1 for those, 0 for others, or
    /// nothing if there are none.
    fn distrust(
        &mut self,
        now: &mut Pixels,
        mut albedo: Vec<f32>,
        motion: &[f32],
        surfaces: &[usize],
        continues: bool,
    ) -> Vec<f32> {
        let before = std::mem::take(&mut self.distrusted);
        let wrong = distrusted(now, &albedo, surfaces, |i| {
            let [x, y] = [0, 1].map(|k| {
                (if k == 0 { i as u32 % self.size[0] } else { i as u32 / self.size[0] }) as f32 + motion[2 * i + k]
            });
            let inside = x >= 0.0 && y >= 0.0 && x < self.size[0] as f32 - 0.5 && y < self.size[1] as f32 - 0.5;
            continues
                && inside
                && before.get(y.round() as usize * self.size[0] as usize + x.round() as usize) == Some(&true)
        });
        for (i, _) in wrong.iter().enumerate().filter(|(_, wrong)| **wrong) {
            albedo[3 * i..3 * i + 3].fill(1.0);
        }
        now.set(Layer::Albedo, Some(albedo));
        let any = wrong.contains(&true);
        let weights = wrong.iter().filter(|_| any).map(|&wrong| f32::from(u8::from(wrong))).collect();
        self.distrusted = wrong;
        weights
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
            let mut denoiser = denoiser.stepwise(after);
            denoiser.begin_frame(device, encoder, &surfaces)?;
            denoiser.denoise(device, encoder, &Shading::new(&color, target))
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

/// Gives a lone pixel that is lit although its albedo is black the albedo of its neighbours: light divided by almost
/// nothing would outshine them all.
fn fill_lone_black(pixels: &Pixels, albedo: &mut [f32], size: [u32; 2]) {
    let given: Vec<[f32; 3]> = albedo.as_chunks::<3>().0.to_vec();
    let size = size.map(|side| side as usize);
    let lit =
        |i: usize| three(pixels, Layer::Color, i).iter().sum::<f32>() > three(pixels, Layer::Emission, i).iter().sum();
    for i in (0..given.len()).filter(|&i| given[i].iter().all(|&x| x < BLACK) && lit(i)) {
        let around: Vec<usize> = around(size, i, 1).collect();
        let is_bright = |&&j: &&usize| is_same(pixels, i, pixels, j) && given[j].iter().any(|&x| x >= BLACK);
        let bright: Vec<[f32; 3]> = around.iter().filter(is_bright).map(|&j| given[j]).collect();
        // All pixels but itself and one more, at borders too.
        if bright.len() + 2 >= around.len() && !bright.is_empty() {
            let mean = |c: usize| bright.iter().map(|a| a[c]).sum::<f32>() / bright.len() as f32;
            albedo[3 * i..3 * i + 3].copy_from_slice(&[0, 1, 2].map(mean));
        }
    }
}

/// Returns for each pixel the part of its surface whose albedo is noise: a number outside 0…1, black amid brighter
/// pixels, or outside the range of the surface's 3×3 pixels in the last frame. A moving texture stays within that
/// range. The part is counted over the whole connected surface: where a metal shows a wall of one colour, no pixel
/// differs from others by chance, but paths do.
pub fn noise(
    pixels: &Pixels,
    albedo: &[f32],
    last: Option<&Pixels>,
    motion: &[f32],
    surfaces: &[usize],
    size: [u32; 2],
) -> Vec<f32> {
    let size = size.map(|side| side as usize);
    let [width, height] = size;
    let (now, _) = albedo.as_chunks::<3>();
    let is_same = |last: &Pixels, i: usize, j: usize| is_same(pixels, i, last, j);
    let is_off = |i: usize| {
        let a = now[i];
        // A light that reflects nothing is legitimately black.
        if three(pixels, Layer::Emission, i) != [0.0; 3] {
            return false;
        }
        if a.iter().any(|x| !x.is_finite() || *x > 1.05) {
            return true;
        }
        let lit = |j: usize| now[j] != [0.0; 3] && is_same(pixels, i, j);
        if a == [0.0; 3] && around(size, i, 1).filter(|&j| lit(j)).count() >= LONELY {
            return true;
        }
        let Some(last) = last else { return false };
        let place = [(i % width) as f32 + motion[2 * i], (i / width) as f32 + motion[2 * i + 1]].map(f32::round);
        if !(place[0] >= 0.0 && place[1] >= 0.0 && place[0] < width as f32 && place[1] < height as f32) {
            return false;
        }
        let (mut low, mut high, mut count) = ([f32::MAX; 3], [f32::MIN; 3], 0);
        let there = place[1] as usize * width + place[0] as usize;
        for j in around(size, there, 1).filter(|&j| is_same(last, i, j)) {
            let there = three(last, Layer::Albedo, j);
            low = std::array::from_fn(|c| low[c].min(there[c]));
            high = std::array::from_fn(|c| high[c].max(there[c]));
            count += 1;
        }
        // 2 % allow for rounding and for sampling between pixels. With fewer than all nine pixels, the range may miss
        // values in between.
        count == 9 && (0..3).any(|c| a[c] < 0.98 * low[c] - 0.02 || a[c] > 1.02 * high[c] + 0.02)
    };
    let off = parallel::map(now.len(), is_off);
    let mut counts = vec![[0_u32; 2]; now.len()];
    for (&surface, &off) in surfaces.iter().zip(&off) {
        counts[surface][0] += 1;
        counts[surface][1] += u32::from(off);
    }
    // A splinter, such as the rim of a sphere, is judged by its surroundings.
    let nearby = |i: usize| {
        let (count, off) = around(size, i, AROUND).fold((0, 0), |(n, sum), j| (n + 1, sum + u32::from(off[j])));
        off as f32 / count as f32
    };
    let part = |i: usize| match counts[surfaces[i]] {
        [size, _] if size < SPLINTER => nearby(i),
        [size, off] => off.saturating_sub(FEW) as f32 / size as f32,
    };
    (0..now.len()).map(part).collect()
}

/// Pixels below which a surface is a splinter.
const SPLINTER: u32 = 32;

/// Albedo that the filter ignores.
const BLACK: f32 = 0.02;

/// Part of a surface's light that comes from pixels with a black albedo: above the first, the albedo is distrusted;
/// below the second, trusted again.
const BELIED: [f32; 2] = [0.25, 0.1];

/// Finds the pixels whose albedo contradicts the light. Failure: Mitsuba's albedo of a metal sphere is 0 where it
/// reflects a room, and 10 in its middle; light divided by it was 50 times too bright at the rim, and spread from
/// there. Reason: an albedo that does not follow the light makes differences instead of removing them. Rule: a surface
/// that sends a quarter of its light from pixels with a black albedo is filtered undivided.
fn distrusted(pixels: &Pixels, albedo: &[f32], surfaces: &[usize], before: impl Fn(usize) -> bool) -> Vec<bool> {
    let (albedo, _) = albedo.as_chunks::<3>();
    let light = |i: usize| {
        let [color, emission] = [three(pixels, Layer::Color, i), three(pixels, Layer::Emission, i)];
        let light: f32 = (0..3).map(|c| (color[c] - emission[c]).max(0.0)).sum();
        if light.is_finite() { f64::from(light) } else { 0.0 }
    };
    // Sums of each surface: all light, light from black pixels, pixels, and pixels that were distrusted before.
    let mut sums = vec![[0.0_f64; 4]; surfaces.len()];
    for (i, &surface) in surfaces.iter().enumerate().filter(|(i, _)| one(pixels, Layer::Depth, *i) > 0.0) {
        let light = light(i);
        let black = albedo[i].iter().all(|&x| x < BLACK);
        let terms = [light, if black { light } else { 0.0 }, 1.0, f64::from(u8::from(before(i)))];
        sums[surface].iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
    }
    let is_wrong = |&[light, black, count, before]: &[f64; 4]| {
        let limit = BELIED[usize::from(2.0 * before > count)];
        count >= f64::from(SPLINTER) && black > f64::from(limit) * light
    };
    let wrong: Vec<bool> = sums.iter().map(is_wrong).collect();
    surfaces.iter().map(|&surface| wrong[surface]).collect()
}
