//! Helpers that the fuzz targets share.

use std::collections::BTreeMap;
use std::path::PathBuf;

/// Separator between the files of one input.
pub const NEXT_FILE: u8 = 0;

/// Splits one input into files. A GLB file is never split, because it has zero bytes of its own, and all its references
/// may be within it.
pub fn split(input: &[u8]) -> (&[u8], &[u8]) {
    if input.starts_with(b"glTF") {
        return (input, &[]);
    }
    match input.iter().position(|&byte| byte == NEXT_FILE) {
        Some(at) => (&input[..at], &input[at + 1..]),
        None => (input, &[]),
    }
}

/// Returns a file system of these files.
pub fn files<const N: usize>(files: [(&str, &[u8]); N]) -> BTreeMap<PathBuf, Vec<u8>> {
    files.into_iter().map(|(name, bytes)| (name.into(), bytes.to_vec())).collect()
}
