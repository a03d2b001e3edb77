//! What can be set, with what a higher and a lower value cost.

use crate::Error;

/// Frames that a history may count. Beyond, what rounding adds grows faster than what averaging takes away.
pub(crate) const LONGEST_HISTORY: f32 = 32768.0;

/// Everything that can be set. All of it may change between two frames; what changes the compiled shaders says so.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// What the target shows. Changing it compiles.
    pub mode: Mode,
    /// How the noise is filtered.
    pub filter: FilterSettings,
    /// How paths are traced.
    #[cfg(feature = "path-tracer")]
    pub tracer: TracerSettings,
}

impl Default for Settings {
    /// [`Settings::adaptive`].
    fn default() -> Self {
        Self::adaptive()
    }
}

impl Settings {
    /// The crate's own filter with an adaptive α: the default.
    pub fn adaptive() -> Self {
        Self {
            mode: Mode::Denoise,
            filter: FilterSettings::default(),
            #[cfg(feature = "path-tracer")]
            tracer: TracerSettings::default(),
        }
    }

    /// The formulas of A-SVGF as published (Schied et al. 2017 and 2018), for comparison.
    pub fn classic() -> Self {
        Self { filter: FilterSettings::classic(), ..Self::adaptive() }
    }

    /// The same filter with a constant α: no temporal gradient, a history that fades as `(1 − α)ⁿ` whatever happens. An α below
    /// 1/32768 acts as that: no history is longer. With 0, the history is as long as [`FilterSettings::max_history`] allows.
    pub fn constant(self, alpha: f32) -> Self {
        // As many samples as such an average is worth, (2 − α)/α.
        let worth = if alpha > 0.0 { (2.0 / alpha - 1.0).min(LONGEST_HISTORY) } else { 0.0 };
        let max_history = self.filter.max_history.max(worth);
        // Nobody says where the light has changed: the last output would stay there, too.
        let filter = FilterSettings { gradient: Gradient::Off, alpha, max_history, steadiness: 0.0, ..self.filter };
        Self { filter, ..self }
    }

    /// Checks every setting's range.
    ///
    /// # Errors
    /// [`Error::Setting`] for the first that is outside.
    pub fn check(&self) -> Result<(), Error> {
        let f = &self.filter;
        let within = |setting, value: f32, low: f32, high: f32, accepted| {
            if value >= low && value <= high {
                Ok(())
            } else {
                Err(Error::Setting { setting, value: value.into(), accepted })
            }
        };
        within("filter.alpha", f.alpha, 0.0, 1.0, "0…1")?;
        within("filter.max_history", f.max_history, 1.0, LONGEST_HISTORY, "1…32768 frames")?;
        within("filter.history_power", f.history_power, 0.0, 64.0, "0…64")?;
        within("filter.gradient_gamma", f.gradient_gamma, 0.0, 1.0, "0…1")?;
        within("filter.gradient_iterations", f.gradient_iterations as f32, 0.0, 7.0, "0…7")?;
        within("filter.gradient_dead_zone", f.gradient_dead_zone, 0.0, 1.0, "0…1")?;
        within("filter.ratio_iterations", f.ratio_iterations as f32, 0.0, 7.0, "0…7")?;
        within("filter.iterations", f.iterations as f32, 0.0, 8.0, "0…8")?;
        within("filter.converged", f.converged, 0.0, 1.0, "0…1")?;
        within("filter.sigma_luminance", f.sigma_luminance, 0.0, 1e6, "0…10⁶")?;
        within("filter.sigma_depth", f.sigma_depth, 1e-6, 1e6, "10⁻⁶…10⁶")?;
        within("filter.sigma_normal", f.sigma_normal, 0.0, 1e6, "0…10⁶")?;
        within("filter.sigma_foreshortening", f.sigma_foreshortening, 0.0, 1e6, "0…10⁶")?;
        within("filter.ridge", f.ridge, 1e-6, 1e6, "10⁻⁶…10⁶")?;
        within("filter.ridge_noise", f.ridge_noise, 0.0, 1e6, "0…10⁶")?;
        within("filter.outlier_limit", f.outlier_limit, 0.0, 1e6, "0…10⁶")?;
        within("filter.steadiness", f.steadiness, 0.0, 1.0, "0…1")?;
        #[cfg(feature = "path-tracer")]
        {
            within("tracer.samples", self.tracer.samples as f32, 1.0, 65536.0, "1…65536 samples per pixel")?;
            within("tracer.bounces", self.tracer.bounces as f32, 0.0, 1024.0, "0…1024 bounces")?;
        }
        Ok(())
    }
}

