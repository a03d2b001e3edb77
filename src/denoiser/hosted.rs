//! A host's frame in two calls: surfaces, then light.

use super::Denoiser;
use super::stepwise::Stepwise;
use crate::Error;
use crate::frame::{Begun, Identity, LastFrame, Light, Motion, Resources, Source};
use crate::gpu::frame::Moment;
use crate::host::{self, Lambda, Reshade, Shading, Surfaces};
use crate::passes::{Feature, HostView, Image, Pass, Slot, Traversal};
use crate::plan::{Changes, HostInputs, PairInputs, Plan};
use crate::settings::{Gradient, Mode};
use wgpu::{CommandEncoder, Device, TextureFormat};

impl Denoiser {
    /// Records the first half of a host's frame: takes its surfaces, and with [`Gradient::Reshade`] returns the paths of the last frame
    /// to repeat (`None` with the other gradients). The host then traces, in the same encoder or a later one, and calls
    /// [`Denoiser::denoise`]. A second call before that begins the same frame anew.
    ///
    /// # Errors
    /// Names the wrong view, camera or setting. Nothing is recorded then, and the history stays.
    pub fn begin_frame(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        surfaces: &Surfaces<'_>,
    ) -> Result<Option<Reshade>, Error> {
        self.stepwise(|_, _| {}).begin_frame(device, encoder, surfaces)
    }

    /// Records the second half of a host's frame: takes the light, filters, and writes linear radiance into the target.
    ///
    /// # Errors
    /// Names the wrong view or setting; [`Error::NotBegun`] without a [`Denoiser::begin_frame`]. Nothing is recorded then, the history
    /// stays, and the host may call it again.
    pub fn denoise(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        shading: &Shading<'_>,
    ) -> Result<(), Error> {
        self.stepwise(|_, _| {}).denoise(device, encoder, shading)
    }
}

