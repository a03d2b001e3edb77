//! A host's frame in two calls: surfaces, then light.

use super::{Lambda, Reshade, Shading, Surfaces, views};
use crate::Error;
use crate::denoiser::{Denoiser, LastFrame, Light, Resources, Source};
use crate::gpu::counts::Counters;
use crate::gpu::frame::Moment;
use crate::gpu::timing::FrameQueries;
use crate::passes::Pass;
use crate::plan::{Changes, Feature, HostTraits, Image, Plan, Slot, Traversal};
use crate::settings::{Gradient, Mode};
use wgpu::{BindingResource, Buffer, CommandEncoder, Device, TextureFormat, TextureView};

/// A frame between its two calls.
#[derive(Debug)]
pub(crate) struct Begun {
    moment: Moment,
    changes: Changes,
    uniform: Buffer,
    traits: HostTraits,
    motion: Motion,
    counts: Option<Buffer>,
    queries: Option<FrameQueries>,
}

/// What of a frame's surfaces may be read in its second half.
#[derive(Debug)]
struct Motion {
    motion: TextureView,
    previous_depth: Option<TextureView>,
}

/// A host's views by the names of their bindings.
impl<'a> Surfaces<'a> {
    fn resource(&self, name: &str) -> Option<BindingResource<'a>> {
        let view = match name {
            "depth" => Some(self.depth),
            "normal" => Some(self.normal),
            "motion" => Some(self.motion),
            "previous_depth" => self.previous_depth,
            "instance" => self.instance,
            _ => None,
        };
        view.map(BindingResource::TextureView)
    }
}

impl<'a> Shading<'a> {
    fn resource(&self, name: &str) -> Option<BindingResource<'a>> {
        let view = match name {
            "radiance" => Some(self.radiance),
            "albedo" => self.albedo,
            "emission" => self.emission,
            "current" => self.pairs.map(|p| p.current),
            "previous" => self.pairs.map(|p| p.previous),
            "external_lambda" => self.lambda.map(|l| l.view),
            _ => None,
        };
        view.map(BindingResource::TextureView)
    }
}

impl Motion {
    fn resource(&self, name: &str) -> Option<BindingResource<'_>> {
        let view = match name {
            "motion" => Some(&self.motion),
            "previous_depth" => self.previous_depth.as_ref(),
            _ => None,
        };
        view.map(BindingResource::TextureView)
    }
}

impl Denoiser {
    /// Records the first half of a host's frame: takes its surfaces, and with [`Gradient::Reshade`] says which of last frame's paths
    /// to repeat (`None` with the other gradients). Then trace, in the same encoder or a later one, and call
    /// [`Denoiser::denoise`]. Calling it again before that begins the same frame anew.
    ///
    /// # Errors
    /// Names the view, camera or setting that is wrong; nothing is recorded then, and the history stays.
    pub fn begin_frame(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        surfaces: &Surfaces<'_>,
    ) -> Result<Option<Reshade>, Error> {
        self.begin_frame_stepwise(device, encoder, surfaces, |_, _| {})
    }

    /// As [`Denoiser::begin_frame`], and calls the host after each pass, see [`Denoiser::denoise_stepwise`].
    ///
    /// # Errors
    /// As [`Denoiser::begin_frame`].
    pub fn begin_frame_stepwise(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        surfaces: &Surfaces<'_>,
        mut after: impl FnMut(Pass, &mut CommandEncoder),
    ) -> Result<Option<Reshade>, Error> {
        if self.settings.mode == Mode::Denoise && self.settings.filter.gradient == Gradient::BlinnPhong {
            let reason = "needs a scene: choose Automatic, Reshade, Statistics, Pairs, Lambda or Off for your own renderer's frames";
            return Err(Error::GradientSource { asked: Gradient::BlinnPhong, reason });
        }
        let camera = surfaces.camera.placed(self.size)?;
        let (diagnostics, views) = (self.counters.is_some(), self.textures.keeps());
        let mut traits = HostTraits { diagnostics, views, ..Default::default() };
        views::surfaces(&mut traits, surfaces, self.size)?;
        // What the light's views will have changes neither this half nor which of its images outlive the frame.
        let most_bits = TextureFormat::Rgba32Float;
        let all = |changes| Plan::hosted(&traits, &self.settings, changes, most_bits);
        let most = self.adapt(all(Changes::ANY));
        let index = surfaces.index;
        let history = self.history && self.textures.has_all_before(&most);
        let last = self.last.as_ref().filter(|l| {
            // Motion leads to the frame before, and a mean over frames is only one of frames that are alike.
            history
                && matches!(l.source, Source::Host(_))
                && l.index.wrapping_add(1) == index
                && (self.settings.mode != Mode::Reference || l.camera == camera)
        });
        let moved = |l: &LastFrame| surfaces.changes.camera || l.camera != camera;
        let known = last.map(|l| Changes { camera: moved(l), scene: surfaces.changes.scene });
        let changes = self.changes(known);
        let plan = self.adapt(all(changes));
        let previous = last.map_or(camera, |l| l.camera);
        let converges = plan.converges();
        let origin = surfaces.camera.origin();
        let moment = Moment { camera, previous, origin, index, continued: last.is_some(), lambda_block: 1, converges };
        let steps = &plan.steps[..plan.surface_steps()];
        self.compile(steps, Traversal::default())?;
        self.abandon();
        self.history = history;
        self.textures.begin();
        self.textures.place(device, self.size, &plan, (0, steps.len()), most.images());
        let uniform = self.frame_uniform(device, &moment, &[]);
        let counts = self.counters.as_ref().map(|_| Counters::begin(device));
        let mut queries = self.timing.as_ref().map(|timing| {
            // If the light comes in the target's texture, it is copied; pairs may come or not: no frame has more passes.
            let passes = [false, true].map(|pairs| {
                let copied = HostTraits { in_target: true, pairs, ..traits };
                Plan::hosted(&copied, &self.settings, changes, most_bits).steps.len()
            });
            timing.begin(device, index, passes[0].max(passes[1]))
        });
        let host = |name: &str| surfaces.resource(name);
        let resources = Resources { counts: counts.as_ref(), ..Resources::new(&host, &uniform) };
        self.record(device, encoder, steps, &resources, &mut queries, &mut after)?;
        let image = |image| self.textures.view(Slot::Now(image)).cloned();
        let reshade = match (image(Image::Guide), image(Image::Repeats), image(Image::Shifts)) {
            (Some(guide), Some(repeats), Some(shifts)) if plan.features.has(Feature::Reshade) => {
                Some(Reshade { frame: uniform.clone(), guide, repeats, shifts })
            }
            _ => None,
        };
        let motion = Motion { motion: surfaces.motion.clone(), previous_depth: surfaces.previous_depth.cloned() };
        self.begun = Some(Begun { moment, changes, uniform, traits, motion, counts, queries });
        Ok(reshade)
    }

