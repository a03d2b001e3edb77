//! The frames before this one: the frame that a new one may continue, and the changes since.

use super::Recording;
use crate::camera::PlacedCamera;
use crate::gpu::frame::Moment;
use crate::plan::{Changes, HostInputs, Plan};
use crate::settings::Mode;
#[cfg(feature = "path-tracer")]
use crate::{
    scene::{Snapshot, Visible},
    settings::TracerSettings,
};
#[cfg(feature = "path-tracer")]
use std::sync::Arc;
use wgpu::{Buffer, TextureView};

/// The state of a denoiser between two calls.
#[derive(Debug, Default)]
pub(crate) struct History {
    /// The last complete frame, which can be shown.
    last: Option<LastFrame>,
    state: State,
}

/// The frames that the next call may continue.
#[derive(Debug, Default)]
enum State {
    /// No frame: the next one starts a history.
    #[default]
    Fresh,
    /// The last frame.
    Complete,
    /// A host's frame that waits for its light, and true if it continues the last frame.
    Begun { frame: Box<Begun>, continued: bool },
}

/// The parts of a complete frame that the next one, and [`Denoiser::show`](crate::Denoiser::show), need.
#[derive(Debug)]
pub(crate) struct LastFrame {
    pub identity: Identity,
    pub plan: Plan,
    pub uniform: Buffer,
    /// The kind of light that a host's history holds.
    pub light: Option<Light>,
    /// The scene as it was.
    #[cfg(feature = "path-tracer")]
    pub snapshot: Option<Arc<Snapshot>>,
}

/// A host's frame between its two calls.
#[derive(Debug)]
pub(crate) struct Begun {
    pub identity: Identity,
    pub moment: Moment,
    pub changes: Changes,
    pub inputs: HostInputs,
    pub motion: Motion,
    pub recording: Recording,
}

/// The views of a frame's surfaces that its second half may read.
#[derive(Debug)]
pub(crate) struct Motion {
    pub motion: TextureView,
    pub previous_depth: Option<TextureView>,
}

/// The kind of light that a host's history holds. A mixture of kinds would multiply textures twice, or never.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Light {
    pub textures: bool,
    pub emission: bool,
    /// True if specular light is part of it, false if that has a history of its own.
    pub specular: bool,
    /// True if a specular reflectance divides it, or the specular light.
    pub reflectance: bool,
}

/// The facts that decide whether a frame continues another one.
#[derive(Clone, Debug)]
pub(crate) struct Identity {
    pub index: u32,
    pub camera: PlacedCamera,
    pub source: Source,
}

/// The origin of a frame's samples.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    /// A host's renderer.
    Host,
    /// The path tracer.
    #[cfg(feature = "path-tracer")]
    Scene {
        /// The scene's number in this process.
        number: u64,
        /// The part of its pose that paths can see.
        visible: Arc<Visible>,
        tracer: TracerSettings,
    },
}

impl Identity {
    /// The changes since the last frame, or `None` if this one does not continue it.
    ///
    /// Motion and repeated paths lead to the frame before, so the index has to grow by one. The mean of `Mode::Reference` is a mean
    /// over frames that are alike. Only the host knows whether its scene has changed: it is taken as unchanged here.
    pub fn changes_since(&self, last: &Self, mode: Mode) -> Option<Changes> {
        let scene = match (&last.source, &self.source) {
            (Source::Host, Source::Host) => false,
            #[cfg(feature = "path-tracer")]
            (
                Source::Scene { number: before, visible: seen, tracer: traced },
                Source::Scene { number, visible, tracer },
            ) if before == number => seen != visible || traced != tracer,
            #[cfg(feature = "path-tracer")]
            _ => return None,
        };
        let changes = Changes { camera: last.camera != self.camera, scene };
        let follows = last.index.wrapping_add(1) == self.index;
        (follows && (mode != Mode::Reference || changes == Changes::NONE)).then_some(changes)
    }
}

impl History {
    /// The last complete frame.
    pub fn last(&self) -> Option<&LastFrame> {
        self.last.as_ref()
    }

    /// The frame that the next one may continue.
    pub fn continuable(&self) -> Option<&LastFrame> {
        match self.state {
            State::Fresh | State::Begun { continued: false, .. } => None,
            State::Complete | State::Begun { continued: true, .. } => self.last(),
        }
    }

