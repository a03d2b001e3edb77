//! A compute shader of the pipeline with all facts about it: one constant in a file of its own.

use super::binding::Binding;
use super::{Bound, Feature, Features, Grid, Nth};
use std::cmp::Ordering;
use std::fmt;
use std::hash::{Hash, Hasher};

/// A compute shader of the pipeline.
///
/// A file in src/passes/ declares it; its shader in shaders/ has the same name.
pub struct Pass {
    /// The shader's file name without its ending.
    pub(crate) name: &'static str,
    /// The shader in WGSL, before it is composed with the modules that it imports.
    pub(crate) source: &'static str,
    /// The texels that have an invocation each.
    pub(crate) grid: Grid,
    /// The features that the shader knows, in lists that passes share.
    pub(crate) features: &'static [&'static [Known]],
    /// The bindings of group 0 that hold images, in lists that passes share.
    pub(crate) bindings: &'static [&'static [Binding]],
    /// True if the pass follows rays through a scene, so that its shader is compiled for a [`Traversal`](super::Traversal).
    pub(crate) traces: bool,
}

/// Storage textures that a shader may bind with the default limits of WebGPU.
const MOST_STORAGE_TEXTURES: usize = 4;

impl Pass {
    /// The shader's file name without its ending.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// The features of a plan that are compiled into the shader.
    pub(crate) fn features_of(&self, plan: Features) -> Features {
        self.features.iter().copied().flatten().filter_map(|known| known.of(plan)).collect()
    }

    /// The bindings that a step with these features has, of a signal with those of the plan.
    pub(crate) fn bindings_of(&self, features: Features, plan: Features, nth: Nth) -> Vec<Bound> {
        self.bound(features).map(|binding| binding.resolve(features, plan, nth)).collect()
    }

    /// True if a shader with these features can bind the images that it reads at many taps as storage: WebGPU binds four storage
    /// textures at most, and written ones come first.
    pub(crate) fn can_read_storage(&self, features: Features) -> bool {
        let written = self.bound(features).filter(|binding| binding.is_written()).count();
        // Shaders that follow rays also bind the scene's geometry, which they read at every node.
        let read = self.bound(features).filter(|binding| binding.is_storage()).count() + usize::from(self.traces);
        read > 0 && written + read <= MOST_STORAGE_TEXTURES
    }

    fn bound(&self, features: Features) -> impl Iterator<Item = &Binding> {
        self.bindings.iter().copied().flatten().filter(move |binding| binding.is_bound(features))
    }
}

/// A feature that a shader knows. It is compiled in if the plan has it, has all of the features that it depends on, and none of
/// those that make it needless.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    feature: Feature,
    all: Features,
    none: Features,
}

/// Declares that the shader knows this feature.
pub(super) const fn knows(feature: Feature) -> Known {
    Known { feature, all: Features::of(&[feature]), none: Features::of(&[]) }
}

impl Known {
    /// The feature matters only together with this other one.
    pub(super) const fn with(self, feature: Feature) -> Self {
        Self { all: self.all.with(feature), ..self }
    }

    /// The feature is needless together with this other one.
    pub(super) const fn unless(self, feature: Feature) -> Self {
        Self { none: self.none.with(feature), ..self }
    }

    /// Returns the feature if a plan compiles it in.
    pub(super) fn of(&self, plan: Features) -> Option<Feature> {
        (plan.has_all(self.all) && !plan.has_any(self.none)).then_some(self.feature)
    }
}

// Passes are equal if they have the same name, which is the name of their files.

impl PartialEq for Pass {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Pass {}

impl PartialOrd for Pass {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Pass {
    fn cmp(&self, other: &Self) -> Ordering {
        self.name.cmp(other.name)
    }
}

impl Hash for Pass {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.name.hash(state);
    }
}

impl fmt::Debug for Pass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}
