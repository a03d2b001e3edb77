//! Real-time denoising of path-traced images: adaptive spatiotemporal variance-guided filtering (A-SVGF) in WGSL compute
//! shaders on [`wgpu`].
#![deny(missing_docs)]
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
pub use denoiser::{Denoiser, DenoiserDescriptor, Frame, Requirements};
pub use error::Error;
pub use gpu::timing::FrameTimes;
pub use passes::Pass;
pub use settings::*;
pub use view::{View, ViewOptions};

/// A host may record in any thread.
const _: () = {
    const fn shared<T: Send + Sync>() {}
    shared::<Denoiser>();
    shared::<Error>();
    #[cfg(feature = "path-tracer")]
    shared::<scene::GpuScene>();
};
