//! Choice of the gradient's samples, see shaders/gradient_sample.wgsl.

use super::{Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

pub(crate) fn step(features: Features) -> Step {
    let features = features.and(Features::of(&[Feature::Objects]));
    Step {
        pass: Pass::GradientSample,
        features,
        grid: Grid::Strata,
        iteration: 0,
        bindings: bindings(
            features,
            [
                ("guide", Slot::Now(Image::Guide), &[]),
                ("guide_previous", Slot::Before(Image::Guide), &[]),
                ("motion", Slot::Now(Image::Motion), &[]),
                ("object", Slot::Now(Image::Object), &[Feature::Objects]),
                ("object_previous", Slot::Before(Image::Object), &[Feature::Objects]),
                ("samples_previous", Slot::Before(Image::Samples), &[]),
                ("samples_out", Slot::Now(Image::Samples), &[]),
            ],
        ),
    }
}
