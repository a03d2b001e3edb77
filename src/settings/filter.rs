//! Settings of the filter.

use super::declare::settings;
use crate::listed::listed;

settings! {
    /// Settings of the filter. docs/filter.md has the measurements behind the defaults.
    pub struct FilterSettings in filter {
        /// The source of the temporal gradient.
        gradient: Gradient { default: Gradient::Automatic, classic: Gradient::Reshade, compiles: Always }

        /// Lower bound on the weight α of a new frame: a history is worth at most (2 − α)/α samples. Higher: noisier, but the filter
        /// forgets sooner where the gradient misses a change. Lower: smoother, but slower to forget. With [`Gradient::Off`], this is
        /// the constant α of the moving average.
        alpha: f32 { default: 0.02, classic: 0.2, range: 0..=1, scale: logarithmic }

        // Beyond 32768 frames, rounding adds more than averaging takes away.
        /// Longest history: the weight of a new frame is 1/n until the length n reaches this limit, and constant from there on.
        /// Higher: smoother still images. Lower: noisier, but old light is forgotten sooner.
        max_history: f32 {
            default: 64.0,
            range: 1..=32768,
            unit: "frames",
            most: LONGEST_HISTORY,
            useful: 1..=1024,
            scale: logarithmic,
        }

        /// Exponent k in n ← n·(1 − λ)ᵏ + 1, the law by which the gradient λ shortens a history. Higher: less lag, more noise after a
        /// change. Lower: more lag, less noise. 0 never shortens a history.
        history_power: f32 { default: 3.5, classic: 10.0, range: 0..=64, useful: 0..=16 }

        /// Filters the path tracer's specular light as a signal of its own, whose history follows reflections instead of surfaces.
        /// On: reflections do not smear. Off: less time and less memory where something shines. A change starts a new history. Has no
        /// effect on a host's frame, because the host decides what it hands in, see [`Gloss`](crate::Gloss).
        gloss: bool { default: true, classic: false, compiles: Always }

        /// The same exponent k for specular light. Higher: less lag, more noise after a change. Lower: more lag, less noise.
        gloss_history_power: f32 { default: 10.0, classic: 10.0, range: 0..=64, useful: 0..=16 }

        /// Rescales the history before blending, by the ratio that the gradient samples show, and drops only the change that this
        /// ratio leaves unexplained. On: less lag and less noise where light moves or dims. Has no effect with
        /// [`Gradient::BlinnPhong`], because analytic shading is blind to shadows, nor with [`Gradient::Lambda`] and
        /// [`Gradient::Off`], because they have no samples.
        history_ratio: bool { default: true, classic: false, compiles: Always }

        /// Iterations that spread the history ratio over the strata. More: a steadier ratio, spread farther from the place where the
        /// light changed. Fewer: a noisier ratio; with 0, each stratum uses the ratio of its own path. Changing it from 0 compiles.
        ratio_iterations: u32 { default: 3, range: 0..=7, most: MOST_RATIO_ITERATIONS, compiles: Sometimes }

        /// Exponent γ in λ = A\[Δ^(γ−1)·|δ|\] / A\[Δ^γ\]. Higher: a bright steady light hides a dim change beside it. Lower: a change
        /// that few samples see counts as much as one that all see.
        gradient_gamma: f32 { default: 0.5, classic: 0.0, range: 0..=1 }

        /// Iterations that spread the gradient over the strata; each doubles the reach (3, 9, 21 pixels …). More: a steadier gradient,
        /// but more history is dropped around a change. Fewer: a noisier gradient, which stays where the change is. Changing it from 0
        /// compiles.
        gradient_iterations: u32 {
            default: 2,
            classic: 3,
            range: 0..=7,
            most: MOST_GRADIENT_ITERATIONS,
            compiles: Sometimes,
        }

        /// Raises λ to at least the change that nearby paths saw together, on whatever surface. Off: thin objects and corners keep
        /// ghosts of changes that their own few paths missed. On: near a change, a little more history is dropped.
        gradient_across_surfaces: bool { default: true, classic: false, compiles: Always }

        /// Lets differences of opposite sign cancel in λ = max(0, |A\[Δ^(γ−1)·δ\]| / A\[Δ^γ\] − dead zone). Meant for hosts whose pairs
        /// do not repeat their random numbers, because each difference is then mostly noise. Combine it with 5 `gradient_iterations`
        /// and a `gradient_dead_zone` of 0.1. On: the differences of a moving shadow cancel too, so repeat the numbers where you can.
        gradient_signed: bool { default: false, compiles: Always }

        /// Amount that is subtracted from λ. Higher: noise in the gradient costs no history, but small changes of light lag. Lower:
        /// small changes are followed, but noise shortens the history.
        gradient_dead_zone: f32 { default: 0.0, range: 0..=1 }

        /// Formula by which λ enters the weight of a new frame.
        blend: Blend { default: Blend::HistoryLength, classic: Blend::Lambda, compiles: Always }

        /// Feeds the colour of the first spatial iteration back into the history, as SVGF does. On: smoother at first, but the blur
        /// stays for good. Off: the history stays sharp, and is noisier at first.
        feedback: bool { default: false, classic: true, compiles: Always }

        /// The variance that steers the luminance stop.
        variance: Variance { default: Variance::OfMean, classic: Variance::OfSample, compiles: Always }

        /// Formulas of the edge stops.
        stops: Stops { default: Stops::NoiseSubtracted, classic: Stops::Classic, compiles: Always }

        /// Taps of a spatial iteration.
        kernel: Kernel { default: Kernel::Diamond, classic: Kernel::Full, compiles: Always }

        /// Fits a plane to the taps instead of averaging them. On: sharper borders and penumbrae for 5 % more time.
        local_linear_fit: bool { default: true, classic: false, compiles: Always }

        /// Ridge on the slopes of the fitted plane. Higher: closer to the mean, so edges blur. Lower: the plane follows noise.
        ridge: f32 { default: 0.25, range: 1e-6..=1e6, useful: 1e-3..=100.0, scale: logarithmic }

        /// Strength with which the ridge follows the noise of the slope: a factor on its variance over its square, within ½…8 times
        /// `ridge`. Higher: smoother where there is noise, but blurrier penumbrae. Lower: the plane follows noise. 0: the ridge is
        /// constant. Changing it from or to 0 compiles.
        ridge_noise: f32 { default: 1.5, classic: 0.0, range: 0..=1e6, useful: 0..=16, compiles: Sometimes }

        /// Spatial iterations, with steps of 1, 2, 4 … pixels. More: smoother, but slower and blurrier. Fewer: faster and sharper, but
        /// noisier. Specular light has three at most. Changing it from 0 or 1, or to 0, compiles.
        iterations: u32 { default: 4, classic: 5, range: 0..=8, most: MOST_SPATIAL_ITERATIONS, compiles: Sometimes }

        /// Adds an iteration over the nine nearest taps. On: less error and less flicker, for a seventh of the spatial filter's time.
        final_iteration: bool { default: true, classic: false, compiles: Always }

        /// Highest weight of the last output in this one. It applies where the surface is the same, its light has not changed, and the
        /// image rests on its pixels. Higher: less flicker, but more lag where a change is missed. Lower: more flicker, less lag. 0 turns
        /// it off, which saves a pass and 16 bytes per pixel. Changing it from or to 0 compiles. Changing it from 0 also starts a new
        /// history, and so does raising `iterations` from 0.
        steadiness: f32 { default: 0.9, classic: 0.0, range: 0..=1, compiles: Sometimes }

        /// Highest brightness of a sample, as a multiple of its surroundings, unless several samples around it are as bright. Brighter
        /// samples are outliers and get no weight. Higher: more of the light that one path in ten thousand finds is kept, but more of a
        /// renderer's fireflies stay. Lower: fewer fireflies, but less of that light; below 20, common noise loses energy. 0 keeps
        /// every sample, which saves three passes over strata. Changing it from or to 0 compiles. Changing it from 0 also starts a new
        /// history.
        outlier_limit: f32 { default: 40.0, classic: 0.0, range: 0..=1e6, useful: 0..=1e3, compiles: Sometimes }

        /// Noise (standard deviation over luminance) below which the spatial filter leaves a pixel alone, from the iteration on in which
        /// the pixel gets there. Higher: less time where there is little noise, but more of it stays. Lower: the filter blurs pixels that
        /// no longer need it. 0 filters every pixel.
        converged: f32 { default: 0.03, classic: 0.0, range: 0..=1 }

        /// Luminance stop in standard deviations of the noise. Higher: smoother, but edges of shadows blur. Lower: edges of shadows stay
        /// sharp, and noise stays too. 0 mixes only pixels of equal luminance.
        sigma_luminance: f32 { default: 4.0, range: 0..=1e6, useful: 0..=32 }

        /// The same stop for specular light, which has sharper borders. Higher: smoother, but what is reflected blurs. Lower: sharper,
        /// but noisier.
        gloss_sigma_luminance: f32 { default: 2.5, classic: 4.0, range: 0..=1e6, useful: 0..=32 }

        /// Greatest luminance of accumulated specular light that the spatial filter takes in, as a multiple of the third largest of the
        /// 24 pixels around. The history keeps the light above, and the pixels around get up to half of their own light from it. Higher:
        /// less of a lone highlight's light is lost, but spots stay where noise is strong. Lower: smoother, but darker. 0 takes in
        /// everything, which saves 25 taps where histories are long. Changing it from or to 0 compiles.
        gloss_clamp: f32 { default: 2.0, classic: 0.0, range: 0..=1e6, useful: 0..=16, compiles: Sometimes }

        /// Speed with which reflections that slide over a surface shorten the history, where one radiance holds diffuse and specular
        /// light: 1/n grows by this times the specular part, the square of the smoothness, and the pixels that reflections move.
        /// Higher: sharper reflections, but noisier. Lower: smoother, but reflections smear. 0 leaves the history as long as elsewhere.
        gloss_parallax: f32 { default: 1.0, classic: 0.0, range: 0..=1e3, useful: 0..=4 }

        /// Depth stop. With the default stops: tolerated distance from the tangent plane, as a fraction of the depth. With the classic
        /// stops: in depth gradients. Higher: light leaks across edges. Lower: noise stays on curved surfaces.
        sigma_depth: f32 { default: 0.0025, classic: 1.0, range: 1e-6..=1e6, useful: 1e-4..=10.0, scale: logarithmic }

        /// Exponent of the normal stop. Higher: sharper normal edges, but noise stays on curved surfaces. Lower: smoother curved
        /// surfaces, but normal edges blur.
        sigma_normal: f32 { default: 32.0, classic: 128.0, range: 0..=1e6, useful: 0..=256 }

        /// Foreshortening stop of the default stops: reduces the weight of taps that are farther away on the surface than in the image.
        /// Higher: sharper shadows on surfaces at a grazing angle, but more noise there. Lower: smoother, but such shadows blur. 0 weighs
        /// taps by their distance in the image alone.
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
        /// The best source that is at hand. Where the denoiser traces the paths: [`Gradient::Reshade`]. In a host's frame:
        /// [`Gradient::Lambda`] if it has λ, else [`Gradient::Pairs`] if it has pairs, else [`Gradient::Statistics`].
        Automatic = "automatic",
        /// Repeated paths: one pixel of each 3×3 repeats a path of the last frame, random numbers included, in this frame's scene
        /// (Schied et al. 2018). Sees every change of light, shadow and geometry, and costs no extra ray. Where the host renders,
        /// [`Denoiser::begin_frame`](crate::Denoiser::begin_frame) says which pixels and paths to repeat.
        Reshade = "reshade",
        /// The mean of the new samples against that of their histories, over 21 to 93 nearby pixels of a surface, less the noise of
        /// both. Needs nothing but the image and its G-buffer. Sees every change that exceeds the noise of a thousand samples, but where
        /// light moves, a few frames later than repeated paths do.
        Statistics = "statistics",
        /// Deferred Blinn–Phong shading of the lights of this and the last frame, without shadows: no ray and no noise, but blind to
        /// everything that blocks the light. Only for the crate's own path tracer, because it needs the scene.
        BlinnPhong = "blinn-phong",
        /// Pairs of radiance from the host, see [`Pairs`](crate::Pairs). Only for frames of a host's renderer.
        Pairs = "pairs",
        /// λ itself, or a confidence, from the host, see [`Lambda`](crate::Lambda). Only for frames of a host's renderer.
        Lambda = "lambda",
        /// No gradient: α is constant.
        Off = "off",
    }
}

