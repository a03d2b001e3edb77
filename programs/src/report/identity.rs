//! Identity of a run: the file that keeps it, and the hash of everything that decides its result.

use crate::gpu::Gpu;
use crate::report::hash::Hash;
use crate::report::methods::Method;
use crate::report::suite::Suite;
use std::io;
use std::path::{Path, PathBuf};

/// Code that decides the result of a run.
pub const CODE: [&str; 8] = [
    "shaders",
    "src",
    "programs/src/report/measure.rs",
    "programs/src/report/record.rs",
    "programs/src/report/score.rs",
    "programs/src/report/truth.rs",
    "programs/src/film.rs",
    "programs/src/times.rs",
];

/// Hashes everything that decides a run.
pub fn key(scene: Hash, suite: &Suite, method: &Method, gpu: &Gpu) -> io::Result<String> {
    let key = scene.and_files(&CODE)?.and(&method.settings).and(&suite.frames);
    Ok(key.and(&gpu.adapter.name).to_string())
}

/// Returns the file of a run.
pub fn path(runs: &Path, sequence: &str, method: &Method) -> PathBuf {
    runs.join(sequence).join(format!("{}.json", method.name))
}