/// What the target shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// The filtered image.
    #[default]
    Denoise,
    /// The path tracer's samples as they are.
    Noisy,
    /// The mean of all frames since the last restart or change of scene, camera or `TracerSettings`, in f32: converges to the
    /// truth. Samples that are missing do not count.
    Reference,
}

/// How the noise is filtered. The defaults are those of the study in docs/filter.md.
#[derive(Clone, Debug, PartialEq)]
pub struct FilterSettings {
    /// Where the temporal gradient comes from. Changing it compiles.
    pub gradient: Gradient,
    /// Least weight of a new frame, 0…1. A history is then worth (2 − α)/α samples at most. Higher: noisier, but what the gradient misses is forgotten sooner. Lower: smoother,
    /// and slower to forget. With [`Gradient::Off`] this is *the* α of the moving average.
    pub alpha: f32,
    /// Longest history, 1…32768: the weight of a new frame is 1/n until n gets here, and stays so. Higher: smoother still images.
    pub max_history: f32,
    /// k in n ← n·(1 − λ)ᵏ + 1, ≥ 0: how fast a history length falls with the gradient λ. Higher: less lag, more noise after
    /// a change. 0 never shortens.
    pub history_power: f32,
    /// Rescale the history by the ratio that the gradient samples show before blending, and drop only what the ratio does
    /// not explain: less lag and less noise where light moves or dims. Re-shading and pairs only. Changing it compiles.
    pub history_ratio: bool,
    /// Iterations that spread that ratio over the strata, 0…7. More: a steadier ratio, farther from where the light changed. With 0
    /// each stratum goes by its own path.
    pub ratio_iterations: u32,
    /// γ in λ = A\[Δ^(γ−1)·|δ|\] / A\[Δ^γ\], 0…1. Higher: a dim change beside a bright steady light is overlooked. Lower: a
    /// change that few samples see counts as much as one that all see.
    pub gradient_gamma: f32,
    /// Iterations that spread the gradient over the strata, 0…7; each doubles the reach (3, 9, 21 pixels …). More: steadier,
    /// and more history is dropped around a change.
    pub gradient_iterations: u32,
    /// λ is at least what the paths around saw together on any surface. Off: thin things and corners keep ghosts of changes that
    /// their own few paths missed; on: near a change, a little more history is dropped. Changing it compiles.
    pub gradient_across_surfaces: bool,
    /// Let differences of opposite sign cancel in λ = max(0, |A\[Δ^(γ−1)·δ\]| / A\[Δ^γ\] − dead zone): for hosts whose pairs do
    /// not repeat their random numbers, so that each difference is mostly noise; take 5 `gradient_iterations` and a
    /// `gradient_dead_zone` of 0.1 with it. A shadow that moves cancels too: repeat the numbers where you can. Changing it compiles.
    pub gradient_signed: bool,
    /// What is subtracted from λ, 0…1. Higher: noise in the gradient costs no history, and small changes of light lag.
    pub gradient_dead_zone: f32,
    /// How λ enters the weight of the new frame. Changing it compiles.
    pub blend: Blend,
    /// Feed the colour of the first spatial iteration back into history, as SVGF does: smoother at first, blurred for
    /// good. Changing it compiles.
    pub feedback: bool,
    /// Which variance steers the luminance stop. Changing it compiles.
    pub variance: Variance,
    /// Formulas of the edge stops. Changing it compiles.
    pub stops: Stops,
    /// Taps of a spatial iteration. Changing it compiles.
    pub kernel: Kernel,
    /// Fit a plane to the taps instead of averaging them: sharper borders and penumbrae for 5 % more time. Changing it
    /// compiles.
    pub local_linear_fit: bool,
    /// Ridge on the slopes of that plane, > 0. Higher: closer to the mean. Lower: follows noise.
    pub ridge: f32,
    /// By how much the ridge follows the noise of the slope, as a factor on its variance over its square, within ½…8 times `ridge`. Higher:
    /// smoother where there is noise, blurrier penumbrae. Lower: the plane follows noise. 0: the ridge is constant. Changing it from or to
    /// 0 compiles.
    pub ridge_noise: f32,
    /// Spatial iterations, 0…8, with steps of 1, 2, 4 … pixels. More: smoother, costlier, blurrier.
    pub iterations: u32,
    /// One more iteration over the nine nearest taps: less error and less flicker, for a seventh of the spatial filter's time. Changing it compiles.
    pub final_iteration: bool,
    /// Most that the last output weighs in this one, 0…1, where the surface is the same, its light has not changed, and the image rests
    /// on its pixels. Higher: less flicker, and more lag where a change is missed. 0: none, which saves a pass and 16 bytes per pixel.
    /// Changing it from or to 0 compiles; from 0, it starts a new history, as does raising `iterations` from 0.
    pub steadiness: f32,
    /// How many times as bright as its surroundings a sample may be, 0…10⁶, where not several around are as bright: what is brighter is
    /// taken for an outlier and has no weight. Higher: more of the light that one path in ten thousand finds is kept, and more of what a
    /// renderer's fireflies leave. Lower: the reverse; below 20, common noise loses energy. 0: everything is believed, which saves three
    /// passes over strata. Changing it from or to 0 compiles; from 0, it starts a new history.
    pub outlier_limit: f32,
    /// Pixels whose noise (deviation over luminance) is below this are left as they are, in whatever iteration they get there, 0…1.
    /// Higher: less time where there is little noise, and more of it stays. Lower: the filter blurs what no longer needs it. 0: never.
    pub converged: f32,
    /// Luminance stop in standard deviations of the noise. Higher: smoother, edges of shadows blur. 0 filters nothing but
    /// what is equal.
    pub sigma_luminance: f32,
    /// Depth stop. Default stops: tolerated distance from the tangent plane, in parts of the depth. Classic: in depth
    /// gradients. Higher: leaks across edges. Lower: noise stays on curved surfaces.
    pub sigma_depth: f32,
    /// Normal stop: the exponent. Higher: sharper normal edges, noise stays on curved surfaces.
    pub sigma_normal: f32,
    /// Foreshortening stop of the default stops: by how much taps weigh less that are farther away on the surface than on the image.
    /// Higher: sharper shadows on what is seen at a grazing angle, and more noise there. 0: as far on the image, as good.
    pub sigma_foreshortening: f32,
}

