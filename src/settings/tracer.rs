//! How paths are traced.

use super::declare::settings;
use crate::listed::listed;

settings! {
    /// How paths are traced. Paths of other settings are not those of the last frame: with re-shading, a change drops what history it
    /// contradicts.
    #[derive(Eq)]
    pub struct TracerSettings in tracer {
        /// Paths per pixel and frame. Higher: less noise, proportionally slower. Many are traced in several dispatches, because one
        /// might be taken for hung; going from one dispatch to several compiles. Systems that time submissions instead of dispatches
        /// need a host that submits in between: [`Denoiser::render_stepwise`](crate::Denoiser::render_stepwise).
        samples: u32 { default: 1, range: 1..=65536, unit: "samples per pixel", useful: 1..=16, compiles: Sometimes }

        /// Reflections after the first surface; 0 is direct light only. Higher: brighter corners, slower. A path is never divided among
        /// dispatches: some hundred bounces without roulette may be ended by the driver, and are then missing. Longer paths need
        /// several dispatches sooner, and going from one to several compiles.
        bounces: u32 { default: 3, range: 0..=1024, unit: "bounces", useful: 0..=16, compiles: Sometimes }

        /// Bounce from which Russian roulette may end a path. Higher: less noise, slower, and several dispatches sooner: going
        /// from one to several compiles.
        roulette: u32 { default: 3, useful: 0..=16, compiles: Sometimes }

        /// The estimator of direct light.
        sampling: Sampling { default: Sampling::Both, compiles: Always }

        /// Another number gives other noise.
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
