//! A host whose renderer is a function: a wall in front of the camera, lit by a function of the case, one path per
//! pixel.
//!
//! Like other hosts' renderers, it repeats a path of the last frame in one pixel of nine, in this frame's light, and
//! hands the pairs in.

use crate::stability::common::gpu::gpu;
use crate::stability::common::images::{colors, upload};
use crate::stability::common::statistics::Rgb;
use asvgf::{
    Camera, Denoiser, DenoiserDescriptor, FilterSettings, Gloss, Gradient, Pairs, Settings, Shading, Surfaces, View,
    ViewOptions,
};
use wgpu::{TextureFormat, TextureView};

/// A path: its start, the source of its random numbers, and the frame of its light.
#[derive(Clone, Copy, Debug)]
pub struct Path {
    pub pixel: [u32; 2],
    pub seed: u32,
    pub frame: u32,
}

impl Path {
    /// Returns a random number of the path, 0…1 (SplitMix64 of the path and the draw).
    pub fn uniform(&self, draw: u64) -> f64 {
        let [x, y] = self.pixel.map(u64::from);
        let mut z = (x | y << 16 | u64::from(self.seed) << 32) ^ draw.wrapping_mul(0xd6e8_feb8_6659_fd93);
        for factor in [0xbf58_476d_1ce4_e5b9, 0x94d0_49bb_1331_11eb] {
            z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
            z = (z ^ (z >> 29)).wrapping_mul(factor);
        }
        ((z ^ (z >> 32)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Returns noise of mean 1: 0…2.
    pub fn noise(&self) -> f64 {
        2.0 * self.uniform(0)
    }
}

/// Returns a colour with the same value in each channel.
pub fn grey(value: f64) -> Rgb {
    [value as f32; 3]
}

/// Returns the default filter, with pairs handed in.
pub fn adaptive() -> Settings {
    with(FilterSettings::default())
}

/// Returns a filter with pairs handed in.
pub fn with(filter: FilterSettings) -> Settings {
    Settings { filter: FilterSettings { gradient: Gradient::Pairs, ..filter }, ..Settings::adaptive() }
}

/// A host's input as images on the CPU, which a case may spoil.
#[derive(Clone, Debug)]
pub struct Views {
    pub depth: Vec<[f32; 1]>,
    pub normal: Vec<Rgb>,
    pub motion: Vec<[f32; 2]>,
    pub previous_depth: Vec<[f32; 1]>,
    pub radiance: Vec<Rgb>,
    pub albedo: Vec<Rgb>,
    pub emission: Vec<Rgb>,
    pub pairs: [Vec<Rgb>; 2],
    /// Specular light, if it is a signal of its own.
    pub gloss: Option<GlossViews>,
}

/// A host's views of specular light.
#[derive(Clone, Debug)]
pub struct GlossViews {
    /// True if all light comes in one radiance: the specular radiance is not handed in.
    pub is_one_radiance: bool,
    pub radiance: Vec<Rgb>,
    pub reflectance: Vec<Rgb>,
    pub roughness: Vec<[f32; 1]>,
    pub hit_distance: Vec<[f32; 1]>,
    pub motion: Vec<[f32; 2]>,
    pub pairs: [Vec<Rgb>; 2],
}

pub struct Painted {
    pub denoiser: Denoiser,
    /// Number of the next frame.
    pub index: u32,
    pub camera: Camera,
    target: TextureView,
}

impl Painted {
    pub fn new(size: [u32; 2], settings: Settings) -> Self {
        let descriptor = DenoiserDescriptor { size, settings, diagnostics: true, views: true, ..Default::default() };
        Self {
            denoiser: Denoiser::new(&gpu().device, &gpu().queue, &descriptor).unwrap(),
            index: 0,
            camera: Camera::default(),
            target: gpu().target(size, TextureFormat::Rgba32Float),
        }
    }

    pub fn resize(&mut self, size: [u32; 2]) {
        self.denoiser.resize(&gpu().device, size).unwrap();
        self.target = gpu().target(size, TextureFormat::Rgba32Float);
    }

    fn pixels(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let [width, height] = self.denoiser.size();
        (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
    }

    /// Returns a light of the next frame: the radiance, and the pairs.
    fn paint(&self, light: &dyn Fn(&Path) -> Rgb) -> (Vec<Rgb>, [Vec<Rgb>; 2]) {
        let (index, before) = (self.index, self.index.wrapping_sub(1));
        // The choice goes around the stratum in steps of four places, as the denoiser's own does.
        let place = 4 * (index % 9) % 9;
        let repeats = |[x, y]: [u32; 2]| y % 3 * 3 + x % 3 == place;
        let own = |pixel| Path { pixel, seed: if repeats(pixel) { before } else { index }, frame: index };
        let pair = |frame: u32| {
            let of = |pixel| if repeats(pixel) { light(&Path { pixel, seed: before, frame }) } else { [-1.0; 3] };
            self.pixels().map(of).collect()
        };
        (self.pixels().map(|pixel| light(&own(pixel))).collect(), [pair(index), pair(before)])
    }

    /// Returns the next frame as a host would hand it in.
    pub fn views(&self, light: &dyn Fn(&Path) -> Rgb) -> Views {
        let (radiance, pairs) = self.paint(light);
        let count = radiance.len();
        Views {
            depth: vec![[2.0]; count],
            normal: vec![[0.0, 0.0, 1.0]; count],
            motion: vec![[0.0; 2]; count],
            previous_depth: vec![[2.0]; count],
            radiance,
            albedo: vec![[1.0; 3]; count],
            emission: vec![[0.0; 3]; count],
            pairs,
            gloss: None,
        }
    }

    /// Returns the next frame of a wall that shines: a roughness of 0.2 and a reflectance of ½, before things at the wall's
    /// own distance. The motion of the reflections is unknown.
    pub fn glossy_views(&self, diffuse: &dyn Fn(&Path) -> Rgb, specular: &dyn Fn(&Path) -> Rgb) -> Views {
        let (radiance, pairs) = self.paint(specular);
        let count = radiance.len();
        let gloss = GlossViews {
            is_one_radiance: false,
            radiance,
            reflectance: vec![[0.5; 3]; count],
            roughness: vec![[0.2]; count],
            hit_distance: vec![[2.0]; count],
            motion: vec![[f32::NAN; 2]; count],
            pairs,
        };
        Views { gloss: Some(gloss), ..self.views(diffuse) }
    }

    /// Filters a host's input.
    pub fn denoise(&mut self, views: &Views) -> Vec<Rgb> {
        let (gpu, size) = (gpu(), self.denoiser.size());
        let [depth, previous_depth] = [&views.depth, &views.previous_depth].map(|image| upload(gpu, size, image));
        let motion = upload(gpu, size, &views.motion);
        let [normal, radiance, albedo, emission, current, previous] =
            [&views.normal, &views.radiance, &views.albedo, &views.emission, &views.pairs[0], &views.pairs[1]]
                .map(|image| upload(gpu, size, image));
        let gloss = views.gloss.as_ref().map(|gloss| Uploaded::new(size, gloss));
        let surfaces = Surfaces {
            previous_depth: Some(&previous_depth),
            ..Surfaces::new(self.camera, self.index, &depth, &normal, &motion)
        };
        let shading = Shading {
            albedo: Some(&albedo),
            emission: Some(&emission),
            pairs: Some(Pairs { current: &current, previous: &previous, in_place: true }),
            gloss: gloss.as_ref().map(Uploaded::gloss),
            ..Shading::new(&radiance, &self.target)
        };
        gpu.submit(|encoder| {
            self.denoiser.begin_frame(&gpu.device, encoder, &surfaces).unwrap();
            self.denoiser.denoise(&gpu.device, encoder, &shading).unwrap();
        });
        self.index = self.index.wrapping_add(1);
        colors(gpu, &self.target)
    }

    /// Paints and filters the next frame.
    pub fn frame(&mut self, light: &dyn Fn(&Path) -> Rgb) -> Vec<Rgb> {
        let views = self.views(light);
        self.denoise(&views)
    }

    /// Paints and filters several frames, and returns the last.
    pub fn frames(&mut self, count: u32, light: &dyn Fn(&Path) -> Rgb) -> Vec<Rgb> {
        (0..count).map(|_| self.frame(light)).last().unwrap_or_default()
    }

    /// Returns an intermediate image of the last frame, as numbers.
    pub fn view(&mut self, view: View) -> Vec<Rgb> {
        let target = gpu().target(self.denoiser.size(), TextureFormat::Rgba32Float);
        gpu().submit(|e| self.denoiser.show(&gpu().device, e, view, ViewOptions::default(), &target)).unwrap();
        colors(gpu(), &target)
    }

    /// Returns the largest number of an intermediate image; infinite if one is not finite.
    pub fn largest(&mut self, view: View) -> f64 {
        let finite = |x: f32| if x.is_finite() { f64::from(x) } else { f64::INFINITY };
        self.view(view).iter().map(|c| finite(c[0])).fold(0.0, f64::max)
    }
}

/// A host's views of specular light on the GPU.
struct Uploaded {
    radiance: Option<TextureView>,
    reflectance: TextureView,
    roughness: TextureView,
    hit_distance: TextureView,
    motion: TextureView,
    pairs: [TextureView; 2],
}

impl Uploaded {
    fn new(size: [u32; 2], views: &GlossViews) -> Self {
        let color = |image: &Vec<Rgb>| upload(gpu(), size, image);
        Self {
            radiance: (!views.is_one_radiance).then(|| color(&views.radiance)),
            reflectance: color(&views.reflectance),
            roughness: upload(gpu(), size, &views.roughness),
            hit_distance: upload(gpu(), size, &views.hit_distance),
            motion: upload(gpu(), size, &views.motion),
            pairs: views.pairs.each_ref().map(color),
        }
    }

    fn gloss(&self) -> Gloss<'_> {
        let [current, previous] = &self.pairs;
        Gloss {
            radiance: self.radiance.as_ref(),
            reflectance: Some(&self.reflectance),
            roughness: Some(&self.roughness),
            hit_distance: Some(&self.hit_distance),
            motion: Some(&self.motion),
            pairs: Some(Pairs { current, previous, in_place: true }),
        }
    }
}
