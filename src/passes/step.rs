//! One dispatch of a pass.

use super::{Bound, Feature, Features, Grid, Image, Pass};
use crate::View;

/// One dispatch.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Step {
    /// The shader.
    pub pass: &'static Pass,
    /// The features that are compiled into the shader.
    pub features: Features,
    /// Number of a filter's iteration, from 0: its taps are 2ⁱ apart.
    pub iteration: u32,
    /// Number of the dispatch among those that share a frame's paths, from 0.
    pub batch: u32,
    /// The view whose block of the shader the step runs, if it shows a view.
    pub view: Option<View>,
    /// The images behind the bindings.
    pub bindings: Vec<Bound>,
}

/// The place of a step among others of its pass.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Nth {
    /// Number of a filter's iteration, or a pyramid's level.
    pub iteration: u32,
    /// An even turn reads the first of two images, an odd one the second.
    pub turn: u32,
    /// Number of the dispatch among those that share a frame's paths.
    pub batch: u32,
    /// The image in which an earlier pass left its result.
    pub image: Option<Image>,
}

impl Nth {
    /// An iteration, which reads the image that the one before has written.
    pub const fn iteration(iteration: u32) -> Self {
        Self { iteration, turn: iteration, batch: 0, image: None }
    }

    /// A pass that reads the result of a number of iterations.
    pub const fn after(iterations: u32) -> Self {
        Self { iteration: 0, turn: iterations, batch: 0, image: None }
    }

    /// A pass that reads a result that one of several images holds.
    pub const fn of(image: Option<Image>) -> Self {
        Self { iteration: 0, turn: 0, batch: 0, image }
    }

    /// One of the dispatches that share a frame's paths.
    #[cfg(feature = "path-tracer")]
    pub const fn batch(batch: u32) -> Self {
        Self { iteration: 0, turn: batch, batch, image: None }
    }
}

impl Step {
    /// The only step of a pass, with those features of the plan that its shader knows.
    pub(crate) fn new(pass: &'static Pass, plan: Features) -> Self {
        Self::nth(pass, plan, Nth::default())
    }

    /// One of several steps of a pass.
    pub(crate) fn nth(pass: &'static Pass, plan: Features, nth: Nth) -> Self {
        let features = pass.features_of(plan);
        let bindings = pass.bindings_of(features, plan, nth);
        Self { pass, features, iteration: nth.iteration, batch: nth.batch, view: None, bindings }
    }

    /// The pixels or strata that have an invocation each.
    pub fn grid(&self) -> Grid {
        self.pass.grid
    }

    /// This step for an adapter that is the CPU, see [`Feature::StorageReads`].
    pub(crate) fn on_cpu(mut self) -> Self {
        if self.pass.can_read_storage(self.features) {
            self.features = self.features.with(Feature::StorageReads);
        }
        self
    }
}
