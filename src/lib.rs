//! Real-time denoising of path-traced images: adaptive spatiotemporal variance-guided filtering (A-SVGF) in WGSL compute
//! shaders on [`wgpu`].
#![deny(missing_docs)]
// Without the path tracer nothing feeds the filter yet.
#![cfg_attr(
    not(feature = "path-tracer"),
    allow(dead_code, unused_imports, reason = "the host's own frames are to come")
)]
#![warn(missing_debug_implementations)]

pub use wgpu;

// Helpers in tests/ that unit tests share with integration tests know the crate by its name.
#[cfg(test)]
extern crate self as asvgf;

mod camera;
mod denoiser;
mod error;
mod gpu;
#[cfg(feature = "image")]
pub mod image_io;
mod passes;
pub mod plan;
#[cfg(feature = "path-tracer")]
pub mod scene;
mod settings;
#[cfg(all(test, feature = "path-tracer"))]
mod twins;
mod view;

pub use camera::Camera;
#[cfg(feature = "path-tracer")]
pub use denoiser::Frame;
pub use denoiser::{Denoiser, DenoiserDescriptor, Requirements};
pub use error::Error;
pub use gpu::timing::FrameTimes;
pub use passes::Pass;
pub use settings::*;
pub use view::{View, ViewOptions};

/// A host may record in any thread (in browsers GPU objects belong to one).
#[cfg(not(target_arch = "wasm32"))]
const _: () = {
    const fn shared<T: Send + Sync>() {}
    shared::<Denoiser>();
    shared::<Error>();
    #[cfg(feature = "path-tracer")]
    shared::<scene::GpuScene>();
};
