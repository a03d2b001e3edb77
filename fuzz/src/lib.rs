//! What the fuzz targets share: readers take files, and a fuzzer has bytes.

use std::fs;
use std::path::{Path, PathBuf};

/// Stands between the files of one input.
pub const NEXT_FILE: u8 = 0;

/// A folder of this process that is empty but for the files of the present input.
pub struct Folder(PathBuf);

impl Folder {
    /// In memory, where there is a file system for that.
    pub fn new(name: &str) -> Self {
        let root = if Path::new("/dev/shm").is_dir() { PathBuf::from("/dev/shm") } else { std::env::temp_dir() };
        let folder = root.join(format!("asvgf-fuzz-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder to write into");
        Self(folder)
    }

    /// Puts a file there.
    pub fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, bytes).expect("a file to write");
        path
    }
}

/// The files of one input.
pub fn split(input: &[u8]) -> (&[u8], &[u8]) {
    match input.iter().position(|&byte| byte == NEXT_FILE) {
        Some(at) => (&input[..at], &input[at + 1..]),
        None => (input, &[]),
    }
}
