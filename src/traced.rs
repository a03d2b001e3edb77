//! Frames of a path-traced scene.

use crate::Error;
use crate::camera::{Camera, Viewpoint};
use crate::denoiser::{Denoiser, LastFrame, Resources, Source, Specialize};
use crate::gpu::frame::Moment;
use crate::passes::Pass;
use crate::plan::{Batches, Changes, Plan, Traits};
use crate::scene::GpuScene;
use crate::settings::{Gradient, Mode};
use wgpu::{CommandEncoder, Device, TextureFormat, TextureView};

/// One frame of a path-traced scene.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// What to trace, in the pose that [`GpuScene::update`] was last given.
    pub scene: &'a GpuScene,
    /// From where.
    pub camera: Camera,
    /// Number of the frame. With the pixel it decides all random numbers. It should grow by one per frame: any other step starts a
    /// new history, in every mode.
    pub index: u32,
    /// Where linear radiance goes: an `rgba16float` or `rgba32float` view of the denoiser's size, with storage usage.
    pub target: &'a TextureView,
}

impl Denoiser {
    /// Compiles ahead what frames of a scene may need with the settings in force, whatever changes from one to the next, so that
    /// none of them has to wait. `target` is the format of [`Frame::target`]. May take seconds.
    ///
    /// # Errors
    /// [`Error::Shader`], which is a defect of this crate.
    pub fn prepare(&self, scene: &GpuScene, target: TextureFormat) -> Result<(), Error> {
        let traits = self.traits(scene);
        self.every_change().iter().try_for_each(|&changes| {
            let plan = self.adapt(Plan::path_traced(&traits, &self.settings, changes, target));
            self.compile(&plan.steps, scene.traversal(&traits))
        })
    }

    /// Records one frame: traces the scene, filters, and writes linear radiance into the target.
    ///
    /// # Errors
    /// Names the view, camera or setting that is wrong; nothing is recorded then, and the history stays.
    pub fn render(&mut self, device: &Device, encoder: &mut CommandEncoder, frame: &Frame<'_>) -> Result<(), Error> {
        // No debug group around the frame, only a label on each pass: in debug builds, Mesa 22.3's drivers crash at the
        // second group of an encoder (gfx-rs/wgpu#3377), and an encoder may hold many frames.
        self.render_stepwise(device, encoder, frame, |_, _| {})
    }

    /// As [`Denoiser::render`], and calls the host after each pass has been recorded: it may put another encoder in the place
    /// of this one and submit what was recorded so far. That is how to time passes on an adapter without (honest) timestamps.
    ///
    /// # Errors
    /// As [`Denoiser::render`].
    pub fn render_stepwise(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        mut after: impl FnMut(Pass, &mut CommandEncoder),
    ) -> Result<(), Error> {
        let &Frame { scene, index, target, .. } = frame;
        let asked = self.settings.filter.gradient;
        if self.settings.mode == Mode::Denoise && matches!(asked, Gradient::Pairs | Gradient::Lambda) {
            let reason =
                "comes from a host's renderer: choose Automatic, Reshade, Statistics, BlinnPhong or Off for a scene";
            return Err(Error::GradientSource { asked, reason });
        }
        let format = self.check_target(target, &[TextureFormat::Rgba16Float, TextureFormat::Rgba32Float])?;
        let camera = Viewpoint::from(frame.camera).placed(self.size)?;
        let traits = self.traits(scene);
        let most = self.adapt(Plan::path_traced(&traits, &self.settings, Changes::ANY, format));
        let now = scene.snapshot();
        let same_light = |l: &LastFrame| {
            matches!(&l.source, Source::Scene(before, tracer)
                if before.shows_the_same_as(now) && *tracer == self.settings.tracer)
        };
        // Motion and repeated paths lead to the frame before, and a mean over frames is only one of frames that are alike.
        let continues = |l: &LastFrame| {
            let same_scene = matches!(&l.source, Source::Scene(before, _) if before.scene == now.scene);
            let alike = same_light(l) && l.camera == camera;
            l.index.wrapping_add(1) == index && same_scene && (self.settings.mode != Mode::Reference || alike)
        };
        let continued = self.history && self.textures.has_all_before(&most);
        let last = self.last.as_ref().filter(|l| continued && continues(l));
        let known = last.map(|l| Changes { camera: l.camera != camera, scene: !same_light(l) });
        let images = most.images();
        let plan = match self.changes(known) {
            Changes::ANY => most,
            changes => self.adapt(Plan::path_traced(&traits, &self.settings, changes, format)),
        };
        let traversal = scene.traversal(&traits);
        self.compile(&plan.steps, traversal)?;
        let previous = last.map_or(camera, |l| l.camera);
        let continued = last.is_some();
        let (origin, converges) = (scene.centre(), plan.converges());
        let moment = Moment { camera, previous, origin, index, continued, lambda_block: 1, converges };
        let before = match last.map(|l| &l.source) {
            Some(Source::Scene(before, _)) => before.clone(),
            _ => now.clone(),
        };
        let uniform = self.frame_uniform(device, &moment, &Batches::of(&traits, &self.settings.tracer).all());
        self.abandon();
        self.textures.begin();
        self.textures.place(device, self.size, &plan, (0, plan.steps.len()), images);
        let mut queries = self.timing.as_ref().map(|t| t.begin(device, index, plan.steps.len()));
        let given = |name: &str| scene.resource(name).or_else(|| before.resource(name));
        let resources = Resources { traversal, target: Some(target), ..Resources::new(&given, &uniform) };
        self.record(device, encoder, &plan.steps, &resources, &mut queries, &mut after)?;
        if let (Some(timing), Some(queries)) = (&self.timing, queries) {
            timing.end(device, encoder, queries);
        }
        self.history = true;
        let source = Source::Scene(now.clone(), self.settings.tracer.clone());
        self.last = Some(LastFrame { plan, uniform, camera, source, index });
        Ok(())
    }

    /// What the shaders are to be able to do.
    fn traits(&self, scene: &GpuScene) -> Traits {
        let traits = Traits { views: self.textures.keeps(), ..scene.traits() };
        match self.specialize {
            Specialize::Exactly => traits,
            Specialize::Everything => traits.everything(),
        }
    }
}
