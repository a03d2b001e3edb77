//! Image files: EXR with any number of named channels, and PNG.
//!
//! Files are written under a temporary name in the same folder and renamed when they are complete. So no file is ever half
//! written, and an older file stays until the new one replaces it.

mod channels;
mod exr_file;
mod files;
#[cfg(feature = "path-tracer")]
mod format;
mod png;

pub use channels::{Channels, read_exr, write_exr, write_exr_rgb};
pub use exr_file::{Attribute, Compression, ExrFile, SampleType, Window};
pub use png::{read_png, write_png};

pub(crate) use files::{MAX_SIDE, limits, read_file};
#[cfg(feature = "path-tracer")]
pub(crate) use format::{Format, recognise};

use std::path::Path;

/// Reason for which an image file cannot be read or written.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{file}: {reason}")]
#[non_exhaustive]
pub struct ImageError {
    /// The file.
    pub file: String,
    /// The fault.
    pub reason: String,
}

impl ImageError {
    fn new(file: &Path, reason: impl Into<String>) -> Self {
        Self { file: file.display().to_string(), reason: reason.into() }
    }
}