impl<F: FnMut(&Pass, &mut CommandEncoder)> Stepwise<'_, F> {
    /// [`Denoiser::begin_frame`], pass by pass.
    ///
    /// # Errors
    /// The same as for [`Denoiser::begin_frame`].
    pub fn begin_frame(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        surfaces: &Surfaces<'_>,
    ) -> Result<Option<Reshade>, Error> {
        let denoiser = &mut *self.denoiser;
        let (settings, recorder) = (&denoiser.settings, &denoiser.recorder);
        if settings.mode == Mode::Denoise && settings.filter.gradient == Gradient::BlinnPhong {
            let reason = "needs a scene: choose Automatic, Reshade, Statistics, Pairs, Lambda or Off for your own renderer's frames";
            return Err(Error::GradientSource { asked: Gradient::BlinnPhong.name(), reason });
        }
        let camera = surfaces.camera.placed(recorder.size)?;
        let (diagnostics, views) = (recorder.counters.is_some(), recorder.textures.keeps());
        let mut inputs = HostInputs { diagnostics, views, ..Default::default() };
        host::surfaces(&mut inputs, surfaces, recorder.size)?;
        let index = surfaces.index;
        let identity = Identity { index, camera, source: Source::Host };

        // The light's views decide neither this half nor which of its images outlive the frame.
        let most_bits = TextureFormat::Rgba32Float;
        let planned = |inputs: &HostInputs, changes| Plan::hosted(inputs, settings, changes, most_bits);
        let most = recorder.adapt(planned(&inputs, Changes::ANY));
        let kept = denoiser.history.continuable().filter(|_| recorder.textures.has_all_before(&most));
        let known = kept.and_then(|last| identity.changes_since(&last.identity, settings.mode));
        let last = kept.filter(|_| known.is_some());
        let changes = denoiser.changes(known.map(|found| found.or(surfaces.changes)));
        let plan = recorder.adapt(planned(&inputs, changes));
        let steps = &plan.steps[..plan.surface_steps()];
        recorder.compile(steps, Traversal::default())?;

        let moment = Moment {
            camera,
            previous: last.map_or(camera, |last| last.identity.camera),
            origin: surfaces.camera.origin(),
            index,
            continued: last.is_some(),
            lambda_block: 1,
            converges: plan.converges(),
        };
        let uniform = recorder.uniform(device, settings, &moment, &[]);
        // The longest frame: light in the target's texture is copied, and pairs may add passes.
        let passes = || {
            let steps = |pairs| {
                let light = HostInputs { in_target: true, specular: true, pairs, specular_pairs: pairs, ..inputs };
                planned(&light, changes).steps.len()
            };
            steps(None).max(steps(Some(PairInputs::default())))
        };
        let mut recording = recorder.begin_counted(device, index, passes, uniform);
        let continued = kept.is_some();
        denoiser.abandon();
        let recorder = &mut denoiser.recorder;
        recorder.textures.begin();
        recorder.textures.place(device, recorder.size, &plan, (0, steps.len()), most.images());
        let resources = Resources { host: &|view| surfaces.view(view), ..Default::default() };
        recorder.record(device, encoder, steps, &resources, &mut recording, &mut self.after)?;

        let image = |image| recorder.textures.view(Slot::Now(image)).cloned();
        let reshade = match (image(Image::Guide), image(Image::Repeats), image(Image::Shifts)) {
            (Some(guide), Some(repeats), Some(shifts)) if plan.features.has(Feature::Reshade) => {
                Some(Reshade { frame: recording.uniform.clone(), guide, repeats, shifts })
            }
            _ => None,
        };
        let motion = Motion { motion: surfaces.motion.clone(), previous_depth: surfaces.previous_depth.cloned() };
        denoiser.history.begin(Begun { identity, moment, changes, inputs, motion, recording }, continued);
        Ok(reshade)
    }

    /// [`Denoiser::denoise`], pass by pass.
    ///
    /// # Errors
    /// The same as for [`Denoiser::denoise`].
    pub fn denoise(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        shading: &Shading<'_>,
    ) -> Result<(), Error> {
        let denoiser = &mut *self.denoiser;
        let (settings, recorder) = (&denoiser.settings, &denoiser.recorder);
        let begun = denoiser.history.begun().ok_or(Error::NotBegun)?;
        let accepted = [TextureFormat::Rgba16Float, TextureFormat::Rgba32Float];
        let format = host::target(shading.target, recorder.size, &accepted)?;
        let (mut inputs, changes) = (begun.inputs, begun.changes);
        host::shading(&mut inputs, shading, recorder.size, (settings, changes))?;
        let planned = |changes| Plan::hosted(&inputs, settings, changes, format);
        let plan = recorder.adapt(planned(changes));
        let images = planned(Changes::ANY).images();
        let from = plan.surface_steps();
        recorder.compile(&plan.steps[from..], Traversal::default())?;

        let light = Light {
            textures: !inputs.albedo && !inputs.demodulated,
            emission: !inputs.emission && !inputs.demodulated,
            specular: !inputs.specular,
            reflectance: inputs.reflectance,
        };
        let Some(begun) = denoiser.history.take_begun() else { return Err(Error::NotBegun) };
        let Begun { identity, mut moment, motion, mut recording, .. } = begun;
        // A new image (an albedo, say) has nothing to compare with, because the last frame lacked it.
        let same_light = denoiser.history.last().is_some_and(|last| last.light == Some(light));
        let lost = !same_light || !denoiser.recorder.textures.has_all_before(&plan);
        let recorder = &mut denoiser.recorder;
        recorder.textures.place(device, recorder.size, &plan, (from, plan.steps.len()), images);
        let block = shading.lambda.as_ref().map_or(1, |lambda: &Lambda<'_>| lambda.block);
        if (lost && moment.continued) || block != 1 {
            moment.continued &= !lost;
            moment.lambda_block = block;
            recording.uniform = recorder.uniform(device, &denoiser.settings, &moment, &[]);
        }
        let view = |view| match view {
            HostView::Motion => Some(&motion.motion),
            HostView::PreviousDepth => motion.previous_depth.as_ref(),
            _ => shading.view(view),
        };
        let resources = Resources { host: &view, target: Some(shading.target), ..Default::default() };
        recorder.record(device, encoder, &plan.steps[from..], &resources, &mut recording, &mut self.after)?;
        let uniform = recorder.end(device, encoder, recording);
        denoiser.history.complete(LastFrame {
            identity,
            plan,
            uniform,
            light: Some(light),
            #[cfg(feature = "path-tracer")]
            snapshot: None,
        });
        Ok(())
    }
}
