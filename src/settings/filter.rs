//! How the noise is filtered.

use super::declare::settings;
use crate::listed::listed;

settings! {
    /// How the noise is filtered. The defaults are those of the study in docs/filter.md.
    pub struct FilterSettings in filter {
        /// The source of the temporal gradient.
        gradient: Gradient { default: Gradient::Automatic, classic: Gradient::Reshade, compiles: Always }

        /// Least weight of a new frame: a history is worth (2 − α)/α samples at most. Higher: noisier, but changes that the
        /// gradient misses are forgotten sooner. Lower: smoother, and slower to forget. With [`Gradient::Off`] this is *the* α of
        /// the moving average.
        alpha: f32 { default: 0.02, classic: 0.2, range: 0..=1, scale: logarithmic }

        // Beyond 32768 frames, rounding adds more than averaging takes away.
        /// Longest history: the weight of a new frame is 1/n until n gets here, and stays so. Higher: smoother still images.
        max_history: f32 {
            default: 64.0,
            range: 1..=32768,
            unit: "frames",
            most: LONGEST_HISTORY,
            useful: 1..=1024,
            scale: logarithmic,
        }

        /// k in n ← n·(1 − λ)ᵏ + 1: how fast a history length falls with the gradient λ. Higher: less lag, more noise after
        /// a change. 0 never shortens.
        history_power: f32 { default: 3.5, classic: 10.0, range: 0..=64, useful: 0..=16 }

        /// Rescale the history by the ratio that the gradient samples show before blending, and drop only what the ratio does
        /// not explain: less lag and less noise where light moves or dims. Ignored with [`Gradient::BlinnPhong`], because analytic
        /// shading is blind to shadows, and where there are no samples ([`Gradient::Lambda`], [`Gradient::Off`]).
        history_ratio: bool { default: true, classic: false, compiles: Always }

        /// Iterations that spread that ratio over the strata. More: a steadier ratio, farther from where the light changed. With 0
        /// each stratum goes by its own path. Changing it from 0 compiles.
        ratio_iterations: u32 { default: 3, range: 0..=7, most: MOST_RATIO_ITERATIONS, compiles: Sometimes }

        /// γ in λ = A\[Δ^(γ−1)·|δ|\] / A\[Δ^γ\]. Higher: a dim change beside a bright steady light is overlooked. Lower: a
        /// change that few samples see counts as much as one that all see.
        gradient_gamma: f32 { default: 0.5, classic: 0.0, range: 0..=1 }

        /// Iterations that spread the gradient over the strata; each doubles the reach (3, 9, 21 pixels …). More: steadier,
        /// and more history is dropped around a change. Changing it from 0 compiles.
        gradient_iterations: u32 {
            default: 2,
            classic: 3,
            range: 0..=7,
            most: MOST_GRADIENT_ITERATIONS,
            compiles: Sometimes,
        }

        /// λ is at least what the paths around saw together on any surface. Off: thin things and corners keep ghosts of changes that
        /// their own few paths missed. On: near a change, a little more history is dropped.
        gradient_across_surfaces: bool { default: true, classic: false, compiles: Always }

        /// Let differences of opposite sign cancel in λ = max(0, |A\[Δ^(γ−1)·δ\]| / A\[Δ^γ\] − dead zone): for hosts whose pairs do
        /// not repeat their random numbers, so that each difference is mostly noise. Take 5 `gradient_iterations` and a
        /// `gradient_dead_zone` of 0.1 with it. A shadow that moves cancels too: repeat the numbers where you can.
        gradient_signed: bool { default: false, compiles: Always }

        /// This much is subtracted from λ. Higher: noise in the gradient costs no history, and small changes of light lag.
        gradient_dead_zone: f32 { default: 0.0, range: 0..=1 }

        /// How λ enters the weight of the new frame.
        blend: Blend { default: Blend::HistoryLength, classic: Blend::Lambda, compiles: Always }

        /// Feed the colour of the first spatial iteration back into history, as SVGF does: smoother at first, blurred for
        /// good.
        feedback: bool { default: false, classic: true, compiles: Always }

        /// The variance that steers the luminance stop.
        variance: Variance { default: Variance::OfMean, classic: Variance::OfSample, compiles: Always }

        /// Formulas of the edge stops.
        stops: Stops { default: Stops::NoiseSubtracted, classic: Stops::Classic, compiles: Always }

        /// Taps of a spatial iteration.
        kernel: Kernel { default: Kernel::Diamond, classic: Kernel::Full, compiles: Always }

        /// Fit a plane to the taps instead of averaging them: sharper borders and penumbrae for 5 % more time.
        local_linear_fit: bool { default: true, classic: false, compiles: Always }

        /// Ridge on the slopes of that plane. Higher: closer to the mean. Lower: follows noise.
        ridge: f32 { default: 0.25, range: 1e-6..=1e6, useful: 1e-3..=100.0, scale: logarithmic }

        /// How far the ridge follows the noise of the slope: a factor on its variance over its square, within ½…8 times `ridge`.
        /// Higher: smoother where there is noise, blurrier penumbrae. Lower: the plane follows noise. 0: the ridge is constant.
        /// Changing it from or to 0 compiles.
        ridge_noise: f32 { default: 1.5, classic: 0.0, range: 0..=1e6, useful: 0..=16, compiles: Sometimes }

        /// Spatial iterations, with steps of 1, 2, 4 … pixels. More: smoother, costlier, blurrier. Changing it from 0 or 1, or to 0,
        /// compiles.
        iterations: u32 { default: 4, classic: 5, range: 0..=8, most: MOST_SPATIAL_ITERATIONS, compiles: Sometimes }

        /// One more iteration over the nine nearest taps: less error and less flicker, for a seventh of the spatial filter's time.
        final_iteration: bool { default: true, classic: false, compiles: Always }

        /// The most that the last output weighs in this one, where the surface is the same, its light has not changed, and the image
        /// rests on its pixels. Higher: less flicker, and more lag where a change is missed. 0: none, which saves a pass and
        /// 16 bytes per pixel. Changing it from or to 0 compiles; from 0, it starts a new history, as does raising `iterations` from 0.
        steadiness: f32 { default: 0.9, classic: 0.0, range: 0..=1, compiles: Sometimes }

        /// How many times as bright as its surroundings a sample may be, where not several around are as bright: brighter ones are
        /// taken for outliers and have no weight. Higher: more of the light that one path in ten thousand finds is kept, and more of
        /// what a renderer's fireflies leave. Lower: the reverse; below 20, common noise loses energy. 0: everything is believed,
        /// which saves three passes over strata. Changing it from or to 0 compiles; from 0, it starts a new history.
        outlier_limit: f32 { default: 40.0, classic: 0.0, range: 0..=1e6, useful: 0..=1e3, compiles: Sometimes }

        /// Pixels whose noise (deviation over luminance) is below this are left as they are, in whatever iteration they get there.
        /// Higher: less time where there is little noise, and more of it stays. Lower: the filter blurs what no longer needs it.
        /// 0: never.
        converged: f32 { default: 0.03, classic: 0.0, range: 0..=1 }

        /// Luminance stop in standard deviations of the noise. Higher: smoother, edges of shadows blur. 0 mixes only equals.
        sigma_luminance: f32 { default: 4.0, range: 0..=1e6, useful: 0..=32 }

        /// Depth stop. Default stops: tolerated distance from the tangent plane, in parts of the depth. Classic: in depth
        /// gradients. Higher: leaks across edges. Lower: noise stays on curved surfaces.
        sigma_depth: f32 { default: 0.0025, classic: 1.0, range: 1e-6..=1e6, useful: 1e-4..=10.0, scale: logarithmic }

        /// Normal stop: the exponent. Higher: sharper normal edges, noise stays on curved surfaces.
        sigma_normal: f32 { default: 32.0, classic: 128.0, range: 0..=1e6, useful: 0..=256 }

        /// Foreshortening stop of the default stops: by how much taps weigh less that are farther away on the surface than on the
        /// image. Higher: sharper shadows on surfaces at a grazing angle, and more noise there. 0: taps weigh by their distance on
        /// the image alone.
        sigma_foreshortening: f32 { default: 0.25, classic: 0.0, range: 0..=1e6, useful: 0..=8 }
    }
}

