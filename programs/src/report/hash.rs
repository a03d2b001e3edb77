//! Hashes that name results by everything that decides them.

use crate::program::repository;
use std::fmt::{self, Debug, Write};
use std::path::Path;

/// FNV-1a (Fowler, Noll, Vo), 64 bits: the same on every machine and with every compiler, unlike the standard library's
/// hash.
#[derive(Clone, Copy, Debug)]
pub struct Hash(u64);

impl Hash {
    /// Hashes files and folders of this repository.
    pub fn of(paths: &[&str]) -> std::io::Result<Self> {
        Self(0xcbf2_9ce4_8422_2325).and_files(paths)
    }

    /// Adds files and folders of this repository to the hash.
    pub fn and_files(mut self, paths: &[&str]) -> std::io::Result<Self> {
        for path in paths {
            self.file(&repository().join(path))?;
        }
        Ok(self)
    }

    /// Hashes a shader of this repository and all its imports, of all permutations.
    pub fn of_shader(path: &str) -> std::io::Result<Self> {
        let mut files = vec![path.to_owned()];
        for next in 0.. {
            let Some(path) = files.get(next) else { break };
            for module in imports(&std::fs::read_to_string(repository().join(path))?) {
                let file = format!("shaders/shared/{module}.wgsl");
                if !files.contains(&file) {
                    files.push(file);
                }
            }
        }
        Self::of(&files.iter().map(String::as_str).collect::<Vec<_>>())
    }

    /// Adds the debug output of a thing to the hash.
    pub fn and(mut self, thing: &impl Debug) -> Self {
        // The formatter streams into the hash and keeps no text, because the scenes' textures can make it long.
        let _ = write!(self, "{thing:?};");
        self
    }

    fn file(&mut self, path: &Path) -> std::io::Result<()> {
        if !path.is_dir() {
            self.bytes(&std::fs::read(path)?);
            return Ok(());
        }
        let entries = std::fs::read_dir(path)?.map(|entry| Ok(entry?.path()));
        let mut paths: Vec<_> = entries.collect::<std::io::Result<_>>()?;
        paths.sort();
        paths.iter().try_for_each(|path| self.file(path))
    }

    fn bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

impl Write for Hash {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.bytes(text.as_bytes());
        Ok(())
    }
}

impl fmt::Display for Hash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

/// Returns the modules that a shader imports, by name.
fn imports(source: &str) -> impl Iterator<Item = &str> {
    let named = source.lines().filter_map(|line| line.trim().strip_prefix("#import asvgf::"));
    named.map(|rest| rest.split("::").next().unwrap_or(rest))
}
