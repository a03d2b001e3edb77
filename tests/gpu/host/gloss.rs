//! A host that hands in specular light apart, or tells where its surfaces are glossy.

use super::{colors, upload, view};
use crate::common::gpu::gpu;
use crate::common::statistics::Rgb;
use asvgf::{
    Camera, Denoiser, DenoiserDescriptor, FilterSettings, Gloss, Gradient, Pairs, Pipelines, Settings, Shading,
    Surfaces, View,
};
use wgpu::{TextureFormat, TextureView};

const SIZE: [u32; 2] = [24, 18];
const COUNT: usize = (SIZE[0] * SIZE[1]) as usize;

const DIFFUSE: Rgb = [0.5, 0.25, 1.5];
const SPECULAR: Rgb = [2.0, 0.75, 0.125];
const ALBEDO: Rgb = [0.5, 0.25, 0.75];
const REFLECTANCE: Rgb = [0.25, 0.5, 0.0625];

/// The views of a frame's light, each with numbers that a test may replace.
#[derive(Clone)]
struct Light {
    radiance: Vec<Rgb>,
    reflectance: Vec<Rgb>,
    roughness: Vec<[f32; 1]>,
    hit_distance: Vec<[f32; 1]>,
    motion: Vec<[f32; 2]>,
}

impl Light {
    /// The same light in all pixels; roughness, distance and motion differ from pixel to pixel.
    fn new() -> Self {
        let each = |f: &dyn Fn(usize) -> f32| (0..COUNT).map(|i| [f(i)]).collect::<Vec<_>>();
        Self {
            radiance: vec![SPECULAR; COUNT],
            reflectance: vec![REFLECTANCE; COUNT],
            roughness: each(&|i| (i % 7) as f32 / 6.0),
            hit_distance: each(&|i| [0.5, 3.0, 0.0, f32::INFINITY, 20.0][i % 5]),
            motion: (0..COUNT).map(|i| [(i % 3) as f32 - 0.5, 0.25]).collect(),
        }
    }
}

/// A light's views on the GPU.
struct Uploaded {
    radiance: TextureView,
    reflectance: TextureView,
    roughness: TextureView,
    hit_distance: TextureView,
    motion: TextureView,
}

impl Uploaded {
    fn new(light: &Light) -> Self {
        Self {
            radiance: upload(gpu(), SIZE, &light.radiance),
            reflectance: upload(gpu(), SIZE, &light.reflectance),
            roughness: upload(gpu(), SIZE, &light.roughness),
            hit_distance: upload(gpu(), SIZE, &light.hit_distance),
            motion: upload(gpu(), SIZE, &light.motion),
        }
    }

    fn gloss(&self) -> Gloss<'_> {
        Gloss {
            radiance: Some(&self.radiance),
            reflectance: Some(&self.reflectance),
            roughness: Some(&self.roughness),
            hit_distance: Some(&self.hit_distance),
            motion: Some(&self.motion),
            pairs: None,
        }
    }
}

fn denoiser(gradient: Gradient, pipelines: Option<Pipelines>) -> Denoiser {
    let settings = Settings { filter: FilterSettings { gradient, ..Default::default() }, ..Settings::adaptive() };
    let descriptor = DenoiserDescriptor { size: SIZE, settings, views: true, pipelines, ..Default::default() };
    Denoiser::new(&gpu().device, &gpu().queue, &descriptor).unwrap()
}

/// A wall that a camera passes, under the same diffuse light everywhere.
struct Wall {
    depth: TextureView,
    normal: TextureView,
    motion: TextureView,
    radiance: TextureView,
    albedo: TextureView,
    target: TextureView,
}

impl Wall {
    fn new() -> Self {
        Self {
            depth: upload(gpu(), SIZE, &[[2.0_f32]; COUNT]),
            normal: upload(gpu(), SIZE, &[[0.0_f32, 0.0, 1.0]; COUNT]),
            motion: upload(gpu(), SIZE, &[[0.75_f32, 0.0]; COUNT]),
            radiance: upload(gpu(), SIZE, &[DIFFUSE; COUNT]),
            albedo: upload(gpu(), SIZE, &[ALBEDO; COUNT]),
            target: gpu().target(SIZE, TextureFormat::Rgba32Float),
        }
    }

