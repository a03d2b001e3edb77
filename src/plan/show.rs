//! The step that shows an intermediate image of a frame.

use super::{Image, Plan, Step};
use crate::passes::view::{self, Shown};
use crate::{Error, View};
use wgpu::TextureFormat;

impl Plan {
    /// Makes the step that shows a view of the images that this plan's steps have left, in a target of this format. `holds` is true for
    /// images that are still there.
    pub(crate) fn show(&self, view: View, target: TextureFormat, holds: impl Fn(Image) -> bool) -> Result<Step, Error> {
        let frame = Shown {
            features: self.features,
            specular: self.specular,
            traced: self.steps.iter().any(|step| step.pass.traces),
            color: self.color,
            gradient: self.gradient,
        };
        view::step(view, &frame, target, holds).map_err(|reason| Error::NoView { view, reason })
    }
}
