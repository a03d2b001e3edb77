//! The passes of a frame and the reasons for them, as plain data. A plan is a pure function of the settings, of the contents of a scene
//! or of a host's views, and of the changes since the last frame.
//!
//! The plan lists the passes in order, each with the features that are compiled into its shader and the images that it reads
//! and writes, and a reason for everything that is in or left out. [`Denoiser`](crate::Denoiser) only carries it out. The plan prints
//! as a table (`{plan}`); [`Plan::graph`] draws it.

#[cfg(feature = "path-tracer")]
mod batches;
mod changes;
mod choice;
mod contents;
mod decision;
mod display;
mod memory;
mod show;

pub use crate::passes::{Bound, Feature, Features, Grid, HostView, Image, Slot, Step, Traversal};
#[cfg(feature = "path-tracer")]
pub(crate) use batches::Batches;
pub use changes::Changes;
pub use contents::{HostInputs, SceneContents};
pub use decision::Decision;
pub(crate) use memory::{Kind, Memory, needed};

use crate::passes::*;
use crate::settings::{Mode, Settings};
use std::collections::BTreeSet;
use wgpu::TextureFormat;

/// The passes of a frame.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Plan {
    /// The dispatches in order.
    pub steps: Vec<Step>,
    /// The features that are in.
    pub features: Features,
    /// The decisions, each with its reason.
    pub decisions: Vec<Decision>,
    /// The image that ends with the filtered colour, if the mode filters.
    pub color: Option<Image>,
    /// The image that ends with the filtered gradient, if there is one.
    pub gradient: Option<Image>,
}

impl Plan {
    /// Plans the passes that a path-traced frame needs.
    #[cfg(feature = "path-tracer")]
    pub fn path_traced(contents: &SceneContents, settings: &Settings, changes: Changes, target: TextureFormat) -> Self {
        let mut plan = Self::of(choice::traced(contents, settings, changes), target);
        plan.run(&visibility::PASS);
        if plan.has(Feature::Gradient) && !plan.has(Feature::Statistics) {
            plan.run(&gradient_sample::PASS);
        }
        plan.trace(Batches::of(contents, &settings.tracer).count());
        plan.filter(settings);
        plan.run_on(&resolve::PASS, plan.color);
        plan
    }

    /// Plans the passes that a frame of the host's own renderer needs.
    pub fn hosted(inputs: &HostInputs, settings: &Settings, changes: Changes, target: TextureFormat) -> Self {
        let mut plan = Self::of(choice::hosted(inputs, settings, changes), target);
        plan.run(&ingest_surface::PASS);
        if plan.has(Feature::Reshade) {
            plan.run(&gradient_sample::PASS);
            plan.run(&reshade::PASS);
        }
        if !plan.has(Feature::HostLight) {
            plan.run(&ingest_radiance::PASS);
        }
        if plan.has(Feature::Pairs) {
            plan.run(&ingest_pairs::PASS);
        }
        plan.filter(settings);
        plan.run_on(&resolve::PASS, plan.color);
        plan
    }

    /// A plan without steps yet, for these decisions.
    fn of(mut decisions: Vec<Decision>, target: TextureFormat) -> Self {
        let narrow = target == TextureFormat::Rgba16Float;
        decisions.push(Decision::new(Feature::TargetF16, narrow, ["the target is 16-bit", "the target is 32-bit"]));
        let features = decisions.iter().filter(|d| d.included).map(|d| d.feature).collect();
        Self { steps: Vec::new(), features, decisions, color: None, gradient: None }
    }

    fn has(&self, feature: Feature) -> bool {
        self.features.has(feature)
    }

    /// Appends the only step of a pass.
    fn run(&mut self, pass: &'static Pass) {
        self.steps.push(Step::new(pass, self.features));
    }

    /// Appends a pass that reads a result that one of several images holds.
    fn run_on(&mut self, pass: &'static Pass, image: Option<Image>) {
        self.steps.push(Step::nth(pass, self.features, Nth::of(image)));
    }

    /// Appends a number of iterations of a pass.
    fn iterate(&mut self, pass: &'static Pass, iterations: u32) {
        let features = self.features;
        self.steps.extend((0..iterations).map(|i| Step::nth(pass, features, Nth::iteration(i))));
    }

    /// True if the mean continues over all frames so far, however many: nothing changed, and α is adaptive.
    pub(crate) fn converges(&self) -> bool {
        self.has(Feature::Still) && self.has(Feature::Unchanged) && !self.has(Feature::BlendByLambda)
    }

