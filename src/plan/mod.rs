//! What to run and why, as plain data: a pure function of the settings, of what a scene, or a host's views, have, and of what
//! changed since the last frame.
//!
//! The plan lists the passes in order, each with the features that are compiled into its shader and the images that it reads
//! and writes, and a reason for whatever is in or left out. [`Denoiser`](crate::Denoiser) only carries it out. Printed
//! (`{plan}`) it is a table; [`Plan::graph`] draws it.

#[cfg(feature = "path-tracer")]
mod batches;
mod changes;
mod choice;
mod decision;
mod display;
mod feature;
mod image;
mod memory;
mod traits;

#[cfg(feature = "path-tracer")]
pub(crate) use batches::Batches;
pub use changes::Changes;
pub use decision::Decision;
pub use feature::{Feature, Features};
pub use image::{Grid, Image};
pub(crate) use memory::{Kind, Memory, needed};
pub use traits::{HostTraits, Traits, Traversal};

use crate::passes::{self, Pass};
use crate::settings::{Mode, Settings};
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
    /// Which iteration of a filter, from 0: taps are 2ⁱ apart. Of the path tracer, which batch of the paths.
    pub iteration: u32,
    /// The images behind its bindings, by name.
    pub bindings: Vec<(&'static str, Slot)>,
}

impl Step {
    /// Which batch of the frame's paths it traces.
    pub(crate) fn batch(&self) -> u32 {
        match self.pass {
            #[cfg(feature = "path-tracer")]
            Pass::Trace => self.iteration,
            _ => 0,
        }
    }

    /// The same step for an adapter that is the CPU, see [`Feature::StorageReads`].
    pub(crate) fn on_cpu(mut self) -> Self {
        let reads = match self.pass {
            Pass::GradientPairsFilter | Pass::GradientMeansFilter | Pass::GradientFilter => true,
            Pass::Atrous | Pass::Steady | Pass::OutlierCandidates => true,
            // Four storage textures are all that is sure to be had: it reads one in a still image, else two.
            Pass::Temporal => {
                let has = |feature| u32::from(self.features.has(feature));
                let written = 1 + has(Feature::Feedback) + has(Feature::Steady) + has(Feature::KeepWeights);
                written + 2 - has(Feature::Still) <= 4
            }
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
    /// Everything that was decided, and why.
    pub decisions: Vec<Decision>,
    /// Where the filtered colour ends up, if anything is filtered.
    pub color: Option<Image>,
    /// Where the gradient ends up, if there is one.
    pub gradient: Option<Image>,
}

impl Plan {
    /// The passes that a path-traced frame needs.
    #[cfg(feature = "path-tracer")]
    pub fn path_traced(traits: &Traits, settings: &Settings, changes: Changes, target: TextureFormat) -> Self {
        let mut plan = Self::of(choice::traced(traits, settings, changes), target);
        let features = plan.features;
        plan.steps.push(passes::visibility::step(features));
        if features.has(Feature::Gradient) && !features.has(Feature::Statistics) {
            plan.steps.push(passes::gradient_sample::step(features));
        }
        let batches = Batches::of(traits, &settings.tracer).count();
        plan.steps.extend((0..batches).map(|batch| passes::trace::step(features, batch, batches)));
        plan.filter(settings);
        plan.steps.push(passes::resolve::step(features, plan.color));
        plan
    }

    /// The passes that a frame of the host's own renderer needs.
    pub fn hosted(traits: &HostTraits, settings: &Settings, changes: Changes, target: TextureFormat) -> Self {
        let mut plan = Self::of(choice::hosted(traits, settings, changes), target);
        let features = plan.features;
        plan.steps.push(passes::ingest_surface::step(features));
        if features.has(Feature::Reshade) {
            plan.steps.push(passes::gradient_sample::step(features));
            plan.steps.push(passes::reshade::step(features));
        }
        if !features.has(Feature::HostLight) {
            plan.steps.push(passes::ingest_radiance::step(features));
        }
        if features.has(Feature::Pairs) {
            plan.steps.push(passes::ingest_pairs::step(features));
        }
        plan.filter(settings);
        plan.steps.push(passes::resolve::step(features, plan.color));
        plan
    }

    /// No steps yet, for these decisions.
    fn of(mut decisions: Vec<Decision>, target: TextureFormat) -> Self {
        let narrow = target == TextureFormat::Rgba16Float;
        decisions.push(Decision::new(Feature::TargetF16, narrow, ["the target is 16-bit", "the target is 32-bit"]));
        let features = decisions.iter().filter(|d| d.included).map(|d| d.feature).collect();
        Self { steps: Vec::new(), features, decisions, color: None, gradient: None }
    }

    /// Whether the mean goes on over all frames there were, however many: nothing changed, and α is adaptive.
    pub(crate) fn converges(&self) -> bool {
        let has = |feature| self.features.has(feature);
        has(Feature::Still) && has(Feature::Unchanged) && !has(Feature::BlendByLambda)
    }

    /// How many of the steps are those of a host's surfaces, which [`Denoiser::begin_frame`](crate::Denoiser::begin_frame) records.
    /// Until the others are known, nothing that they may need is written over.
    pub fn surface_steps(&self) -> usize {
        let surface = |pass| matches!(pass, Pass::IngestSurface | Pass::GradientSample | Pass::Reshade);
        self.steps.iter().take_while(|step| surface(step.pass)).count()
    }

    /// The passes from noisy radiance to filtered colour, if the mode filters.
    fn filter(&mut self, settings: &Settings) {
        if settings.mode != Mode::Denoise {
            return;
        }
        let Settings { filter, .. } = settings;
        let features = self.features;
        if features.has(Feature::Outliers) {
            self.steps.push(passes::outlier_candidates::step(features));
            self.steps.push(passes::outlier_counts::step());
            self.steps.push(passes::outlier_limit::step());
        }
        if features.has(Feature::Statistics) {
            self.steps.push(passes::gradient_means::step(features));
            let levels = 0..passes::gradient_of_means::COARSEST;
            self.steps.extend(levels.map(|level| passes::gradient_means_filter::step(features, level)));
            self.steps.push(passes::gradient_of_means::step(features));
            self.gradient = Some(Image::Gradient(0));
        } else if features.has(Feature::Gradient) {
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
        let mut iterations = filter.iterations;
        if features.has(Feature::SmallKernel) {
            self.steps.push(passes::atrous::last_step(features, iterations));
            iterations += 1;
        }
        let color = Image::Color((iterations % 2) as u8);
        self.color = Some(color);
        if features.has(Feature::Steady) {
            self.steps.push(passes::steady::step(features, color));
            self.color = Some(Image::Output);
        }
    }

    /// The same plan for an adapter that is the CPU.
    pub(crate) fn on_cpu(mut self) -> Self {
        self.steps = self.steps.into_iter().map(Step::on_cpu).collect();
        let reads = self.steps.iter().any(|step| step.features.has(Feature::StorageReads));
        let why = ["the adapter is the CPU: cheaper there than texture fetches", ""];
        self.decisions.extend(reads.then(|| Decision::new(Feature::StorageReads, true, why)));
        self
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
