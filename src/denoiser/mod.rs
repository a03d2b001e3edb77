//! The [`Denoiser`]: carries out a [`Plan`] in the host's encoder.

mod hosted;
mod show;
mod stepwise;
#[cfg(feature = "path-tracer")]
mod traced;

pub use stepwise::Stepwise;
#[cfg(feature = "path-tracer")]
pub use traced::Frame;

use crate::Error;
use crate::frame::{History, Recorder};
use crate::gpu::counts::{Counters, InputCounts};
use crate::gpu::pipelines::Pipelines;
use crate::gpu::textures::Textures;
use crate::gpu::timing::{FrameTimes, Timing};
use crate::plan::{Changes, Decision, HostInputs, Plan, Traversal};
use crate::settings::Settings;
use wgpu::{Device, Features, Limits, Queue, TextureFormat};

/// The description of a [`Denoiser`].
#[derive(Clone, Debug, Default)]
pub struct DenoiserDescriptor {
    /// Width and height of the image in pixels, each 1…`max_texture_dimension_2d`.
    pub size: [u32; 2],
    /// The settings to start with.
    pub settings: Settings,
    /// True to measure each pass on the GPU; needs [`wgpu::Features::TIMESTAMP_QUERY`] on the device.
    pub timing: bool,
    /// True to count the pixels of a host's frames that have to be cleaned, for [`Denoiser::take_counts`].
    pub diagnostics: bool,
    /// True to keep every intermediate image until the next frame, so that [`Denoiser::show`] can show any. This costs memory: without
    /// it, an image that is no longer read gives its texture to another.
    pub views: bool,
    /// The extent to which shaders are specialized.
    pub specialize: Specialize,
    /// Another denoiser's [`Denoiser::pipelines`], to share compiled shaders. Both must be of the same device.
    pub pipelines: Option<Pipelines>,
}

/// The extent to which shaders are specialized for the scene, the settings and the changes since the last frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Specialize {
    /// Frames run exactly the code that the scene, the settings and the changes since the last frame need: the least work. When these
    /// change, a new shader may have to be compiled; [`Denoiser::prepare`] compiles it ahead.
    #[default]
    Exactly,
    /// Frames run everything that the materials and lights of such a scene, and any frame of these settings, may need. It is compiled
    /// once, whatever changes, and nothing is left out. Instances, normals, an environment and the views of a host still decide which
    /// bindings there are.
    Everything,
}

/// The features and limits that a [`Denoiser`] needs from the device.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Requirements {
    /// Features that must be enabled.
    pub features: Features,
    /// Limits that must be reached; those of [`wgpu::Limits::default`] always do.
    pub limits: Limits,
}

/// Turns noisy samples into clean frames. The samples come from the host's own renderer, in two calls a frame
/// ([`Denoiser::begin_frame`], [`Denoiser::denoise`]), or from a `GpuScene` that the denoiser traces itself (`render`).
///
/// It records into the host's encoder and never submits, waits or prints. Several frames, or several denoisers, may be
/// recorded into one encoder. History lives in the denoiser; use one per view. A traced frame and a host's do not share it.
#[derive(Debug)]
pub struct Denoiser {
    settings: Settings,
    specialize: Specialize,
    recorder: Recorder,
    history: History,
}

impl Denoiser {
    /// The features and limits that a device must have for these settings.
    pub fn requirements(descriptor: &DenoiserDescriptor) -> Requirements {
        let features = if descriptor.timing { Features::TIMESTAMP_QUERY } else { Features::empty() };
        Requirements { features, limits: Limits::default() }
    }

    /// Makes a denoiser for images of one size. Shaders are compiled when a frame first needs them.
    ///
    /// # Errors
    /// Names the feature or limit that the device lacks, or the setting that is out of range.
    pub fn new(device: &Device, queue: &Queue, descriptor: &DenoiserDescriptor) -> Result<Self, Error> {
        descriptor.settings.check()?;
        let required = Self::requirements(descriptor);
        let missing = required.features - device.features();
        if !missing.is_empty() {
            return Err(Error::Feature { missing, setting: "DenoiserDescriptor::timing" });
        }
        // A device that is strict about WebGPU reports 0 for limits of wgpu's own, whatever it can do.
        let mut needed = required.limits;
        needed.zero_native_only();
        let mut shortfall = None;
        needed.check_limits_with_fail_fn(&device.limits(), false, |limit, needed, available| {
            shortfall.get_or_insert(Error::Limit { limit, needed, available });
        });
        if let Some(error) = shortfall {
            return Err(error);
        }
        check_size(device, descriptor.size)?;
        let pipelines = match &descriptor.pipelines {
            Some(shared) if shared.belong_to(device) => shared.clone(),
            Some(_) => return Err(Error::OtherDevice),
            None => Pipelines::new(device)?,
        };
        let textures = Textures::new(descriptor.views);
        let timing = descriptor.timing.then(|| Timing::new(queue));
        let counters = descriptor.diagnostics.then(Counters::default);
        Ok(Self {
            settings: descriptor.settings.clone(),
            specialize: descriptor.specialize,
            recorder: Recorder::new(device, descriptor.size, pipelines, textures, timing, counters),
            history: History::default(),
        })
    }

