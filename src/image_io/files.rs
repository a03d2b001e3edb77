//! Files as bytes: read within limits, written whole or not at all.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

use image::Limits;

use crate::image_io::ImageError;

/// Largest width and height that is read or written.
pub(crate) const MAX_SIDE: usize = 16_384;

/// Largest file that is read, and most memory that the samples of one image may take.
pub(super) const MAX_BYTES: u64 = 1 << 32;

/// Reads the bytes of a file. The error is a reason.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, String> {
    let unreadable = |cause| format!("cannot be read: {cause}");
    let metadata = fs::metadata(path).map_err(unreadable)?;
    if !metadata.is_file() {
        // Pipes and devices may never end.
        return Err("is not a regular file".into());
    }
    if metadata.len() > MAX_BYTES {
        return Err(format!("is {} bytes long; at most {MAX_BYTES} are read", metadata.len()));
    }
    fs::read(path).map_err(unreadable)
}

/// The limits within which images are decoded.
pub(crate) fn limits() -> Limits {
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE as u32);
    limits.max_image_height = Some(MAX_SIDE as u32);
    limits.max_alloc = Some(MAX_BYTES);
    limits
}

/// Returns the number of pixels of an image. The error is a reason.
pub(super) fn area(width: u32, height: u32) -> Result<usize, String> {
    let (width, height) = (width as usize, height as usize);
    check_side(width)?;
    check_side(height)?;
    Ok(width * height)
}

pub(super) fn check_side(side: usize) -> Result<(), String> {
    if (1..=MAX_SIDE).contains(&side) {
        Ok(())
    } else {
        Err(format!("{side} pixels a side are not within 1…{MAX_SIDE}"))
    }
}

/// Puts a complete file in the place of an older one, if there is one.
pub(super) fn replace(path: &Path, bytes: &[u8]) -> Result<(), ImageError> {
    let temporary = temporary_name(path).ok_or_else(|| ImageError::new(path, "is not the name of a file"))?;
    let written = fs::write(&temporary, bytes).and_then(|()| fs::rename(&temporary, path));
    written.map_err(|cause| {
        // The temporary file may not even exist; the first error is the one that matters.
        let _ = fs::remove_file(&temporary);
        ImageError::new(path, format!("cannot be written: {cause}"))
    })
}

/// Makes a name in the same folder that no other process or thread uses.
fn temporary_name(path: &Path) -> Option<PathBuf> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let mut name: OsString = path.file_name()?.to_owned();
    name.push(format!(".{}-{}.tmp", process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
    Some(path.with_file_name(name))
}
