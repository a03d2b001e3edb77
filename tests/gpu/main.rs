//! The denoiser and the path tracer through the public interface, on a GPU or a software adapter: their behaviour over frames, and
//! the correctness of their images. See common/gpu.rs for the demands of these tests on the machine.
#![cfg(feature = "path-tracer")]

mod behaviour;
mod common;
mod estimator;
mod host;
