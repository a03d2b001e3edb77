//! The vocabulary of a pass's bindings: each is declared once, with the name that it has in WGSL.

use super::{Feature, Features, Image, Nth};

/// The image or view behind a binding of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Slot {
    /// This frame's image.
    Now(Image),
    /// The previous frame's image.
    Before(Image),
    /// The host's target.
    Target,
    /// One of the host's views.
    Host(HostView),
}

/// A view that a host hands in: a field of [`Surfaces`](crate::Surfaces) or [`Shading`](crate::Shading).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum HostView {
    /// [`Surfaces::depth`](crate::Surfaces::depth).
    Depth,
    /// [`Surfaces::normal`](crate::Surfaces::normal).
    Normal,
    /// [`Surfaces::motion`](crate::Surfaces::motion).
    Motion,
    /// [`Surfaces::previous_depth`](crate::Surfaces::previous_depth).
    PreviousDepth,
    /// [`Surfaces::instance`](crate::Surfaces::instance).
    Instance,
    /// [`Shading::radiance`](crate::Shading::radiance).
    Radiance,
    /// [`Shading::albedo`](crate::Shading::albedo).
    Albedo,
    /// [`Shading::emission`](crate::Shading::emission).
    Emission,
    /// [`Pairs::current`](crate::Pairs::current).
    PairNow,
    /// [`Pairs::previous`](crate::Pairs::previous).
    PairBefore,
    /// [`Lambda::view`](crate::Lambda::view).
    Lambda,
    /// [`Gloss::radiance`](crate::Gloss::radiance).
    SpecularRadiance,
    /// [`Gloss::reflectance`](crate::Gloss::reflectance).
    Reflectance,
    /// [`Gloss::roughness`](crate::Gloss::roughness).
    Roughness,
    /// [`Gloss::hit_distance`](crate::Gloss::hit_distance).
    HitDistance,
    /// [`Gloss::motion`](crate::Gloss::motion).
    ReflectionMotion,
    /// [`Pairs::current`](crate::Pairs::current) of [`Gloss::pairs`](crate::Gloss::pairs).
    SpecularPairNow,
    /// [`Pairs::previous`](crate::Pairs::previous) of [`Gloss::pairs`](crate::Gloss::pairs).
    SpecularPairBefore,
}

impl HostView {
    /// The view's name in plans: `previous depth`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::Motion => "motion",
            Self::PreviousDepth => "previous depth",
            Self::Instance => "instance",
            Self::Radiance => "radiance",
            Self::Albedo => "albedo",
            Self::Emission => "emission",
            Self::PairNow => "pair now",
            Self::PairBefore => "pair before",
            Self::Lambda => "lambda",
            Self::SpecularRadiance => "specular radiance",
            Self::Reflectance => "reflectance",
            Self::Roughness => "roughness",
            Self::HitDistance => "hit distance",
            Self::ReflectionMotion => "motion of reflections",
            Self::SpecularPairNow => "specular pair now",
            Self::SpecularPairBefore => "specular pair before",
        }
    }
}

impl Slot {
    /// The slot of the surfaces that rays meet first, in a frame that sees others through glass.
    fn first(self, features: Features) -> Self {
        match self {
            Self::Now(image) if features.has(Feature::SeeThrough) => Self::Now(image.first()),
            Self::Before(image) if features.has(Feature::SeeThrough) => Self::Before(image.first()),
            _ => self,
        }
    }

    /// The slot of a step of the specular signal, where the diffuse signal's step has this one.
    pub(super) fn specular(self, features: Features) -> Self {
        match self {
            // Both signals find the last frame's surfaces there, and repeat the same paths.
            Self::Before(Image::Guide) => self,
            Self::Now(Image::Samples) | Self::Before(Image::Samples) if features.has(Feature::Reshade) => self,
            Self::Now(image) => Self::Now(image.specular()),
            Self::Before(image) => Self::Before(image.specular()),
            Self::Host(view) => Self::Host(view.specular()),
            Self::Target => self,
        }
    }
}

