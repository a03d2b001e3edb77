//! Changes since the last frame.

/// The parts of a frame that may have changed since the last one. A frame leaves out the work that only changes would need.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Changes {
    /// The camera: place, direction, projection or jitter.
    pub camera: bool,
    /// Anything else that decides the light of a path: surfaces, materials, lights, and the settings of tracing. While it is unchanged,
    /// a repeated path finds the same light, wherever the camera is: the temporal gradient is 0.
    pub scene: bool,
}

impl Changes {
    /// Everything may have changed: always a correct answer.
    pub const ANY: Self = Self { camera: true, scene: true };
    /// Nothing has changed.
    pub const NONE: Self = Self { camera: false, scene: false };

    /// The changes of both.
    pub(crate) fn or(self, other: Self) -> Self {
        Self { camera: self.camera || other.camera, scene: self.scene || other.scene }
    }
}

impl Default for Changes {
    fn default() -> Self {
        Self::ANY
    }
}