    /// Records the second half of a host's frame: takes the light, filters, and writes linear radiance into the target.
    ///
    /// # Errors
    /// Names the view or setting that is wrong, [`Error::NotBegun`] without a [`Denoiser::begin_frame`]; nothing is recorded then,
    /// the history stays, and it may be called again.
    pub fn denoise(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        shading: &Shading<'_>,
    ) -> Result<(), Error> {
        self.denoise_stepwise(device, encoder, shading, |_, _| {})
    }

    /// As [`Denoiser::denoise`], and calls the host after each pass has been recorded: it may put another encoder in the place of
    /// this one and submit what was recorded so far. That is how to time passes on an adapter without (honest) timestamps.
    ///
    /// # Errors
    /// As [`Denoiser::denoise`].
    pub fn denoise_stepwise(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        shading: &Shading<'_>,
        mut after: impl FnMut(Pass, &mut CommandEncoder),
    ) -> Result<(), Error> {
        let begun = self.begun.as_ref().ok_or(Error::NotBegun)?;
        let format = self.check_target(shading.target, &[TextureFormat::Rgba16Float, TextureFormat::Rgba32Float])?;
        let (mut traits, changes) = (begun.traits, begun.changes);
        views::shading(&mut traits, shading, self.size, (&self.settings, changes))?;
        let plan = self.adapt(Plan::hosted(&traits, &self.settings, changes, format));
        let images = Plan::hosted(&traits, &self.settings, Changes::ANY, format).images();
        let steps = &plan.steps[plan.surface_steps()..];
        self.compile(steps, Traversal::default())?;
        let Some(Begun { mut moment, mut uniform, motion, counts, mut queries, .. }) = self.begun.take() else {
            return Err(Error::NotBegun);
        };
        let light = Light {
            textures: !traits.albedo && !traits.demodulated,
            emission: !traits.emission && !traits.demodulated,
        };
        let same_light = |l: &LastFrame| matches!(l.source, Source::Host(before) if before == light);
        let lost = !self.textures.has_all_before(&plan) || !self.last.as_ref().is_some_and(same_light);
        self.textures.place(device, self.size, &plan, (plan.surface_steps(), plan.steps.len()), images);
        let block = shading.lambda.as_ref().map_or(1, |l: &Lambda<'_>| l.block);
        if (lost && moment.continued) || block != 1 {
            // An image that the last frame did not have (an albedo, say) has nothing to compare with.
            moment.continued &= !lost;
            moment.lambda_block = block;
            uniform = self.frame_uniform(device, &moment, &[]);
        }
        let host = |name: &str| shading.resource(name).or_else(|| motion.resource(name));
        let target = Some(shading.target);
        let resources = Resources { counts: counts.as_ref(), target, ..Resources::new(&host, &uniform) };
        self.record(device, encoder, steps, &resources, &mut queries, &mut after)?;
        if let (Some(timing), Some(queries)) = (&self.timing, queries) {
            timing.end(device, encoder, queries);
        }
        if let (Some(counters), Some(counts)) = (&self.counters, &counts) {
            counters.end(device, encoder, counts, moment.index);
        }
        self.history = true;
        let Moment { camera, index, .. } = moment;
        self.last = Some(LastFrame { plan, uniform, camera, source: Source::Host(light), index });
        Ok(())
    }

    /// Forgets a frame that was begun and not denoised: its images are the next frame's to write.
    pub(crate) fn abandon(&mut self) {
        if self.begun.take().is_some() {
            self.textures.abandon();
        }
    }
}