impl HostView {
    /// The specular signal's view, or the view itself if both signals share it.
    fn specular(self) -> Self {
        match self {
            Self::Radiance => Self::SpecularRadiance,
            Self::Albedo => Self::Reflectance,
            Self::PairNow => Self::SpecularPairNow,
            Self::PairBefore => Self::SpecularPairBefore,
            shared => shared,
        }
    }
}

/// One binding of a step: its name in WGSL, the image behind it, and the direction of the data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Bound {
    /// Name of the variable in WGSL.
    pub name: &'static str,
    /// The image behind the binding.
    pub slot: Slot,
    /// True if the shader writes it, false if the shader reads it.
    pub written: bool,
}

/// A binding as a pass declares it: present in a step if the step has all of its features and none of the excluding ones.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Binding {
    name: &'static str,
    source: Source,
    written: bool,
    /// The host's view that replaces the image if the step has this feature.
    host: Option<(Feature, HostView)>,
    all: Features,
    /// The step needs at least one of these, unless the set is empty.
    any: Features,
    none: Features,
    /// True to read it as a storage texture if the step has [`Feature::StorageReads`].
    storage: bool,
    /// The signal that the image is of, whichever signal's step it is: true for the specular one, false for the diffuse one.
    of: Option<bool>,
    /// True if the image is of the surfaces that rays meet first, in a frame that sees others through glass.
    first: bool,
}

/// The place at which a step finds the image of a binding.
#[derive(Clone, Copy, Debug)]
enum Source {
    Now(Image),
    Before(Image),
    /// One of two images that take turns: the image of the step's turn, or the other.
    Turn(fn(u8) -> Image, u32),
    /// An image of the step's level of a pyramid, or of a number of levels above.
    Level(fn(u8) -> Image, u32),
    /// The image that the plan names, because an earlier pass left its result there.
    Chosen,
    Host(HostView),
    Target,
}

/// Reads this frame's image.
pub(super) const fn now(name: &'static str, image: Image) -> Binding {
    Binding::new(name, Source::Now(image), false)
}

/// Reads the previous frame's image.
pub(super) const fn before(name: &'static str, image: Image) -> Binding {
    Binding::new(name, Source::Before(image), false)
}

/// Writes this frame's image.
pub(super) const fn out(name: &'static str, image: Image) -> Binding {
    Binding::new(name, Source::Now(image), true)
}

/// Reads the image of the step's turn, of two that take turns.
pub(super) const fn turn(name: &'static str, images: fn(u8) -> Image) -> Binding {
    Binding::new(name, Source::Turn(images, 0), false)
}

/// Reads the other image.
#[cfg(feature = "path-tracer")]
pub(super) const fn other_turn(name: &'static str, images: fn(u8) -> Image) -> Binding {
    Binding::new(name, Source::Turn(images, 1), false)
}

/// Writes the image of the step's turn.
#[cfg(feature = "path-tracer")]
pub(super) const fn turn_out(name: &'static str, images: fn(u8) -> Image) -> Binding {
    Binding::new(name, Source::Turn(images, 0), true)
}

/// Writes the other image, which the next turn reads.
pub(super) const fn next_turn_out(name: &'static str, images: fn(u8) -> Image) -> Binding {
    Binding::new(name, Source::Turn(images, 1), true)
}

/// Reads the image of the step's level.
pub(super) const fn level(name: &'static str, images: fn(u8) -> Image) -> Binding {
    Binding::new(name, Source::Level(images, 0), false)
}

/// Writes the image of the next coarser level.
pub(super) const fn next_level_out(name: &'static str, images: fn(u8) -> Image) -> Binding {
    Binding::new(name, Source::Level(images, 1), true)
}

/// Reads the image that the plan names.
pub(super) const fn chosen(name: &'static str) -> Binding {
    Binding::new(name, Source::Chosen, false)
}