    /// A host's frame that waits for its light.
    pub fn begun(&self) -> Option<&Begun> {
        match &self.state {
            State::Begun { frame, .. } => Some(frame),
            State::Fresh | State::Complete => None,
        }
    }

    /// Takes the frame that waits for its light. The last one is as it was before that frame began.
    pub fn take_begun(&mut self) -> Option<Begun> {
        match std::mem::take(&mut self.state) {
            State::Begun { frame, continued } => {
                self.state = if continued { State::Complete } else { State::Fresh };
                Some(*frame)
            }
            state => {
                self.state = state;
                None
            }
        }
    }

    /// Notes that a host's frame has begun. `continued` is true if the images of the last one are still there for it.
    pub fn begin(&mut self, frame: Begun, continued: bool) {
        self.state = State::Begun { frame: Box::new(frame), continued };
    }

    /// Notes that a frame is complete.
    pub fn complete(&mut self, frame: LastFrame) {
        *self = Self { last: Some(frame), state: State::Complete };
    }

    /// Ends the history: no frame continues the last one any more. It can still be shown.
    pub fn forget(&mut self) {
        self.state = State::Fresh;
    }

    /// Notes that the last frame's images are gone.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

#[cfg(all(test, feature = "path-tracer"))]
mod tests {
    use super::*;
    use crate::scene::builtin;
    use crate::{Camera, Viewpoint};

    const SIZE: [u32; 2] = [16, 9];

    fn camera(x: f64) -> PlacedCamera {
        let camera = Camera { eye: [x, 1.0, 4.0], target: [0.0, 1.0, 0.0], ..Default::default() };
        Viewpoint::from(camera).placed(SIZE).unwrap()
    }

    fn visible(time: f32) -> Arc<Visible> {
        let scene = builtin::scene("cornell", "all").unwrap();
        let pose = scene.pose(Some(0), time);
        Arc::new(Visible::new(&pose, 0..pose.world.len(), std::iter::empty()))
    }

    fn traced(index: u32, x: f64, number: u64, time: f32, samples: u32) -> Identity {
        let tracer = TracerSettings { samples, ..Default::default() };
        Identity { index, camera: camera(x), source: Source::Scene { number, visible: visible(time), tracer } }
    }

    fn hosted(index: u32, x: f64) -> Identity {
        Identity { index, camera: camera(x), source: Source::Host }
    }

    const SCENE: Changes = Changes { camera: false, scene: true };
    const CAMERA: Changes = Changes { camera: true, scene: false };

    #[test]
    fn a_frame_continues_the_one_before_it_of_the_same_source() {
        let last = traced(7, 0.0, 1, 0.0, 1);
        let since = |now: &Identity| now.changes_since(&last, Mode::Denoise);
        assert_eq!(since(&traced(8, 0.0, 1, 0.0, 1)), Some(Changes::NONE));
        assert_eq!(since(&traced(8, 0.1, 1, 0.0, 1)), Some(CAMERA));
        assert_eq!(since(&traced(8, 0.0, 1, 0.3, 1)), Some(SCENE), "the pose");
        assert_eq!(since(&traced(8, 0.0, 1, 0.0, 2)), Some(SCENE), "other paths");
        assert_eq!(since(&traced(8, 0.1, 1, 0.3, 1)), Some(Changes::ANY));
        for other in [traced(7, 0.0, 1, 0.0, 1), traced(9, 0.0, 1, 0.0, 1), traced(8, 0.0, 2, 0.0, 1), hosted(8, 0.0)] {
            assert_eq!(since(&other), None, "{}", other.index);
        }
        let end = hosted(u32::MAX, 0.0);
        assert_eq!(hosted(0, 0.0).changes_since(&end, Mode::Denoise), Some(Changes::NONE), "numbers wrap around");
        assert_eq!(hosted(0, 0.5).changes_since(&end, Mode::Denoise), Some(CAMERA));
    }

    #[test]
    fn a_mean_over_frames_ends_where_they_differ() {
        let last = traced(7, 0.0, 1, 0.0, 1);
        let since = |now: &Identity| now.changes_since(&last, Mode::Reference);
        assert_eq!(since(&traced(8, 0.0, 1, 0.0, 1)), Some(Changes::NONE));
        for other in [traced(8, 0.1, 1, 0.0, 1), traced(8, 0.0, 1, 0.3, 1), traced(8, 0.0, 1, 0.0, 2)] {
            assert_eq!(since(&other), None);
        }
    }
}
