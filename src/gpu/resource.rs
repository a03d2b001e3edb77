//! The resource behind each variable of a shader.

#[cfg(feature = "path-tracer")]
use crate::passes::SceneBinding;
use crate::passes::Step;

/// The resource behind a binding, known from the variable's name when a kernel is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Resource {
    /// The image behind the binding of this number in the step. Steps of one permutation bind images in one order, because their
    /// features decide which there are.
    Image(usize),
    /// The frame's constants.
    Frame,
    /// The distance of a filter's taps.
    Stride,
    /// The options of a view.
    Show,
    /// The counters of input that had to be cleaned.
    Counts,
    /// A part of the scene.
    #[cfg(feature = "path-tracer")]
    Scene(SceneBinding),
}

impl Resource {
    /// The resource behind a variable of a step's shader.
    pub fn named(name: &str, step: &Step) -> Option<Self> {
        if let Some(number) = step.bindings.iter().position(|bound| bound.name == name) {
            return Some(Self::Image(number));
        }
        match name {
            "frame" => Some(Self::Frame),
            "stride" => Some(Self::Stride),
            "show" => Some(Self::Show),
            "counts" => Some(Self::Counts),
            #[cfg(feature = "path-tracer")]
            _ => SceneBinding::named(name).map(Self::Scene),
            #[cfg(not(feature = "path-tracer"))]
            _ => None,
        }
    }
}
