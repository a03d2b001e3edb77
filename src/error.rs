//! What can go wrong, each error naming what is wrong and what would do.

use wgpu::{Features, TextureFormat};

/// Why a [`Denoiser`](crate::Denoiser) cannot be made or used so. Nothing was recorded and no history was lost.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A limit of the host's device is too low.
    #[error("the device's limit `{limit}` is {available}, {needed} is needed: request it when creating the device")]
    Limit {
        /// Name of the limit in [`wgpu::Limits`].
        limit: &'static str,
        /// What is needed.
        needed: u64,
        /// What the device was created with.
        available: u64,
    },
    /// A feature that a setting asks for was not enabled on the host's device.
    #[error("the device lacks {missing:?}, which {setting} needs: request it when creating the device")]
    Feature {
        /// What is missing.
        missing: Features,
        /// The setting that needs it.
        setting: &'static str,
    },
    /// The pipelines to share are of another device.
    #[error("`DenoiserDescriptor::pipelines` belong to another device: share those of a denoiser of this one, or none")]
    OtherDevice,
    /// The size of the image is 0 in a direction or larger than the device's textures may be.
    #[error("the image size {width}×{height} is outside 1…{limit}")]
    Size {
        /// Width asked for, in pixels.
        width: u32,
        /// Height asked for, in pixels.
        height: u32,
        /// The device's `max_texture_dimension_2d`.
        limit: u32,
    },
    /// A view of the host's has a format that cannot be used so.
    #[error("the view `{view}` has the format {format:?}; it takes {accepted}")]
    ViewFormat {
        /// Which view.
        view: &'static str,
        /// What it has.
        format: TextureFormat,
        /// What it may have.
        accepted: &'static str,
    },
    /// A view of the host's has another size than the denoiser.
    #[error(
        "the view `{view}` is {found:?} pixels, the denoiser {expected:?}: call `resize` or pass a view of that size"
    )]
    ViewSize {
        /// Which view.
        view: &'static str,
        /// Its size.
        found: [u32; 2],
        /// The denoiser's size.
        expected: [u32; 2],
    },
    /// A view's texture was created without a usage that is needed.
    #[error("the texture of the view `{view}` was created without `{missing:?}`")]
    ViewUsage {
        /// Which view.
        view: &'static str,
        /// What is missing.
        missing: wgpu::TextureUsages,
    },
    /// A view's texture is not a plain two-dimensional one.
    #[error(
        "the texture of the view `{view}` is {found}; it must have two dimensions, one layer and one sample per pixel"
    )]
    ViewShape {
        /// Which view.
        view: &'static str,
        /// What it is instead.
        found: &'static str,
    },
    /// A view that a setting needs was not given.
    #[error("{setting} needs the view `{view}`: {remedy}")]
    ViewMissing {
        /// Which view.
        view: &'static str,
        /// The setting.
        setting: &'static str,
        /// What would do.
        remedy: &'static str,
    },
    /// The gradient cannot come from where `filter.gradient` says in this kind of frame.
    #[error("`filter.gradient` is {asked:?}, which {reason}")]
    GradientSource {
        /// The setting.
        asked: crate::Gradient,
        /// Why not, and what would do.
        reason: &'static str,
    },
    /// [`denoise`](crate::Denoiser::denoise) without its [`begin_frame`](crate::Denoiser::begin_frame).
    #[error(
        "`denoise` without `begin_frame`: call that first in each frame, and again after `reset`, `resize` and changed settings"
    )]
    NotBegun,
    /// A setting is outside its range.
    #[error("the setting `{setting}` is {value}; it must be {accepted}")]
    Setting {
        /// Which setting.
        setting: &'static str,
        /// Its value.
        value: f64,
        /// Its range, in words.
        accepted: &'static str,
    },
    /// The camera is not a perspective one with finite numbers.
    #[error("the camera's {element} {reason}")]
    Camera {
        /// Which part.
        element: &'static str,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// An intermediate image was asked for that the current settings do not make.
    #[error("the view {view:?} does not exist: {reason}")]
    NoView {
        /// What was asked for.
        view: crate::View,
        /// Why it is not there.
        reason: &'static str,
    },
    /// A shader did not compile; this is a defect of the crate.
    #[error("the shader `{shader}` with {features} does not compile: {message}")]
    Shader {
        /// File name without its ending.
        shader: &'static str,
        /// Names of the features that were compiled in.
        features: String,
        /// The compiler's message.
        message: String,
    },
}
