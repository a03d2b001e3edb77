//! Variance of short histories, see shaders/variance.wgsl.

use super::{Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

const FEATURES: &[Feature] =
    &[Feature::Feedback, Feature::VarianceOfMean, Feature::MissingSamples, Feature::RepeatedNoise];

pub(crate) fn step(features: Features) -> Step {
    let features = features.and(Features::of(FEATURES));
    Step {
        pass: Pass::Variance,
        features,
        grid: Grid::Pixels,
        iteration: 0,
        bindings: bindings(
            features,
            [
                ("guide", Slot::Now(Image::Guide), &[]),
                ("history", Slot::Now(Image::History), &[]),
                ("feedback", Slot::Now(Image::Feedback), &[Feature::Feedback]),
                ("color_out", Slot::Now(Image::Color(0)), &[]),
            ],
        ),
    }
}
