//! Real-time denoising of path-traced images: adaptive spatiotemporal variance-guided filtering (A-SVGF) in WGSL compute
//! shaders on [`wgpu`].
//!
//! A [`Denoiser`] holds the pipelines and the history of one view. It filters the frames of the host's own renderer, in two
//! calls a frame ([`Denoiser::begin_frame`], [`Denoiser::denoise`]), or traces a `scene::GpuScene` itself. Both kinds of frames are
//! recorded into the host's encoder. The denoiser never submits, waits, prints or owns the device. A device with
//! `Limits::default()` and no features is enough.
//!
//! A frame of a host's renderer:
//! ```no_run
//! use asvgf::{Denoiser, Error, Matrices, Shading, Surfaces, wgpu};
//!
//! # struct Images { depth: wgpu::TextureView, normal: wgpu::TextureView, motion: wgpu::TextureView,
//! #     albedo: wgpu::TextureView, radiance: wgpu::TextureView, target: wgpu::TextureView }
//! fn frame(
//!     denoiser: &mut Denoiser,
//!     device: &wgpu::Device,
//!     encoder: &mut wgpu::CommandEncoder,
//!     images: &Images,
//!     camera: Matrices,
//!     index: u32,
//!     trace: impl FnOnce(&mut wgpu::CommandEncoder, Option<asvgf::Reshade>),
//! ) -> Result<(), Error> {
//!     let surfaces = Surfaces::new(camera, index, &images.depth, &images.normal, &images.motion);
//!     // With `Gradient::Reshade`, `RESHADE_WGSL` tells the host's shader which pixel of each 3×3 repeats a path of the last
//!     // frame. By default α adapts to the image alone, and this is `None`.
//!     let reshade = denoiser.begin_frame(device, encoder, &surfaces)?;
//!     trace(encoder, reshade);
//!     let shading = Shading { albedo: Some(&images.albedo), ..Shading::new(&images.radiance, &images.target) };
//!     denoiser.denoise(device, encoder, &shading)
//! }
//! ```
#![cfg_attr(
    all(feature = "path-tracer", feature = "gltf"),
    doc = r#"
With the path tracer:
```no_run
use asvgf::{Camera, Denoiser, DenoiserDescriptor, Frame, scene, wgpu};

fn frames(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    target: &wgpu::TextureView,
) -> Result<(), Box<dyn std::error::Error>> {
    let loaded = scene::load("room.gltf")?;
    let mut scene = scene::GpuScene::new(device, queue, &loaded.scene)?;
    let descriptor = DenoiserDescriptor { size: [1280, 720], ..Default::default() };
    let mut denoiser = Denoiser::new(device, queue, &descriptor)?;
    for index in 0..100 {
        let mut encoder = device.create_command_encoder(&Default::default());
        scene.update(device, &mut encoder, &loaded.scene.pose(Some(0), index as f32 / 60.0))?;
        let camera = Camera { eye: [0.0, 1.0, 4.0], target: [0.0, 1.0, 0.0], ..Default::default() };
        denoiser.render(device, &mut encoder, &Frame::new(&scene, camera, index, target))?;
        queue.submit([encoder.finish()]);
    }
    Ok(())
}
```
"#
)]
//!
//! # Conventions
//! Radiance is linear Rec. 709. Pixels count from the upper left, x right, y down. Depth is linear along the view. Motion is previous
//! − current position in pixels, without the jitter. The path tracer's world is right-handed, +Y up, in metres; a host's may be any.
//! # Versions
//! Structs that a host fills in have public fields, and minor versions add some. End each literal with `..Default::default()`, or
//! with a constructor if fields have no default:
//! ```
//! # use asvgf::{FilterSettings, Settings, Shading, wgpu};
//! # fn shading<'a>(radiance: &'a wgpu::TextureView, target: &'a wgpu::TextureView, albedo: &'a wgpu::TextureView) {
//! let filter = FilterSettings { iterations: 3, ..Default::default() };
//! let settings = Settings { filter, ..Default::default() };
//! let shading = Shading { albedo: Some(albedo), ..Shading::new(radiance, target) };
//! # }
//! ```
//! Enums, errors and reports are `#[non_exhaustive]`: a `match` needs an arm for variants to come. The few that are not say why. A new
//! major version of wgpu makes a breaking release.
#![deny(missing_docs)]
#![warn(missing_debug_implementations)]

pub use wgpu;

// Unit tests and integration tests share helpers in tests/, which know the crate by its name.
#[cfg(test)]
extern crate self as asvgf;

mod camera;
mod denoiser;
mod error;
mod frame;
mod gpu;
mod host;
#[cfg(feature = "image")]
pub mod image_io;
mod listed;
#[cfg(feature = "metrics")]
pub mod metrics;
mod passes;
pub mod plan;
#[cfg(feature = "path-tracer")]
pub mod scene;
mod settings;
#[cfg(all(test, feature = "path-tracer"))]
mod twins;
mod view;

pub use camera::{Camera, Matrices, Viewpoint};
#[cfg(feature = "path-tracer")]
pub use denoiser::Frame;
pub use denoiser::{Denoiser, DenoiserDescriptor, Requirements, Specialize, Stepwise};
pub use error::Error;
pub use gpu::counts::InputCounts;
pub use gpu::pipelines::Pipelines;
pub use gpu::timing::FrameTimes;
pub use host::{Gloss, Lambda, Pairs, Reshade, Shading, Surfaces};
pub use passes::Pass;
pub use plan::Changes;
pub use settings::{
    Blend, Choice, Compiles, Field, FilterSettings, Gradient, Kernel, Mode, Setting, SettingKind, Settings, Stops,
    Variance,
};
#[cfg(feature = "path-tracer")]
pub use settings::{Sampling, TracerSettings};
pub use view::{View, ViewOptions};

/// WGSL for a host's own shader, for [`Gradient::Reshade`]. `asvgf_surface(frame, guide, repeats, shifts, pixel)` returns an
/// `AsvgfSurface`: the point to shade in a pixel, and the pixel and frame to seed the random numbers from. It declares no
/// bindings; bind [`Reshade`]'s four anywhere, as `var<uniform> …: AsvgfFrame` and three `texture_2d<u32>`.
pub const RESHADE_WGSL: &str = include_str!("../shaders/host/reshade.wgsl");

/// Asserts that a host may record in any thread (in browsers, GPU objects belong to one).
#[cfg(not(target_arch = "wasm32"))]
const _: () = {
    const fn shared<T: Send + Sync>() {}
    shared::<Denoiser>();
    shared::<Error>();
    #[cfg(feature = "path-tracer")]
    shared::<scene::GpuScene>();
};