impl Default for FilterSettings {
    fn default() -> Self {
        Self {
            gradient: Gradient::Automatic,
            alpha: 0.02,
            max_history: 64.0,
            history_power: 3.5,
            history_ratio: true,
            ratio_iterations: 3,
            gradient_gamma: 0.5,
            gradient_iterations: 2,
            gradient_across_surfaces: true,
            gradient_signed: false,
            gradient_dead_zone: 0.0,
            blend: Blend::HistoryLength,
            feedback: false,
            variance: Variance::OfMean,
            stops: Stops::NoiseSubtracted,
            kernel: Kernel::Diamond,
            local_linear_fit: true,
            ridge: 0.25,
            ridge_noise: 1.5,
            iterations: 4,
            final_iteration: true,
            steadiness: 0.9,
            outlier_limit: 40.0,
            converged: 0.03,
            sigma_luminance: 4.0,
            sigma_depth: 0.0025,
            sigma_normal: 32.0,
            sigma_foreshortening: 0.25,
        }
    }
}

impl FilterSettings {
    /// The formulas of A-SVGF as published, with the customary values.
    pub fn classic() -> Self {
        Self {
            gradient: Gradient::Reshade,
            alpha: 0.2,
            max_history: 64.0,
            history_power: 10.0,
            history_ratio: false,
            ratio_iterations: 3,
            gradient_gamma: 0.0,
            gradient_iterations: 3,
            gradient_across_surfaces: false,
            gradient_signed: false,
            gradient_dead_zone: 0.0,
            blend: Blend::Lambda,
            feedback: true,
            variance: Variance::OfSample,
            stops: Stops::Classic,
            kernel: Kernel::Full,
            local_linear_fit: false,
            ridge: 0.25,
            ridge_noise: 0.0,
            iterations: 5,
            final_iteration: false,
            steadiness: 0.0,
            outlier_limit: 0.0,
            converged: 0.0,
            sigma_luminance: 4.0,
            sigma_depth: 1.0,
            sigma_normal: 128.0,
            sigma_foreshortening: 0.0,
        }
    }
}

/// Where the temporal gradient, and with it the adaptive α, comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Gradient {
    /// [`Gradient::Reshade`] where the denoiser traces the paths. In a host's frame: [`Gradient::Lambda`] if it has λ, else
    /// [`Gradient::Pairs`] if it has pairs, else [`Gradient::Statistics`].
    #[default]
    Automatic,
    /// One pixel of each 3×3 repeats a path of the last frame, random numbers included, in this frame's scene (Schied et al.
    /// 2018): sees every change of light, shadow and geometry. Costs no extra ray. Where the host renders,
    /// [`Denoiser::begin_frame`](crate::Denoiser::begin_frame) says which pixels and paths.
    Reshade,
    /// The mean of the new samples against that of their histories, over 21 to 93 pixels of a surface around, less the noise of both: needs
    /// nothing but the image and its G-buffer. Sees every change that is greater than the noise of a thousand samples, a few frames later
    /// than repeated paths do where light moves.
    Statistics,
    /// Deferred Blinn–Phong shading of this and the last frame's lights, without shadows: no ray, no noise, blind to what
    /// blocks the light. Only for the crate's own path tracer, as it needs the scene.
    BlinnPhong,
    /// Pairs that the host made, see [`Pairs`](crate::Pairs). Only for frames of a host's renderer.
    Pairs,
    /// λ itself, or a confidence, from the host, see [`Lambda`](crate::Lambda). Only for frames of a host's renderer.
    Lambda,
    /// None: α is constant.
    Off,
}

