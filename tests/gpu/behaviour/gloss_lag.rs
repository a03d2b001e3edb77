//! How soon a reflection shows what has changed.

use crate::common::stage::Stage;
use crate::common::statistics::luminance;
use asvgf::scene::Pose;
use asvgf::{Settings, TracerSettings, View};

const SIZE: [u32; 2] = [64, 48];

/// Roughness up to which a pixel counts as reflecting: that of the mirror and of both metals.
const REFLECTING: f32 = 0.45;

/// The specular light of a pose without noise: the mean of many frames. Views of the mean are of both signals together, so the specular
/// light of each frame is added up.
fn converged(animation: &str, pose: &Pose, frames: u32) -> Vec<f64> {
    let tracer = TracerSettings { samples: 16, seed: 7, ..Default::default() };
    let mut stage = Stage::built_in("gloss", animation, SIZE, Settings { tracer, ..Settings::adaptive() });
    let mut sum = vec![0.0; (SIZE[0] * SIZE[1]) as usize];
    for _ in 0..frames {
        let image = stage.frame_in(pose).view(View::SpecularNoisy);
        sum.iter_mut().zip(&image).for_each(|(s, &c)| *s += luminance(c) / f64::from(frames));
    }
    sum
}

/// Mean of the specular light over the pixels that reflect, relative to the truth, less 1.
fn bias(stage: &mut Stage, truth: &[f64]) -> f64 {
    let (roughness, image) = (stage.view(View::Roughness), stage.view(View::Specular));
    let pixels: Vec<usize> = (0..roughness.len()).filter(|&i| roughness[i][0] <= REFLECTING).collect();
    assert!(pixels.len() > 400, "{} pixels reflect", pixels.len());
    let sum = |of: &dyn Fn(usize) -> f64| pixels.iter().map(|&i| of(i)).sum::<f64>();
    sum(&|i| luminance(image[i])) / sum(&|i| truth[i]) - 1.0
}

/// One path per pixel leaves more than 10 % of noise in most pixels, so that the mean of all that reflect is compared. The lamp is seen in
/// mirrors alone; without it a quarter of the light is left.
#[test]
fn reflections_have_followed_a_lamp_after_two_frames() {
    for (first, change) in [(6, 30), (36, 60)] {
        let mut stage = Stage::built_in("gloss", "blink", SIZE, Settings::adaptive());
        let truth = converged("blink", &stage.pose_at(change), 24);
        stage.index = first;
        stage.frames(change - first);
        let off = [0; 3].map(|_| bias(stage.frame(), &truth));
        println!("the lamp changes in frame {change}: {off:+.3?}");
        assert!(off[1].abs() < 0.15 && off[2].abs() < 0.1, "frame {change}: {off:?}");
    }
}
