//! The denoiser and the path tracer through the public interface, on a GPU or a software adapter: what they do over frames,
//! and whether their images are right. See common/gpu.rs for what these tests ask of the machine.
#![cfg(feature = "path-tracer")]

mod behaviour;
mod common;
mod estimator;
mod host;