    /// The number of steps that take in a host's surfaces, which [`Denoiser::begin_frame`](crate::Denoiser::begin_frame) records.
    /// While the other steps are unknown, no image that they may need is overwritten.
    pub fn surface_steps(&self) -> usize {
        let surface = [&ingest_surface::PASS, &gradient_sample::PASS, &reshade::PASS];
        self.steps.iter().take_while(|step| surface.contains(&step.pass)).count()
    }

    /// Appends the dispatches that share a frame's paths: the first has no earlier paths, the last no later ones.
    #[cfg(feature = "path-tracer")]
    fn trace(&mut self, batches: u32) {
        let features = self.features;
        self.steps.extend((0..batches).map(|batch| {
            let begun = if batch > 0 { features.with(Feature::EarlierPaths) } else { features };
            let goes_on = batch + 1 < batches;
            let features = if goes_on { begun.with(Feature::LaterPaths) } else { begun.without(Feature::LaterPaths) };
            Step::nth(&trace::PASS, features, Nth::batch(batch))
        }));
    }

    /// Appends the passes from noisy radiance to filtered colour, if the mode filters.
    fn filter(&mut self, settings: &Settings) {
        if settings.mode != Mode::Denoise {
            return;
        }
        if self.has(Feature::Outliers) {
            self.run(&outlier_candidates::PASS);
            self.run(&outlier_counts::PASS);
            self.run(&outlier_limit::PASS);
        }
        if self.has(Feature::Gradient) {
            self.measure_gradient(settings);
        }
        self.run_on(&temporal::PASS, self.gradient);
        if self.has(Feature::TemporalOnly) {
            self.color = Some(Image::History);
        } else {
            self.filter_in_space(settings);
        }
    }

    /// Appends the passes that find λ and the history ratio.
    fn measure_gradient(&mut self, settings: &Settings) {
        let filter = &settings.filter;
        if self.has(Feature::Statistics) {
            self.run(&gradient_means::PASS);
            self.iterate(&gradient_means_filter::PASS, gradient_of_means::COARSEST.into());
            self.run(&gradient_of_means::PASS);
            self.gradient = Some(Image::Gradient(0));
            return;
        }
        if self.has(Feature::HistoryRatio) {
            self.run(&gradient_pairs::PASS);
            self.iterate(&gradient_pairs_filter::PASS, filter.ratio_iterations);
        }
        self.steps.push(Step::nth(&gradient::PASS, self.features, Nth::after(filter.ratio_iterations)));
        self.iterate(&gradient_filter::PASS, filter.gradient_iterations);
        self.gradient = Some(Image::Gradient((filter.gradient_iterations % 2) as u8));
    }

    /// Appends the variance, the à-trous iterations, and the blend with the last output.
    fn filter_in_space(&mut self, settings: &Settings) {
        self.run(&variance::PASS);
        let mut iterations = settings.filter.iterations;
        let wide = self.features.without(Feature::SmallKernel);
        self.steps.extend((0..iterations).map(|i| {
            let features = if i == 0 { wide.with(Feature::FirstIteration) } else { wide };
            Step::nth(&atrous::PASS, features, Nth::iteration(i))
        }));
        if self.has(Feature::SmallKernel) {
            self.steps.push(Step::nth(&atrous::PASS, self.features, Nth::after(iterations)));
            iterations += 1;
        }
        let color = Image::Color((iterations % 2) as u8);
        self.color = Some(color);
        if self.has(Feature::Steady) {
            self.run_on(&steady::PASS, self.color);
            self.color = Some(Image::Output);
        }
    }

    /// This plan for an adapter that is the CPU, see [`Feature::StorageReads`].
    pub(crate) fn on_cpu(mut self) -> Self {
        self.steps = self.steps.into_iter().map(Step::on_cpu).collect();
        let reads = self.steps.iter().any(|step| step.features.has(Feature::StorageReads));
        let why = ["the adapter is the CPU: cheaper there than texture fetches", ""];
        self.decisions.extend(reads.then(|| Decision::new(Feature::StorageReads, true, why)));
        self
    }

    /// The images that the steps use, each once, with true if the previous frame's is used too.
    pub fn images(&self) -> Vec<(Image, bool)> {
        let slots = || self.steps.iter().flat_map(|step| &step.bindings).map(|bound| bound.slot);
        let before: BTreeSet<Image> =
            slots().filter_map(|s| if let Slot::Before(i) = s { Some(i) } else { None }).collect();
        let all: BTreeSet<Image> =
            slots().filter_map(|s| if let Slot::Now(i) | Slot::Before(i) = s { Some(i) } else { None }).collect();
        all.into_iter().map(|i| (i, before.contains(&i))).collect()
    }
}