/// Reads a view of the host.
pub(super) const fn host(name: &'static str, view: HostView) -> Binding {
    Binding::new(name, Source::Host(view), false)
}

/// Writes the host's target.
pub(super) const fn target(name: &'static str) -> Binding {
    Binding::new(name, Source::Target, true)
}

impl Binding {
    const fn new(name: &'static str, source: Source, written: bool) -> Self {
        let none = Features::of(&[]);
        Self { name, source, written, host: None, all: none, any: none, none, storage: false, of: None, first: false }
    }

    /// Binds the image only if the step has this feature.
    pub(super) const fn with(self, feature: Feature) -> Self {
        Self { all: self.all.with(feature), ..self }
    }

    /// Binds the image only if the step has one of these features.
    pub(super) const fn with_any(self, features: &[Feature]) -> Self {
        Self { any: Features::of(features), ..self }
    }

    /// Binds the image only if the step lacks this feature.
    pub(super) const fn unless(self, feature: Feature) -> Self {
        Self { none: self.none.with(feature), ..self }
    }

    /// Reads the host's own view instead of a copy if the step has this feature.
    pub(super) const fn or_host(self, feature: Feature, view: HostView) -> Self {
        Self { host: Some((feature, view)), ..self }
    }

    /// Reads the image as storage on an adapter that is the CPU, because it is read at many taps, see [`Feature::StorageReads`].
    pub(super) const fn at_many_taps(self) -> Self {
        Self { storage: true, ..self }
    }

    /// Binds the specular signal's image, in a step that brings the signals together.
    pub(super) const fn of_specular(self) -> Self {
        Self { of: Some(true), ..self }
    }

    /// Binds the surfaces' image in a step of the specular signal too.
    pub(super) const fn of_surfaces(self) -> Self {
        Self { of: Some(false), ..self }
    }

    /// Binds the image of the surfaces that rays meet first, in a frame that sees others through glass.
    pub(super) const fn of_first(self) -> Self {
        Self { first: true, ..self }
    }

    /// True if a step with these features has this binding.
    pub(super) fn is_bound(&self, features: Features) -> bool {
        features.has_all(self.all)
            && (self.any.is_empty() || features.has_any(self.any))
            && !features.has_any(self.none)
    }

    /// True if the step may read it as a storage texture.
    pub(super) fn is_storage(&self) -> bool {
        self.storage
    }

    /// True if the shader writes it.
    pub(super) fn is_written(&self) -> bool {
        self.written
    }

    /// The binding of a step with these features, of a signal with those of the plan.
    pub(super) fn resolve(&self, features: Features, plan: Features, nth: Nth) -> Bound {
        let take_turns = |offset: u32| ((nth.turn + offset) % 2) as u8;
        let slot = match (self.host, self.source) {
            (Some((feature, view)), _) if features.has(feature) => Slot::Host(view),
            (_, Source::Now(image)) => Slot::Now(image),
            (_, Source::Before(image)) => Slot::Before(image),
            (_, Source::Turn(images, offset)) => Slot::Now(images(take_turns(offset))),
            (_, Source::Level(images, offset)) => Slot::Now(images((nth.iteration + offset) as u8)),
            // A plan that runs the pass has named the image. In a declaration, the first turn stands for it.
            (_, Source::Chosen) => Slot::Now(nth.image.unwrap_or(Image::Color(0))),
            (_, Source::Host(view)) => Slot::Host(view),
            (_, Source::Target) => Slot::Target,
        };
        let specular = self.of.unwrap_or(plan.has(Feature::SpecularSignal));
        let slot = if specular { slot.specular(plan) } else { slot };
        // Reflections belong to the surfaces that rays meet first.
        let slot = if self.first || plan.has(Feature::SpecularSignal) { slot.first(plan) } else { slot };
        Bound { name: self.name, slot, written: self.written }
    }
}