    fn shading<'a>(&'a self, gloss: Gloss<'a>) -> Shading<'a> {
        Shading { gloss: Some(gloss), ..Shading::new(&self.radiance, &self.target) }
    }

    /// Denoises a frame. From one to the next the camera moves by ¾ of a pixel.
    fn frame(&self, denoiser: &mut Denoiser, index: u32, shading: &Shading<'_>) -> Vec<Rgb> {
        let pixel = 2.0 * 2.0 * 0.4_f64.tan() / f64::from(SIZE[1]);
        let x = 0.75 * pixel * f64::from(index);
        let camera = Camera { eye: [x, 0.0, 0.0], target: [x, 0.0, -1.0], fov_y: 0.8, ..Default::default() };
        gpu().submit(|encoder| {
            let surfaces = Surfaces::new(camera, index, &self.depth, &self.normal, &self.motion);
            denoiser.begin_frame(&gpu().device, encoder, &surfaces).unwrap();
            denoiser.denoise(&gpu().device, encoder, shading).unwrap();
        });
        colors(&self.target)
    }
}

fn sum(a: Rgb, b: Rgb) -> Rgb {
    [0, 1, 2].map(|c| a[c] + b[c])
}

fn product(a: Rgb, b: Rgb) -> Rgb {
    [0, 1, 2].map(|c| a[c] * b[c])
}

/// The error of histories with 13 bits and of iterations with 10, in parts of the largest channel.
const ROUNDING: f32 = 4e-3;

/// Asserts that a pixel has this colour.
#[track_caller]
fn assert_is(found: Rgb, expected: Rgb, what: impl Fn() -> String) {
    assert!(off(found, expected) <= ROUNDING, "{}: {found:?}, not {expected:?}", what());
}

#[test]
fn constant_light_of_two_signals_is_their_sum() {
    let (wall, views) = (Wall::new(), Uploaded::new(&Light::new()));
    for gradient in [Gradient::Automatic, Gradient::Off] {
        let [mut whole, mut parts] = [0; 2].map(|_| denoiser(gradient, None));
        for index in 0..6 {
            let shading = wall.shading(views.gloss());
            let given = wall.frame(&mut whole, index, &shading);
            let lit = Shading { albedo: Some(&wall.albedo), demodulated: true, ..shading };
            let multiplied = wall.frame(&mut parts, index, &lit);
            for (a, b) in given.into_iter().zip(multiplied) {
                let what = || format!("{gradient:?}, frame {index}");
                assert_is(a, sum(DIFFUSE, SPECULAR), what);
                assert_is(b, sum(product(DIFFUSE, ALBEDO), product(SPECULAR, REFLECTANCE)), what);
            }
        }
        assert_eq!(view(&mut whole, View::HistoryLength)[COUNT / 2][0], 6.0);
    }
}

/// Each view may be absent, and the light is the same.
#[test]
fn any_of_the_views_may_be_absent() {
    let (wall, views) = (Wall::new(), Uploaded::new(&Light::new()));
    let mut pipelines = None;
    for subset in 0..32 {
        let mut gloss = views.gloss();
        let has = |view: u32| subset >> view & 1 == 1;
        gloss.radiance = gloss.radiance.filter(|_| has(0));
        gloss.reflectance = gloss.reflectance.filter(|_| has(1));
        gloss.roughness = gloss.roughness.filter(|_| has(2));
        gloss.hit_distance = gloss.hit_distance.filter(|_| has(3));
        gloss.motion = gloss.motion.filter(|_| has(4));
        let mut denoiser = denoiser(Gradient::Off, pipelines.take());
        let expected = if has(0) { sum(DIFFUSE, SPECULAR) } else { DIFFUSE };
        for index in 0..3 {
            for found in wall.frame(&mut denoiser, index, &wall.shading(gloss)) {
                assert_is(found, expected, || format!("views {subset:05b}, frame {index}"));
            }
        }
        pipelines = Some(denoiser.pipelines().clone());
    }
}