impl FilterSettings {
    /// The formulas of A-SVGF as published, with the customary values.
    pub fn classic() -> Self {
        super::Published::published()
    }
}

listed! {
    /// The source of the temporal gradient, and with it of the adaptive α.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Gradient {
        /// [`Gradient::Reshade`] where the denoiser traces the paths. In a host's frame: [`Gradient::Lambda`] if it has λ, else
        /// [`Gradient::Pairs`] if it has pairs, else [`Gradient::Statistics`].
        Automatic = "automatic",
        /// One pixel of each 3×3 repeats a path of the last frame, random numbers included, in this frame's scene (Schied et al.
        /// 2018): sees every change of light, shadow and geometry. Costs no extra ray. Where the host renders,
        /// [`Denoiser::begin_frame`](crate::Denoiser::begin_frame) says which pixels and paths.
        Reshade = "reshade",
        /// The mean of the new samples against that of their histories, over 21 to 93 pixels of a surface around, less the noise of both:
        /// needs nothing but the image and its G-buffer. Sees every change that is greater than the noise of a thousand samples, a few
        /// frames later than repeated paths do where light moves.
        Statistics = "statistics",
        /// Deferred Blinn–Phong shading of this and the last frame's lights, without shadows: no ray, no noise, blind to what
        /// blocks the light. Only for the crate's own path tracer, because it needs the scene.
        BlinnPhong = "blinn-phong",
        /// Pairs that the host made, see [`Pairs`](crate::Pairs). Only for frames of a host's renderer.
        Pairs = "pairs",
        /// λ itself, or a confidence, from the host, see [`Lambda`](crate::Lambda). Only for frames of a host's renderer.
        Lambda = "lambda",
        /// None: α is constant.
        Off = "off",
    }
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

listed! {
    /// How λ enters the weight α' of the new frame.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Blend {
        /// α' = 1/n with the shortened history length n.
        HistoryLength = "history-length",
        /// α' = (1 − λ)·α + λ as published, and at least 1/n.
        Lambda = "lambda",
    }
}

listed! {
    /// The variance that steers the luminance stop.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Variance {
        /// That of the accumulated mean: (m₂ − m₁²)/n.
        OfMean = "of-mean",
        /// That of one sample: m₂ − m₁².
        OfSample = "of-sample",
    }
}

listed! {
    /// Formulas of the edge stops.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Stops {
        /// Distance from the tangent plane, exp(−σ·(1 − n·n')), foreshortening, and squared luminance difference less the noise of
        /// both ends.
        NoiseSubtracted = "noise-subtracted",
        /// exp(−|Δz|/(σ·|∇z·Δp|)), max(0, n·n')^σ, exp(−|Δl|/(σ·√Var)).
        Classic = "classic",
    }
}

listed! {
    /// Taps of a spatial iteration.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Kernel {
        /// The 13 taps of the B₃ spline's 5×5 with |x| + |y| ≤ 2: as good, at half the price.
        Diamond = "diamond",
        /// All 25.
        Full = "full",
    }
}
