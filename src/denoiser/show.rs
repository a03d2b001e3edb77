//! Display of the last frame's intermediate images.

use super::Denoiser;
use crate::frame::Resources;
use crate::gpu::filled::filled;
use crate::plan::Traversal;
use crate::{Error, View, ViewOptions, host};
use wgpu::{BufferUsages, CommandEncoder, Device, TextureFormat, TextureView};

impl Denoiser {
    /// Records the display of an intermediate image of the last recorded frame, into an `rgba32float` or `rgba16float` view as
    /// numbers or into an `rgba8unorm` view as a picture.
    ///
    /// # Errors
    /// [`Error::NoView`] if the last frame did not make it, or the fault of the target.
    pub fn show(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        view: View,
        options: ViewOptions,
        target: &TextureView,
    ) -> Result<(), Error> {
        let recorder = &self.recorder;
        let accepted = [TextureFormat::Rgba32Float, TextureFormat::Rgba16Float, TextureFormat::Rgba8Unorm];
        let format = host::target(target, recorder.size, &accepted)?;
        let Some(last) = self.history.last() else {
            return Err(Error::NoView { view, reason: "no frame has been rendered yet" });
        };
        if !recorder.textures.is_complete() {
            let reason = "a frame was begun, in the place of the last one's images, and not finished: finish one first";
            return Err(Error::NoView { view, reason });
        }
        let step = last.plan.show(view, format, |image| recorder.textures.holds(image))?;
        recorder.compile(std::slice::from_ref(&step), Traversal::default())?;
        let numbers = [options.exposure, options.range, 0.0, 0.0];
        let show = filled(device, "asvgf view", bytemuck::cast_slice(&numbers), BufferUsages::UNIFORM);
        let resources = Resources { target: Some(target), show: Some(&show), ..Default::default() };
        recorder.show(device, encoder, &step, &resources, &last.uniform)
    }
}
