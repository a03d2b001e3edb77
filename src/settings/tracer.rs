//! Settings of the path tracer.

use super::declare::settings;
use crate::listed::listed;

settings! {
    /// Settings of the path tracer. A change of settings makes this frame's paths differ from those of the last frame: with
    /// re-shading, the filter then drops the history that they contradict.
    #[derive(Eq)]
    pub struct TracerSettings in tracer {
        /// Paths per pixel and frame. Higher: less noise, proportionally slower. Lower: faster, noisier. The driver might end one long
        /// dispatch as hung, so many paths are traced in several dispatches; going from one dispatch to several compiles. Systems that
        /// time submissions instead of dispatches need a host that submits in between:
        /// [`Denoiser::stepwise`](crate::Denoiser::stepwise).
        samples: u32 { default: 1, range: 1..=65536, unit: "samples per pixel", useful: 1..=16, compiles: Sometimes }

        /// Reflections after the first surface; 0 is direct light only. Higher: brighter corners, slower. Lower: faster, darker corners.
        /// A path is never divided among dispatches: the driver may end a path of some hundred bounces without roulette, and its light is
        /// then missing. Longer paths need several dispatches sooner; going from one dispatch to several compiles.
        bounces: u32 { default: 3, range: 0..=1024, unit: "bounces", useful: 0..=16, compiles: Sometimes }

        /// First bounce at which Russian roulette may end a path. Higher: less noise, but slower. Lower: faster, noisier. A higher value
        /// needs several dispatches sooner; going from one dispatch to several compiles.
        roulette: u32 { default: 3, useful: 0..=16, compiles: Sometimes }

        /// The estimator of direct light.
        sampling: Sampling { default: Sampling::Both, compiles: Always }

        /// Seed of the random numbers. Another number gives other noise, no more and no less.
        seed: u32 { default: 0 }
    }
}

listed! {
    /// The estimator of direct light. All have the same mean (except that scattered rays alone never find a light without
    /// area); they differ in noise.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Sampling {
        /// Light samples and scattered rays, weighted by the power heuristic (Veach 1997).
        Both = "both",
        /// Light samples alone.
        Lights = "lights",
        /// Scattered rays alone.
        Scattered = "scattered",
    }
}
