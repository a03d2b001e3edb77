//! One frame: the frame that it continues, and the recording of its passes.
//!
//! [`history`] decides by plain data whether a frame continues the last one, and what has changed. [`recorder`] owns the
//! denoiser's part of the GPU and records the steps of a plan into the host's encoder.

mod history;
mod recorder;

pub(crate) use history::{Begun, History, Identity, LastFrame, Light, Motion, Source};
pub(crate) use recorder::{Recorder, Recording, Resources};
