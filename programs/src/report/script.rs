//! A sequence before any tracing: the poses of its frames, and the names of their references.

use crate::program::repository;
use crate::render::options::Options as Shown;
use crate::report::hash::Hash;
use crate::report::suite::{Sequence, Suite};
use crate::stage::Stage;
use asvgf::scene::Pose;
use asvgf::{Camera, Settings};
use std::error::Error;
use std::path::PathBuf;

/// Folder of references, which several reports share.
const FOLDER: &str = "target/references";

/// Shaders that decide the converged image: the filter may change without them.
const TRACERS: [&str; 2] = ["shaders/visibility.wgsl", "shaders/trace.wgsl"];

/// Code that hands the scene to the shaders, and takes the mean. The readers of scenes are absent, because their result
/// is hashed.
const SCENE: [&str; 4] = ["programs/src/tracing.rs", "src/plan/batches.rs", "src/scene/gpu", "src/denoiser/traced.rs"];

pub struct Script {
    pub stage: Stage,
    /// Hash of the scene and of all settings that references depend on.
    pub hash: Hash,
}

impl Script {
    pub fn load(suite: &Suite, sequence: &Sequence) -> Result<Self, Box<dyn Error>> {
        let Sequence { source, animation, .. } = sequence.clone();
        let stage = Stage::load(&Shown { source, animation, size: suite.size, ..Default::default() })?;
        let tracer = Settings::adaptive().tracer;
        let shaders = TRACERS.map(Hash::of_shader).into_iter().collect::<std::io::Result<Vec<_>>>()?;
        let code = Hash::of(&SCENE)?.and(&shaders);
        let hash = code.and(&stage.scene).and(&tracer).and(&suite.size).and(&suite.paths);
        Ok(Self { stage, hash })
    }

    /// Returns the pose of a frame, and its camera.
    pub fn frame(&self, index: u32) -> (Pose, Camera) {
        let pose = self.stage.pose(index);
        let camera = self.stage.camera(&pose, index);
        (pose, camera)
    }

    /// Returns the file of a frame's reference. Frames that look the same share theirs.
    pub fn reference(&self, pose: &Pose, camera: &Camera) -> PathBuf {
        repository().join(FOLDER).join(format!("{}.exr", self.hash.and(pose).and(camera)))
    }
}