#[test]
fn specular_pairs_that_differ_drop_the_specular_history() {
    let (wall, views) = (Wall::new(), Uploaded::new(&Light::new()));
    let [now, before] = [SPECULAR, [0.0; 3]].map(|c| upload(gpu(), SIZE, &[c; COUNT]));
    let same = upload(gpu(), SIZE, &[DIFFUSE; COUNT]);
    let mut denoiser = denoiser(Gradient::Pairs, None);
    for index in 0..4 {
        let gloss = Gloss { pairs: Some(Pairs::new(&now, &before)), ..views.gloss() };
        let shading = Shading { pairs: Some(Pairs::new(&same, &same)), ..wall.shading(gloss) };
        for found in wall.frame(&mut denoiser, index, &shading) {
            assert_is(found, sum(DIFFUSE, SPECULAR), || format!("frame {index}"));
        }
    }
    assert!(view(&mut denoiser, View::Lambda).iter().all(|l| l[0] == 0.0), "the diffuse light has not changed");
}

/// Largest difference of a colour from another, in parts of the largest channel.
fn off(found: Rgb, expected: Rgb) -> f32 {
    let largest = expected.into_iter().fold(0.0, f32::max);
    (0..3).map(|c| (found[c] - expected[c]).abs()).fold(0.0, f32::max) / largest
}

/// Numbers that no view should hold, in every 7th pixel. The others show their own light as if nothing were wrong.
#[test]
fn bad_numbers_cost_only_themselves() {
    let wall = Wall::new();
    let mut pipelines = None;
    let bad = [f32::NAN, f32::INFINITY, -f32::NAN, -1.0, f32::NEG_INFINITY];
    for name in ["radiance", "reflectance", "roughness", "hit distance", "motion"] {
        let mut light = Light::new();
        let pixels: Vec<usize> = (0..COUNT).step_by(7).collect();
        for (k, &i) in pixels.iter().enumerate() {
            let value = bad[k % bad.len()];
            match name {
                // A channel below 0 is black, and as good a sample as any: the next test has those.
                "radiance" => light.radiance[i][k % 3] = bad[k % 3],
                "reflectance" if value.is_finite() => light.reflectance[i] = [value; 3],
                "reflectance" => light.reflectance[i][k % 3] = value,
                "roughness" => light.roughness[i] = [value],
                "hit distance" => light.hit_distance[i] = [value],
                _ => light.motion[i][k % 2] = value,
            }
        }
        let views = Uploaded::new(&light);
        let mut denoiser = denoiser(Gradient::Automatic, pipelines.take());
        let mut worst = [0.0_f32; 2];
        for index in 0..4 {
            let image = wall.frame(&mut denoiser, index, &wall.shading(views.gloss()));
            for (i, &found) in image.iter().enumerate() {
                let what = || format!("{name}, frame {index}, pixel {i}: {found:?}");
                assert!(found.iter().all(|c| c.is_finite() && *c >= 0.0), "{}", what());
                let dark = (0..3).any(|c| found[c] < 0.99 * DIFFUSE[c]);
                assert!(!dark, "{} is less than the diffuse light", what());
                let kind = usize::from(pixels.contains(&i));
                worst[kind] = worst[kind].max(off(found, sum(DIFFUSE, SPECULAR)));
            }
        }
        println!("{name}: good pixels are {:.4} off at worst, bad ones {:.4}", worst[0], worst[1]);
        // Roughness, distance and motion only say which history is taken, and all of them are alike.
        let allowed = match name {
            "radiance" | "reflectance" => [ROUNDING, f32::INFINITY],
            _ => [ROUNDING; 2],
        };
        assert!(worst[0] <= allowed[0] && worst[1] <= allowed[1], "{name}: {worst:?}");
        pipelines = Some(denoiser.pipelines().clone());
    }
}

#[test]
fn specular_light_below_zero_is_black() {
    let wall = Wall::new();
    let [mut negative, mut black] = [0; 2].map(|_| Light::new());
    for (k, i) in (0..COUNT).step_by(7).enumerate() {
        negative.radiance[i][k % 3] = [-1.0, f32::NEG_INFINITY, -1e30][k % 3];
        black.radiance[i][k % 3] = 0.0;
    }
    let images = [negative, black].map(|light| {
        let (views, mut denoiser) = (Uploaded::new(&light), denoiser(Gradient::Automatic, None));
        [0, 1, 2].map(|index| wall.frame(&mut denoiser, index, &wall.shading(views.gloss())))
    });
    assert!(images[0] == images[1]);
}
