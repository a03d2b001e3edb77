//! A sequence before anything is traced: where everything is in its frames, and how their references are called.

use crate::program::repository;
use crate::render::options::Options as Shown;
use crate::report::hash::Hash;
use crate::report::suite::{Sequence, Suite};
use crate::stage::Stage;
use asvgf::scene::Pose;
use asvgf::{Camera, Settings};
use std::error::Error;
use std::path::PathBuf;

/// Where references are kept between reports.
const FOLDER: &str = "target/references";

/// The shaders that decide what converges: a filter may change without them.
const TRACERS: [&str; 2] = ["shaders/visibility.wgsl", "shaders/trace.wgsl"];

/// What hands them the scene, and takes the mean. What reads scenes from files is not there: its outcome is hashed.
const SCENE: [&str; 4] = ["programs/src/tracing.rs", "src/plan/batches.rs", "src/scene/gpu", "src/denoiser/traced.rs"];

pub struct Script {
    pub stage: Stage,
    /// Of the scene and all settings that references depend on.
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

    /// Where everything is in a frame, and from where it is seen.
    pub fn frame(&self, index: u32) -> (Pose, Camera) {
        let pose = self.stage.pose(index);
        let camera = self.stage.camera(&pose, index);
        (pose, camera)
    }

    /// The file that a frame's reference is kept in. Frames that look the same share theirs.
    pub fn reference(&self, pose: &Pose, camera: &Camera) -> PathBuf {
        repository().join(FOLDER).join(format!("{}.exr", self.hash.and(pose).and(camera)))
    }
}
