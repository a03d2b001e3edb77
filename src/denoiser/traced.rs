//! Frames of a path-traced scene.

use super::stepwise::Stepwise;
use super::{Denoiser, Specialize};
use crate::camera::{Camera, Viewpoint};
use crate::frame::{Identity, LastFrame, Resources, Source};
use crate::gpu::frame::Moment;
use crate::passes::Pass;
use crate::plan::{Batches, Changes, Plan, SceneContents};
use crate::scene::GpuScene;
use crate::settings::{Gradient, Mode};
use crate::{Error, host};
use wgpu::{CommandEncoder, Device, TextureFormat, TextureView};

/// One frame of a path-traced scene.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// The scene, in the pose that [`GpuScene::update`] was last given.
    pub scene: &'a GpuScene,
    /// The viewpoint.
    pub camera: Camera,
    /// Number of the frame. It decides all random numbers, together with the pixel. It should grow by one per frame: any other step
    /// starts a new history, in every mode.
    pub index: u32,
    /// The view that receives linear radiance: an `rgba16float` or `rgba32float` view of the denoiser's size, with storage usage.
    pub target: &'a TextureView,
}

impl<'a> Frame<'a> {
    /// A frame of a scene, seen by a camera.
    pub fn new(scene: &'a GpuScene, camera: Camera, index: u32, target: &'a TextureView) -> Self {
        Self { scene, camera, index, target }
    }
}

impl Denoiser {
    /// Compiles ahead the shaders that frames of a scene may need with the settings in force, whatever changes from one to the next, so
    /// that none of them has to wait. `target` is the format of [`Frame::target`]. May take seconds.
    ///
    /// # Errors
    /// [`Error::Shader`], which is a defect of this crate.
    pub fn prepare(&self, scene: &GpuScene, target: TextureFormat) -> Result<(), Error> {
        let contents = self.contents(scene);
        self.every_change().iter().try_for_each(|&changes| {
            let plan = self.recorder.adapt(Plan::path_traced(&contents, &self.settings, changes, target));
            self.recorder.compile(&plan.steps, scene.traversal(&contents))
        })
    }

    /// Records one frame: traces the scene, filters, and writes linear radiance into the target.
    ///
    /// # Errors
    /// Names the wrong view, camera or setting. Nothing is recorded then, and the history stays.
    pub fn render(&mut self, device: &Device, encoder: &mut CommandEncoder, frame: &Frame<'_>) -> Result<(), Error> {
        // A debug group around the frame would crash Mesa 22.3's drivers in debug builds, at the second group of an encoder
        // (gfx-rs/wgpu#3377), and an encoder may hold many frames. So each pass has a label, and the frame has no group.
        self.stepwise(|_, _| {}).render(device, encoder, frame)
    }

    /// The contents that the shaders are compiled for.
    fn contents(&self, scene: &GpuScene) -> SceneContents {
        let contents = SceneContents { views: self.recorder.textures.keeps(), ..scene.contents() };
        match self.specialize {
            Specialize::Exactly => contents,
            Specialize::Everything => contents.everything(),
        }
    }
}

impl<F: FnMut(&Pass, &mut CommandEncoder)> Stepwise<'_, F> {
    /// [`Denoiser::render`], pass by pass.
    ///
    /// # Errors
    /// The same as for [`Denoiser::render`].
    pub fn render(&mut self, device: &Device, encoder: &mut CommandEncoder, frame: &Frame<'_>) -> Result<(), Error> {
        let denoiser = &mut *self.denoiser;
        let &Frame { scene, index, target, .. } = frame;
        let (settings, recorder) = (&denoiser.settings, &denoiser.recorder);
        let asked = settings.filter.gradient;
        if settings.mode == Mode::Denoise && matches!(asked, Gradient::Pairs | Gradient::Lambda) {
            let reason =
                "comes from a host's renderer: choose Automatic, Reshade, Statistics, BlinnPhong or Off for a scene";
            return Err(Error::GradientSource { asked: asked.name(), reason });
        }
        let format = host::target(target, recorder.size, &[TextureFormat::Rgba16Float, TextureFormat::Rgba32Float])?;
        let camera = Viewpoint::from(frame.camera).placed(recorder.size)?;
        let contents = denoiser.contents(scene);
        let snapshot = scene.snapshot();
        let (visible, tracer) = (snapshot.visible.clone(), settings.tracer.clone());
        let identity = Identity { index, camera, source: Source::Scene { number: snapshot.scene, visible, tracer } };

        let planned = |changes| recorder.adapt(Plan::path_traced(&contents, settings, changes, format));
        let most = planned(Changes::ANY);
        let last = denoiser.history.continuable().filter(|_| recorder.textures.has_all_before(&most));
        let known = last.and_then(|last| identity.changes_since(&last.identity, settings.mode));
        let last = last.filter(|_| known.is_some());
        let images = most.images();
        let plan = match denoiser.changes(known) {
            Changes::ANY => most,
            changes => planned(changes),
        };
        let traversal = scene.traversal(&contents);
        recorder.compile(&plan.steps, traversal)?;

        let moment = Moment {
            camera,
            previous: last.map_or(camera, |last| last.identity.camera),
            origin: scene.centre(),
            index,
            continued: last.is_some(),
            lambda_block: 1,
            converges: plan.converges(),
        };
        let before = last.and_then(|last| last.snapshot.clone()).unwrap_or_else(|| snapshot.clone());
        let batches = Batches::of(&contents, &settings.tracer).all();
        let uniform = recorder.uniform(device, settings, &moment, &batches);
        denoiser.abandon();
        let recorder = &mut denoiser.recorder;
        recorder.textures.begin();
        recorder.textures.place(device, recorder.size, &plan, (0, plan.steps.len()), images);
        let scene_resource = |binding| scene.resource(binding).or_else(|| before.resource(binding));
        let resources = Resources { traversal, target: Some(target), scene: &scene_resource, ..Default::default() };
        let mut recording = recorder.begin(device, index, || plan.steps.len(), uniform);
        recorder.record(device, encoder, &plan.steps, &resources, &mut recording, &mut self.after)?;
        let uniform = recorder.end(device, encoder, recording);
        let snapshot = Some(snapshot.clone());
        denoiser.history.complete(LastFrame { identity, plan, uniform, light: None, snapshot });
        Ok(())
    }
}
