//! Recording of a frame pass by pass, with a call to the host after each.

use super::Denoiser;
use crate::Pass;
use wgpu::CommandEncoder;

/// A [`Denoiser`] that calls the host after each pass that it records, see [`Denoiser::stepwise`].
#[derive(Debug)]
pub struct Stepwise<'a, F> {
    pub(super) denoiser: &'a mut Denoiser,
    pub(super) after: F,
}

impl Denoiser {
    /// The same denoiser, which calls `after` behind each pass that it records. The host may replace the encoder that it gets with
    /// another one, and submit the commands so far.
    ///
    /// Use it to time passes on an adapter without (honest) timestamps, or to divide a long frame on a system that limits the time of a
    /// submission:
    /// ```no_run
    /// # fn record(denoiser: &mut asvgf::Denoiser, device: &asvgf::wgpu::Device, queue: &asvgf::wgpu::Queue,
    /// #     mut encoder: asvgf::wgpu::CommandEncoder, shading: &asvgf::Shading<'_>) -> Result<(), asvgf::Error> {
    /// let submit = |pass: &asvgf::Pass, encoder: &mut asvgf::wgpu::CommandEncoder| {
    ///     println!("{}", pass.name());
    ///     let next = device.create_command_encoder(&Default::default());
    ///     queue.submit([std::mem::replace(encoder, next).finish()]);
    /// };
    /// denoiser.stepwise(submit).denoise(device, &mut encoder, shading)
    /// # }
    /// ```
    pub fn stepwise<F: FnMut(&Pass, &mut CommandEncoder)>(&mut self, after: F) -> Stepwise<'_, F> {
        Stepwise { denoiser: self, after }
    }
}
