//! The errors. Each names the fault and a remedy.

use wgpu::{Features, TextureFormat};

/// A reason for which a [`Denoiser`](crate::Denoiser) cannot be made, or a frame not recorded. Nothing was recorded and no history was lost.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A limit of the host's device is too low.
    #[error("the device's limit `{limit}` is {available}, {needed} is needed: request it when creating the device")]
    Limit {
        /// Name of the limit in [`wgpu::Limits`].
        limit: &'static str,
        /// The value that is needed.
        needed: u64,
        /// The value that the device was created with.
        available: u64,
    },
    /// A feature that a setting asks for was not enabled on the host's device.
    #[error("the device lacks {missing:?}, which {setting} needs: request it when creating the device")]
    Feature {
        /// The features that the device lacks.
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
    /// A view of the host has a format that it may not have.
    #[error("the view `{view}` has the format {format:?}; it takes {accepted}")]
    ViewFormat {
        /// Name of the view.
        view: &'static str,
        /// Its format.
        format: TextureFormat,
        /// The formats that it may have.
        accepted: &'static str,
    },
    /// A view of the host has another size than the denoiser.
    #[error(
        "the view `{view}` is {found:?} pixels, the denoiser {expected:?}: call `resize` or pass a view of that size"
    )]
    ViewSize {
        /// Name of the view.
        view: &'static str,
        /// Its size.
        found: [u32; 2],
        /// The denoiser's size.
        expected: [u32; 2],
    },
    /// A view's texture was created without a usage that is needed.
    #[error("the texture of the view `{view}` was created without `{missing:?}`")]
    ViewUsage {
        /// Name of the view.
        view: &'static str,
        /// The usages that its texture lacks.
        missing: wgpu::TextureUsages,
    },
    /// A view's texture is not a plain two-dimensional one.
    #[error(
        "the texture of the view `{view}` is {found}; it must have two dimensions, one layer and one sample per pixel"
    )]
    ViewShape {
        /// Name of the view.
        view: &'static str,
        /// Its shape.
        found: &'static str,
    },
    /// A view that a setting needs was not given.
    #[error("{setting} needs the view `{view}`: {remedy}")]
    ViewMissing {
        /// Name of the view.
        view: &'static str,
        /// The setting.
        setting: &'static str,
        /// The remedy.
        remedy: &'static str,
    },
    /// `filter.gradient` names a source that this kind of frame does not have.
    #[error("`filter.gradient` is {asked}, which {reason}")]
    GradientSource {
        /// [`Gradient::name`](crate::Gradient::name) of the setting.
        asked: &'static str,
        /// The reason and the remedy.
        reason: &'static str,
    },
    /// [`denoise`](crate::Denoiser::denoise) was called without its [`begin_frame`](crate::Denoiser::begin_frame).
    #[error(
        "`denoise` without `begin_frame`: call that first in each frame, and again after `reset`, `resize` and changed settings"
    )]
    NotBegun,
    /// A setting is outside its range.
    #[error("the setting `{setting}` is {value}; it must be {accepted}")]
    Setting {
        /// Name of the setting.
        setting: &'static str,
        /// Its value.
        value: f64,
        /// Its range, in words.
        accepted: &'static str,
    },
    /// The camera is not a perspective one with finite numbers.
    #[error("the camera's {element} {reason}")]
    Camera {
        /// Name of the part.
        element: &'static str,
        /// The fault.
        reason: &'static str,
    },
    /// The last frame did not make the intermediate image that was asked for.
    #[error("the view {view:?} does not exist: {reason}")]
    NoView {
        /// The view that was asked for.
        view: crate::View,
        /// The reason for its absence.
        reason: &'static str,
    },
    /// A shader did not compile. This is a defect of the crate.
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
