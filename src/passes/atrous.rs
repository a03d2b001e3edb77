//! One spatial iteration, see shaders/atrous.wgsl.

use super::{Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

const FEATURES: &[Feature] =
    &[Feature::ClassicStops, Feature::FullKernel, Feature::LocalLinearFit, Feature::RidgeByNoise];

/// Only the first iteration smooths the variance and feeds the history.
const FIRST: &[Feature] = &[Feature::FirstIteration, Feature::Feedback];

pub(crate) fn step(features: Features, iteration: u32) -> Step {
    let first: &[Feature] = if iteration == 0 { FIRST } else { &[] };
    let features = features.with(Feature::FirstIteration).and(FEATURES.iter().chain(first).copied().collect());
    iterate(features, iteration, (iteration % 2) as u8)
}

/// One more over the nearest taps alone, after so many others.
pub(crate) fn last_step(features: Features, iterations: u32) -> Step {
    let features = features.and(Features::of(FEATURES)).without(Feature::FullKernel).with(Feature::SmallKernel);
    iterate(features, 0, (iterations % 2) as u8)
}

/// From one of the two images of colours to the other.
fn iterate(features: Features, iteration: u32, from: u8) -> Step {
    Step {
        pass: Pass::Atrous,
        features,
        grid: Grid::Pixels,
        iteration,
        bindings: bindings(
            features,
            [
                ("guide", Slot::Now(Image::Guide), &[]),
                ("color", Slot::Now(Image::Color(from)), &[]),
                ("color_out", Slot::Now(Image::Color(1 - from)), &[]),
                ("feedback_out", Slot::Now(Image::Feedback), &[Feature::Feedback]),
            ],
        ),
    }
}