impl Gradient {
    /// Resolves `Automatic` for frames whose paths the denoiser traces.
    #[cfg(feature = "path-tracer")]
    pub(crate) fn traced(self) -> Self {
        if self == Self::Automatic { Self::Reshade } else { self }
    }

    /// Resolves `Automatic` for a host's frame with or without λ and pairs.
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
    /// Formula by which λ enters the weight α' of a new frame.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Blend {
        /// α' = 1/n with the shortened history length n.
        HistoryLength = "history-length",
        /// α' = (1 − λ)·α + λ as published, but at least 1/n.
        Lambda = "lambda",
    }
}

listed! {
    /// The variance that steers the luminance stop.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Variance {
        /// Variance of the accumulated mean: (m₂ − m₁²)/n.
        OfMean = "of-mean",
        /// Variance of one sample: m₂ − m₁².
        OfSample = "of-sample",
    }
}

listed! {
    /// Formulas of the edge stops.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Stops {
        /// Distance from the tangent plane, exp(−σ·(1 − n·n')), foreshortening, and the squared luminance difference less the noise of
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
        /// The 13 taps of the B₃ spline's 5×5 with |x| + |y| ≤ 2: as good as all 25, at half the price.
        Diamond = "diamond",
        /// All 25 taps.
        Full = "full",
    }
}