impl Gradient {
    /// What it is where the denoiser traces the paths.
    #[cfg(feature = "path-tracer")]
    pub(crate) fn traced(self) -> Self {
        if self == Self::Automatic { Self::Reshade } else { self }
    }

    /// What it is in a host's frame with or without λ and pairs.
    pub(crate) fn hosted(self, lambda: bool, pairs: bool) -> Self {
        match self {
            Self::Automatic if lambda => Self::Lambda,
            Self::Automatic if pairs => Self::Pairs,
            Self::Automatic => Self::Statistics,
            asked => asked,
        }
    }
}

/// How λ enters the weight α' of the new frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Blend {
    /// α' = 1/n with the shortened history length n.
    #[default]
    HistoryLength,
    /// α' = (1 − λ)·α + λ as published, and at least 1/n.
    Lambda,
}

/// Which variance steers the luminance stop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Variance {
    /// That of the accumulated mean: (m₂ − m₁²)/n.
    #[default]
    OfMean,
    /// That of one sample: m₂ − m₁².
    OfSample,
}

/// Formulas of the edge stops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Stops {
    /// Distance from the tangent plane, exp(−σ·(1 − n·n')), foreshortening, and squared luminance difference less the noise of
    /// both ends.
    #[default]
    NoiseSubtracted,
    /// exp(−|Δz|/(σ·|∇z·Δp|)), max(0, n·n')^σ, exp(−|Δl|/(σ·√Var)).
    Classic,
}

/// Taps of a spatial iteration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Kernel {
    /// The 13 taps of the B₃ spline's 5×5 with |x| + |y| ≤ 2: as good, at half the price.
    #[default]
    Diamond,
    /// All 25.
    Full,
}

/// How paths are traced. Paths of other settings are not those of the last frame: with re-shading, a change drops what history it
/// contradicts.
#[cfg(feature = "path-tracer")]
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TracerSettings {
    /// Paths per pixel and frame, 1…65536. Higher: less noise, proportionally slower. Many are traced in several dispatches, as one
    /// might be taken for hung. Systems that time what is submitted, not dispatches, need a host that submits in between:
    /// [`Denoiser::render_stepwise`](crate::Denoiser::render_stepwise).
    pub samples: u32,
    /// Reflections after the first surface; 0 is direct light only. Higher: brighter corners, slower. A path is never divided among
    /// dispatches: some hundred bounces without roulette may be ended by the driver, and are then missing.
    pub bounces: u32,
    /// Bounce from which Russian roulette may end a path. Higher: less noise, slower.
    pub roulette: u32,
    /// Which estimator. Changing it compiles.
    pub sampling: Sampling,
    /// Another number gives other noise.
    pub seed: u32,
}

#[cfg(feature = "path-tracer")]
impl Default for TracerSettings {
    fn default() -> Self {
        Self { samples: 1, bounces: 3, roulette: 3, sampling: Sampling::Both, seed: 0 }
    }
}

/// Which estimator of direct light. All have the same mean (except that scattered rays alone never find a light without
/// area); they differ in noise.
#[cfg(feature = "path-tracer")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Sampling {
    /// Light samples and scattered rays, weighted by the power heuristic (Veach 1997).
    #[default]
    Both,
    /// Light samples alone.
    Lights,
    /// Scattered rays alone.
    Scattered,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_alpha_may_be_anything_from_0_to_1() {
        for alpha in [0.0, 1e-30, 1e-6, 1.0 / 32768.0, 0.05, 0.5, 1.0] {
            let settings = Settings::adaptive().constant(alpha);
            settings.check().unwrap_or_else(|e| panic!("{alpha}: {e}"));
            // Long enough for what such an average is worth, (2 − α)/α, as far as a history goes.
            let worth = (2.0 / alpha - 1.0).min(LONGEST_HISTORY);
            assert!(alpha == 0.0 || settings.filter.max_history >= worth, "{alpha}");
        }
        for alpha in [-0.1, 1.1, f32::NAN] {
            let error = Settings::adaptive().constant(alpha).check().unwrap_err().to_string();
            assert!(error.contains("filter.alpha"), "{alpha}: {error}");
        }
    }
}
