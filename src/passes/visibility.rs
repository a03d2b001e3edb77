//! Primary rays, see shaders/visibility.wgsl.

use super::{GEOMETRY, Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

pub(crate) fn step(features: Features) -> Step {
    // Textures matter here only where they cut holes.
    let mut features = features.and(Features::of(GEOMETRY).with(Feature::Objects));
    if !features.has(Feature::AlphaMask) {
        features = features.without(Feature::Textures).without(Feature::FoldedImages);
    }
    Step {
        pass: Pass::Visibility,
        features,
        grid: Grid::Pixels,
        iteration: 0,
        bindings: bindings(
            features,
            [
                ("visibility_out", Slot::Now(Image::Visibility), &[]),
                ("guide_out", Slot::Now(Image::Guide), &[]),
                ("motion_out", Slot::Now(Image::Motion), &[]),
                ("object_out", Slot::Now(Image::Object), &[Feature::Objects]),
            ],
        ),
    }
}
