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

pub use crate::passes::{Bound, Feature, Features, Grid, HostView, Image, Slot, Step, Traversal, Twin};
#[cfg(feature = "path-tracer")]
pub(crate) use batches::Batches;
pub use changes::Changes;
pub use contents::{HostInputs, PairInputs, SceneContents};
pub use decision::Decision;
pub(crate) use memory::{Kind, Memory, needed};

use crate::passes::*;
use crate::settings::{FilterSettings, Mode, Settings};
use std::collections::BTreeSet;
use wgpu::TextureFormat;

/// Most spatial iterations of the specular signal. The footprint stops farther taps: a fourth iteration changed no error by 1 %
/// (docs/filter.md).
const MOST_SPECULAR_ITERATIONS: u32 = 3;

/// The passes of a frame.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Plan {
    /// The dispatches in order.
    pub steps: Vec<Step>,
    /// The features that are in.
    pub features: Features,
    /// The features of the specular signal's steps, if it is a signal of its own.
    pub specular: Option<Features>,
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
        plan.specular = choice::traced_gloss(contents, settings, changes);
        plan.run(&visibility::PASS);
        if plan.has(Feature::SeeThrough) {
            plan.run(&see_through::PASS);
        }
        if plan.has(Feature::Gradient) && !plan.has(Feature::Statistics) {
            plan.run(&gradient_sample::PASS);
        }
        plan.trace(Batches::of(contents, &settings.tracer).count());
        if plan.has(Feature::Gloss) {
            plan.run(&gloss_surface::PASS);
        }
        plan.filter(settings, |_, _| {});
        plan.run_on(&resolve::PASS, plan.color);
        plan
    }

    /// Plans the passes that a frame of the host's own renderer needs.
    pub fn hosted(inputs: &HostInputs, settings: &Settings, changes: Changes, target: TextureFormat) -> Self {
        let mut plan = Self::of(choice::hosted(inputs, settings, changes), target);
        plan.specular = choice::hosted_gloss(inputs, settings, changes);
        plan.run(&ingest_surface::PASS);
        if plan.has(Feature::Reshade) {
            plan.run(&gradient_sample::PASS);
            plan.run(&reshade::PASS);
        }
        let shines = plan.has(Feature::Gloss) || plan.has(Feature::MixedGloss);
        if shines && !plan.has(Feature::Unfiltered) {
            plan.run(&ingest_gloss::PASS);
        }
        plan.filter(settings, Self::take_in);
        plan.run_on(&resolve::PASS, plan.color);
        plan
    }

    /// A plan without steps yet, for these decisions.
    fn of(mut decisions: Vec<Decision>, target: TextureFormat) -> Self {
        let narrow = target == TextureFormat::Rgba16Float;
        decisions.push(Decision::new(Feature::TargetF16, narrow, ["the target is 16-bit", "the target is 32-bit"]));
        let features = decisions.iter().filter(|d| d.included).map(|d| d.feature).collect();
        Self { steps: Vec::new(), features, specular: None, decisions, color: None, gradient: None }
    }

    fn has(&self, feature: Feature) -> bool {
        self.features.has(feature)
    }

    /// The features of each signal's steps: diffuse first, or that of all light.
    fn signals(&self) -> impl Iterator<Item = Features> + use<> {
        [Some(self.features), self.specular].into_iter().flatten()
    }

    /// Appends the only step of a pass.
    fn run(&mut self, pass: &'static Pass) {
        self.run_of(self.features, pass);
    }

    /// Appends the only step of a pass for a signal.
    fn run_of(&mut self, signal: Features, pass: &'static Pass) {
        self.steps.push(Step::new(pass, signal));
    }

    /// Appends a pass that reads a result that one of several images holds.
    fn run_on(&mut self, pass: &'static Pass, image: Option<Image>) {
        self.steps.push(Step::nth(pass, self.features, Nth::of(image)));
    }

    /// Appends a number of iterations of a pass for a signal.
    fn iterate(&mut self, signal: Features, pass: &'static Pass, iterations: u32) {
        self.steps.extend((0..iterations).map(|i| Step::nth(pass, signal, Nth::iteration(i))));
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

    /// Appends the passes that take in a host's light and pairs of a signal.
    fn take_in(&mut self, signal: Features) {
        if !signal.has(Feature::HostLight) {
            self.run_of(signal, &ingest_radiance::PASS);
        }
        if signal.has(Feature::Pairs) {
            self.run_of(signal, &ingest_pairs::PASS);
        }
    }

    /// Appends the passes from noisy radiance to filtered colour, if the mode filters. A signal is taken in when the one before is
    /// done, because fewer images are alive at once.
    fn filter(&mut self, settings: &Settings, take_in: fn(&mut Self, Features)) {
        for signal in self.signals() {
            take_in(self, signal);
            if settings.mode != Mode::Denoise {
                continue;
            }
            if signal.has(Feature::SpecularSignal) {
                self.run(&reflection::PASS);
            }
            self.filter_signal(signal, &settings.filter);
        }
    }

    fn filter_signal(&mut self, signal: Features, filter: &FilterSettings) {
        if signal.has(Feature::Outliers) {
            self.run_of(signal, &outlier_candidates::PASS);
            self.run_of(signal, &outlier_counts::PASS);
            self.run_of(signal, &outlier_limit::PASS);
        }
        if signal.has(Feature::SpecularSignal) && !signal.has(Feature::Still) {
            self.run_of(signal, &agreement::PASS);
        }
        let gradient = signal.has(Feature::Gradient).then(|| self.measure_gradient(signal, filter));
        self.steps.push(Step::nth(&temporal::PASS, signal, Nth::of(gradient)));
        let color =
            if signal.has(Feature::TemporalOnly) { Image::History } else { self.filter_in_space(signal, filter) };
        // Both signals end in images of the same name.
        self.color = Some(color);
        if !signal.has(Feature::SpecularSignal) {
            self.gradient = gradient;
        }
    }

    /// Appends the passes that find λ and the history ratio, and returns the image that ends with λ.
    fn measure_gradient(&mut self, signal: Features, filter: &FilterSettings) -> Image {
        if signal.has(Feature::Statistics) {
            self.run_of(signal, &gradient_means::PASS);
            let stored = gradient_of_means::STORED.into();
            self.iterate(signal, &gradient_means_filter::PASS, stored);
            self.steps.push(Step::nth(&gradient_of_means::PASS, signal, Nth::iteration(stored)));
            return Image::Gradient(0);
        }
        if signal.has(Feature::HistoryRatio) {
            self.run_of(signal, &gradient_pairs::PASS);
            self.iterate(signal, &gradient_pairs_filter::PASS, filter.ratio_iterations);
        }
        self.steps.push(Step::nth(&gradient::PASS, signal, Nth::after(filter.ratio_iterations)));
        self.iterate(signal, &gradient_filter::PASS, filter.gradient_iterations);
        Image::Gradient((filter.gradient_iterations % 2) as u8)
    }

    /// Appends the variance, the à-trous iterations, and the blend with the last output, and returns the image that ends with the
    /// colour.
    fn filter_in_space(&mut self, signal: Features, filter: &FilterSettings) -> Image {
        self.run_of(signal, &variance::PASS);
        let mut iterations = if signal.has(Feature::SpecularSignal) {
            filter.iterations.min(MOST_SPECULAR_ITERATIONS)
        } else {
            filter.iterations
        };
        let wide = signal.without(Feature::SmallKernel);
        self.steps.extend((0..iterations).map(|i| {
            let features = if i == 0 { wide.with(Feature::FirstIteration) } else { wide };
            Step::nth(&atrous::PASS, features, Nth::iteration(i))
        }));
        if signal.has(Feature::SmallKernel) {
            self.steps.push(Step::nth(&atrous::PASS, signal, Nth::after(iterations)));
            iterations += 1;
        }
        let color = Image::Color((iterations % 2) as u8);
        if !signal.has(Feature::Steady) {
            return color;
        }
        self.steps.push(Step::nth(&steady::PASS, signal, Nth::of(Some(color))));
        Image::Output
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
