//! A host's depth, normals and motion, see shaders/ingest_surface.wgsl.

use super::{Pass, bindings};
use crate::plan::{Feature, Features, Grid, Image, Slot, Step};

const FEATURES: &[Feature] = &[
    Feature::OctahedralNormals,
    Feature::MappedNormals,
    Feature::PackedNormals,
    Feature::PreviousDepth,
    Feature::HostMotion,
    Feature::Objects,
    Feature::FloatObjects,
    Feature::Diagnostics,
];

pub(crate) fn step(features: Features) -> Step {
    let mut features = features.and(Features::of(FEATURES));
    if features.has(Feature::HostMotion) {
        features = features.without(Feature::PreviousDepth);
    }
    let mut bindings = bindings(
        features,
        [
            ("depth", Slot::Host, &[]),
            ("normal", Slot::Host, &[]),
            ("previous_depth", Slot::Host, &[Feature::PreviousDepth]),
            ("instance", Slot::Host, &[Feature::Objects]),
            ("guide_out", Slot::Now(Image::Guide), &[]),
            ("object_out", Slot::Now(Image::Object), &[Feature::Objects]),
        ],
    );
    if !features.has(Feature::HostMotion) {
        bindings.extend([("motion", Slot::Host), ("motion_out", Slot::Now(Image::Motion))]);
    }
    Step { pass: Pass::IngestSurface, features, grid: Grid::Pixels, iteration: 0, bindings }
}
