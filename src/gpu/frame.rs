//! One frame's constants, as shaders/shared/frame.wgsl reads them.

use crate::camera::{CameraUniform, PlacedCamera};
use crate::plan::Grid;
use crate::settings::{LONGEST_HISTORY, Settings, Stops};
use bytemuck::{Pod, Zeroable};

/// `Frame` of frame.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct FrameUniform {
    size: [u32; 2],
    strata: [u32; 2],
    camera: CameraUniform,
    previous: CameraUniform,
    index: u32,
    seed: u32,
    continued: u32,
    samples: u32,
    batch: u32,
    first_sample: u32,
    bounces: u32,
    roulette: u32,
    alpha: f32,
    max_history: f32,
    history_power: f32,
    gradient_gamma: f32,
    sigma_luminance: f32,
    sigma_depth: f32,
    sigma_normal: f32,
    ridge: f32,
    effective_pairs: f32,
    dead_zone: f32,
    lambda_block: u32,
    converged: f32,
    sigma_foreshortening: f32,
    ridge_noise: f32,
    steadiness: f32,
    outlier_limit: f32,
    gloss_history_power: f32,
    gloss_sigma_luminance: f32,
    gloss_clamp: f32,
    gloss_parallax: f32,
}

/// The constants that differ from frame to frame.
#[derive(Clone, Debug)]
pub(crate) struct Moment {
    pub camera: PlacedCamera,
    pub previous: PlacedCamera,
    /// The place in the world that the coordinates of the scene, or of the host, count from.
    pub origin: [f64; 3],
    pub index: u32,
    pub continued: bool,
    /// Number of pixels in each direction that share a texel of the host's λ.
    pub lambda_block: u32,
    /// True if nothing changed, so that the mean continues over all frames so far.
    pub converges: bool,
}

impl FrameUniform {
    pub fn new(size: [u32; 2], moment: &Moment, settings: &Settings) -> Self {
        let f = &settings.filter;
        #[cfg(feature = "path-tracer")]
        let [seed, samples, bounces, roulette] = {
            let t = &settings.tracer;
            [t.seed, t.samples, t.bounces, t.roulette]
        };
        #[cfg(not(feature = "path-tracer"))]
        let [seed, samples, bounces, roulette] = [0, 1, 0, 0];
        // The noise-subtracting stop compares squares.
        let stop = |sigma: f32| match f.stops {
            Stops::NoiseSubtracted => sigma * sigma,
            Stops::Classic => sigma,
        };
        let (alpha, max_history) = if moment.converges { (0.0, LONGEST_HISTORY) } else { (f.alpha, f.max_history) };
        Self {
            size,
            strata: Grid::Strata.extent(size),
            camera: moment.camera.uniform(moment.origin, &moment.camera),
            previous: moment.previous.uniform(moment.origin, &moment.camera),
            index: moment.index,
            seed,
            continued: u32::from(moment.continued),
            samples,
            batch: samples,
            first_sample: 0,
            bounces,
            roulette,
            alpha,
            max_history,
            history_power: f.history_power,
            gradient_gamma: f.gradient_gamma,
            sigma_luminance: stop(f.sigma_luminance),
            sigma_depth: f.sigma_depth,
            sigma_normal: f.sigma_normal,
            ridge: f.ridge,
            effective_pairs: effective_pairs(f.ratio_iterations),
            dead_zone: f.gradient_dead_zone,
            lambda_block: moment.lambda_block,
            converged: f.converged,
            sigma_foreshortening: f.sigma_foreshortening,
            ridge_noise: f.ridge_noise,
            steadiness: f.steadiness,
            outlier_limit: f.outlier_limit,
            gloss_history_power: f.gloss_history_power,
            gloss_sigma_luminance: stop(f.gloss_sigma_luminance),
            gloss_clamp: f.gloss_clamp,
            gloss_parallax: f.gloss_parallax,
        }
    }
}

/// Bytes from one dispatch's constants to the next, if several share a frame's paths: a multiple of the default
/// `min_uniform_buffer_offset_alignment`.
pub(crate) const SPACING: usize = size_of::<FrameUniform>().next_multiple_of(256);

/// The constants of all dispatches of a frame. They differ in the number of paths that a dispatch traces, and in the index of the
/// first. They are in the frame's own uniform, because lavapipe of Mesa 22.3 crashed with another small one when it compiled `trace`.
pub(crate) fn of_each_batch(frame: FrameUniform, batches: &[[u32; 2]]) -> Vec<u8> {
    let mut bytes = vec![0; batches.len().max(1) * SPACING];
    bytes[..size_of::<FrameUniform>()].copy_from_slice(bytemuck::bytes_of(&frame));
    for (place, &[batch, first_sample]) in bytes.chunks_exact_mut(SPACING).zip(batches) {
        let of_batch = FrameUniform { batch, first_sample, ..frame };
        place[..size_of::<FrameUniform>()].copy_from_slice(bytemuck::bytes_of(&of_batch));
    }
    bytes
}

/// The number of independent pairs that a filtered pair is worth: 1/Σw² (Kish 1965). The tent's à-trous iterations together are a
/// tent of half-width m = 2ⁱ, so it is (3m³/(2m² + 1))² on an endless plane. Edges of surfaces take away some of the taps: for three
/// iterations, 90 were measured (docs/filter.md) where the formula gives 142.
fn effective_pairs(iterations: u32) -> f32 {
    let plane = |iterations: u32| {
        let m = f64::from(1 << iterations.min(7));
        (3.0 * m.powi(3) / (2.0 * m * m + 1.0)).powi(2)
    };
    (90.0 / plane(3) * plane(iterations)).max(1.0) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Σw² of the tent filter, iteration by iteration, in one dimension.
    fn sum_of_squares(iterations: u32) -> f64 {
        let mut weights = vec![1.0];
        for iteration in 0..iterations {
            let stride = 1 << iteration;
            let mut wider = vec![0.0; weights.len() + 2 * stride];
            for (i, weight) in weights.iter().enumerate() {
                for (k, tap) in [0.25, 0.5, 0.25].into_iter().enumerate() {
                    wider[i + k * stride] += tap * weight;
                }
            }
            weights = wider;
        }
        weights.iter().map(|w| w * w).sum()
    }

    #[test]
    fn pairs_count_as_the_filter_averages_them() {
        assert_eq!(effective_pairs(0), 1.0, "a pair alone");
        let plane = |iterations| sum_of_squares(iterations).powi(-2);
        for iterations in 1..=7 {
            let expected = 90.0 * plane(iterations) / plane(3);
            let found = f64::from(effective_pairs(iterations));
            assert!((found / expected - 1.0).abs() < 1e-5, "{iterations}: {found}, not {expected}");
        }
    }

    #[cfg(feature = "path-tracer")]
    #[test]
    fn the_frame_lies_where_the_shader_reads_it() {
        use crate::twins::layout::{assert_layout, fields};
        let fields = fields!(FrameUniform: size, strata, camera, previous, index, seed, continued, samples, batch, first_sample, bounces, roulette,
            alpha, max_history, history_power, gradient_gamma, sigma_luminance, sigma_depth, sigma_normal, ridge, effective_pairs,
            dead_zone, lambda_block, converged, sigma_foreshortening, ridge_noise, steadiness, outlier_limit,
            gloss_history_power, gloss_sigma_luminance, gloss_clamp, gloss_parallax);
        assert_layout("Frame", fields, size_of::<FrameUniform>());
    }
}
