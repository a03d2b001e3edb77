//! Means of new samples and of their histories, see shaders/gradient_means.wgsl.

use super::{Pass, bindings, modulation};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

const FEATURES: &[Feature] =
    &[Feature::Objects, Feature::Feedback, Feature::HostMotion, Feature::HostLight, Feature::MissingSamples];

pub(crate) fn step(given: Features) -> Step {
    let features = modulation(given, given.and(Features::of(FEATURES)));
    // A host's own image, or its copy.
    let source = |direct, image| if features.has(direct) { Slot::Host } else { Slot::Now(image) };
    let bindings = bindings(
        features,
        [
            ("guide", Slot::Now(Image::Guide), &[]),
            ("guide_previous", Slot::Before(Image::Guide), &[]),
            ("motion", source(Feature::HostMotion, Image::Motion), &[]),
            ("previous_depth", Slot::Host, &[Feature::PreviousDepth]),
            ("object", Slot::Now(Image::Object), &[Feature::Objects]),
            ("object_previous", Slot::Before(Image::Object), &[Feature::Objects]),
            ("radiance", source(Feature::HostLight, Image::Radiance), &[]),
            ("albedo", Slot::Host, &[Feature::Albedo]),
            ("emission", Slot::Host, &[Feature::DirectEmission]),
            ("history_previous", Slot::Before(Image::History), &[]),
            ("feedback_previous", Slot::Before(Image::Feedback), &[Feature::Feedback]),
            ("samples_out", Slot::Now(Image::Samples), &[]),
            ("now_out", Slot::Now(Image::MeansNow(0)), &[]),
            ("before_out", Slot::Now(Image::MeansBefore(0)), &[]),
        ],
    );
    Step { pass: Pass::GradientMeans, features, grid: Grid::Strata, iteration: 0, bindings }
}
