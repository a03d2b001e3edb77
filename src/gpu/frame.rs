//! One frame's constants, as shaders/shared/frame.wgsl reads them.

use crate::camera::CameraUniform;
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
    ratio_limit: f32,
    ratio_chroma_limit: f32,
    ratio_prior: f32,
    ratio_shrinkage: f32,
    dead_zone: f32,
    lambda_block: u32,
    converged: f32,
    sigma_foreshortening: f32,
    padding: [u32; 2],
}

/// What differs from frame to frame.
#[derive(Clone, Debug)]
pub(crate) struct Moment {
    pub camera: CameraUniform,
    pub previous: CameraUniform,
    pub index: u32,
    pub continued: bool,
    /// Pixels of each direction that share a texel of the host's λ.
    pub lambda_block: u32,
    /// Nothing changed: the mean goes on over all frames there were.
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
        let sigma_luminance = match f.stops {
            Stops::NoiseSubtracted => f.sigma_luminance * f.sigma_luminance,
            Stops::Classic => f.sigma_luminance,
        };
        let (alpha, max_history) = if moment.converges { (0.0, LONGEST_HISTORY) } else { (f.alpha, f.max_history) };
        Self {
            size,
            strata: Grid::Strata.extent(size),
            camera: moment.camera,
            previous: moment.previous,
            index: moment.index,
            seed,
            continued: u32::from(moment.continued),
            samples,
            bounces,
            roulette,
            alpha,
            max_history,
            history_power: f.history_power,
            gradient_gamma: f.gradient_gamma,
            sigma_luminance,
            sigma_depth: f.sigma_depth,
            sigma_normal: f.sigma_normal,
            ridge: f.ridge,
            // Constants of the history ratio, from the study in docs/filter.md: clamped to ¼…4, colour to 1½ of the
            // luminance's ratio, a prior of 5 %, and the effective number of samples in the filtered pairs.
            ratio_limit: 4.0,
            ratio_chroma_limit: 1.5,
            ratio_prior: 0.05,
            ratio_shrinkage: 90.0,
            dead_zone: f.gradient_dead_zone,
            lambda_block: moment.lambda_block,
            converged: f.converged,
            sigma_foreshortening: f.sigma_foreshortening,
            padding: [0; 2],
        }
    }
}

#[cfg(all(test, feature = "path-tracer"))]
mod tests {
    use super::*;
    use crate::twins::layout::{assert_layout, fields};

    #[test]
    fn the_frame_lies_where_the_shader_reads_it() {
        let fields = fields!(FrameUniform: size, strata, camera, previous, index, seed, continued, samples, bounces, roulette,
            alpha, max_history, history_power, gradient_gamma, sigma_luminance, sigma_depth, sigma_normal, ridge, ratio_limit,
            ratio_chroma_limit, ratio_prior, ratio_shrinkage, dead_zone, lambda_block, converged,
            sigma_foreshortening);
        assert_layout("Frame", fields, size_of::<FrameUniform>());
    }
}
