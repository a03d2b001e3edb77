//! What to run and why, as plain data: a pure function of the settings and of what a scene, or a host's views, have.
//!
//! The plan lists the passes in order, each with the features that are compiled into its shader and the images that it reads
//! and writes. [`Denoiser`](crate::Denoiser) only carries it out.

mod choice;
mod feature;
mod image;
mod traits;

pub use feature::{Feature, Features};
pub use image::{Grid, Image};
pub use traits::{HostTraits, Traits, Traversal};

use crate::passes::{self, Pass};
use crate::settings::{FilterSettings, Mode, Settings};
use std::collections::BTreeSet;
use wgpu::TextureFormat;

/// What a binding of a pass is bound to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Slot {
    /// This frame's image.
    Now(Image),
    /// The previous frame's image.
    Before(Image),
    /// The host's target.
    Target,
    /// The host's view of the binding's name.
    Host,
}

/// One dispatch.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The shader.
    pub pass: Pass,
    /// What is compiled into it.
    pub features: Features,
    /// Its invocations.
    pub grid: Grid,
    /// Which iteration of a filter, from 0: taps are 2ⁱ apart.
    pub iteration: u32,
    /// The images behind its bindings, by name.
    pub bindings: Vec<(&'static str, Slot)>,
}

impl Step {
    /// The same step for an adapter that is the CPU, see [`Feature::StorageReads`].
    pub(crate) fn on_cpu(mut self) -> Self {
        let reads = match self.pass {
            Pass::GradientPairsFilter | Pass::GradientFilter | Pass::Temporal | Pass::Atrous => true,
            #[cfg(feature = "path-tracer")]
            Pass::Trace => true,
            // With instances it writes as many storage textures as there may be.
            #[cfg(feature = "path-tracer")]
            Pass::Visibility => !self.features.has(Feature::Instanced),
            _ => false,
        };
        if reads {
            self.features = self.features.with(Feature::StorageReads);
        }
        self
    }
}

/// What to run in a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The dispatches in order.
    pub steps: Vec<Step>,
    /// Everything that was decided to be in.
    pub features: Features,
    /// Where the filtered colour ends up, if anything is filtered.
    pub color: Option<Image>,
    /// Where the gradient ends up, if there is one.
    pub gradient: Option<Image>,
}

impl Plan {
    /// The passes that a path-traced frame needs.
    #[cfg(feature = "path-tracer")]
    pub fn path_traced(traits: &Traits, settings: &Settings, target: TextureFormat) -> Self {
        let features = choice::traced(traits, settings);
        let features = if target == TextureFormat::Rgba16Float { features.with(Feature::TargetF16) } else { features };
        let mut plan = Self { steps: vec![passes::visibility::step(features)], features, color: None, gradient: None };
        let denoise = settings.mode == Mode::Denoise;
        if denoise && features.has(Feature::Gradient) {
            plan.steps.push(passes::gradient_sample::step(features));
        }
        plan.steps.push(passes::trace::step(features));
        if denoise {
            plan.filter(&settings.filter);
        }
        plan.steps.push(passes::resolve::step(features, plan.color));
        plan
    }

    /// The passes that a frame of the host's own renderer needs.
    pub fn hosted(traits: &HostTraits, settings: &Settings, target: TextureFormat) -> Self {
        let features = choice::hosted(traits, settings);
        let features = if target == TextureFormat::Rgba16Float { features.with(Feature::TargetF16) } else { features };
        let mut plan =
            Self { steps: vec![passes::ingest_surface::step(features)], features, color: None, gradient: None };
        if features.has(Feature::Reshade) {
            plan.steps.push(passes::gradient_sample::step(features));
            plan.steps.push(passes::reshade::step(features));
        }
        plan.steps.push(passes::ingest_radiance::step(features));
        if features.has(Feature::Pairs) {
            plan.steps.push(passes::ingest_pairs::step(features));
        }
        if settings.mode == Mode::Denoise {
            plan.filter(&settings.filter);
        }
        plan.steps.push(passes::resolve::step(features, plan.color));
        plan
    }

    /// How many of the steps need no radiance: those that [`Denoiser::begin_frame`](crate::Denoiser::begin_frame) records.
    pub fn surface_steps(&self) -> usize {
        self.steps.iter().take_while(|step| step.pass != Pass::IngestRadiance).count()
    }

    /// The passes from noisy radiance to filtered colour.
    fn filter(&mut self, filter: &FilterSettings) {
        let features = self.features;
        if features.has(Feature::Gradient) {
            if features.has(Feature::HistoryRatio) {
                self.steps.push(passes::gradient_pairs::step(features));
                let filters = (0..filter.ratio_iterations).map(|i| passes::gradient_pairs_filter::step(features, i));
                self.steps.extend(filters);
            }
            self.steps.push(passes::gradient::step(features, (filter.ratio_iterations % 2) as u8));
            let iterations = filter.gradient_iterations;
            self.steps.extend((0..iterations).map(|i| passes::gradient_filter::step(features, i)));
            self.gradient = Some(Image::Gradient((iterations % 2) as u8));
        }
        self.steps.push(passes::temporal::step(features, self.gradient));
        if features.has(Feature::TemporalOnly) {
            self.color = Some(Image::History);
            return;
        }
        self.steps.push(passes::variance::step(features));
        self.steps.extend((0..filter.iterations).map(|i| passes::atrous::step(features, i)));
        self.color = Some(Image::Color((filter.iterations % 2) as u8));
    }

    /// The same plan for an adapter that is the CPU.
    pub(crate) fn on_cpu(self) -> Self {
        Self { steps: self.steps.into_iter().map(Step::on_cpu).collect(), ..self }
    }

    /// The images that the steps use, each once, and whether the previous frame's is used too.
    pub fn images(&self) -> Vec<(Image, bool)> {
        let slots = || self.steps.iter().flat_map(|s| &s.bindings).map(|(_, slot)| *slot);
        let before: BTreeSet<Image> =
            slots().filter_map(|s| if let Slot::Before(i) = s { Some(i) } else { None }).collect();
        let all: BTreeSet<Image> =
            slots().filter_map(|s| if let Slot::Now(i) | Slot::Before(i) = s { Some(i) } else { None }).collect();
        all.into_iter().map(|i| (i, before.contains(&i))).collect()
    }
}