    /// Compiles ahead the shaders that a host's frames may need, so that none of them has to wait: `inputs` describes its views, and
    /// `target` is the format of [`Shading::target`](crate::Shading::target). May take seconds.
    ///
    /// # Errors
    /// [`Error::Shader`], which is a defect of this crate.
    pub fn prepare_hosted(&self, inputs: &HostInputs, target: TextureFormat) -> Result<(), Error> {
        let inputs = HostInputs { views: self.recorder.textures.keeps(), ..*inputs };
        self.every_change().iter().try_for_each(|&changes| {
            let plan = self.recorder.adapt(Plan::hosted(&inputs, &self.settings, changes, target));
            self.recorder.compile(&plan.steps, Traversal::default())
        })
    }

    /// The compiled shaders, to share with another denoiser of the same device.
    pub fn pipelines(&self) -> &Pipelines {
        &self.recorder.pipelines
    }

    /// The decisions of the last frame's plan, each with its reason.
    pub fn decisions(&self) -> &[Decision] {
        self.plan().map_or(&[], |plan| &plan.decisions)
    }

    /// The settings in force.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Changes settings from the next frame on. The history is kept unless the new settings need another kind of history. A frame that
    /// was begun has to be begun again.
    ///
    /// # Errors
    /// The setting that is out of range; the old ones stay in force.
    pub fn set_settings(&mut self, settings: Settings) -> Result<(), Error> {
        settings.check()?;
        self.abandon();
        if settings.mode != self.settings.mode || settings.filter.feedback != self.settings.filter.feedback {
            self.history.forget();
        }
        self.settings = settings;
        Ok(())
    }

    /// Changes the size of the image. The next frame starts without history.
    ///
    /// # Errors
    /// A size outside the device's limits; the old one stays.
    pub fn resize(&mut self, device: &Device, size: [u32; 2]) -> Result<(), Error> {
        check_size(device, size)?;
        if size != self.recorder.size {
            self.abandon();
            self.recorder.size = size;
            self.recorder.textures.clear();
            self.history.clear();
        }
        Ok(())
    }

    /// Forgets the history, as after a camera cut, and a frame that was begun.
    pub fn reset(&mut self) {
        self.abandon();
        self.history.forget();
    }

    /// Width and height of the image in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.recorder.size
    }

    /// Bytes of the denoiser's own textures, see [`Plan::bytes`].
    pub fn memory(&self) -> u64 {
        self.recorder.textures.bytes()
    }

    /// The plan of the last frame: its passes, and the reason why each feature was in or left out.
    pub fn plan(&self) -> Option<&Plan> {
        self.history.last().map(|last| &last.plan)
    }

    /// Takes the GPU times of the oldest finished frame that was not taken yet; `None` if there is none. Never waits: poll the device
    /// as usual.
    pub fn take_times(&mut self) -> Option<FrameTimes> {
        self.recorder.timing.as_ref()?.take()
    }

    /// Takes the counts of cleaned input in the oldest finished frame that was not taken yet. `None` if there is none, and always
    /// without [`DenoiserDescriptor::diagnostics`]. Never waits: poll the device as usual.
    pub fn take_counts(&mut self) -> Option<InputCounts> {
        self.recorder.counters.as_ref()?.take()
    }

    /// The changes in which plans of one kind of frame differ.
    fn every_change(&self) -> &'static [Changes] {
        match self.specialize {
            Specialize::Exactly => &[Changes::ANY, Changes { camera: true, scene: false }, Changes::NONE],
            Specialize::Everything => &[Changes::ANY],
        }
    }

    /// The changes that a frame's plan allows for. If no last frame is known, anything may have changed.
    fn changes(&self, known: Option<Changes>) -> Changes {
        match self.specialize {
            Specialize::Exactly => known.unwrap_or_default(),
            Specialize::Everything => Changes::ANY,
        }
    }

    /// Forgets a frame that was begun and not denoised, because the next frame may write its images.
    fn abandon(&mut self) {
        if self.history.take_begun().is_some() {
            self.recorder.textures.abandon();
        }
    }
}

fn check_size(device: &Device, size: [u32; 2]) -> Result<(), Error> {
    let limit = device.limits().max_texture_dimension_2d;
    if size.iter().all(|&s| s >= 1 && s <= limit) {
        Ok(())
    } else {
        Err(Error::Size { width: size[0], height: size[1], limit })
    }
}
