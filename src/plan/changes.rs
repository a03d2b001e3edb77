//! What may differ from the last frame.

/// What may have changed since the last frame. What has not is work that a frame can leave out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Changes {
    /// The camera: place, direction, projection or jitter.
    pub camera: bool,
    /// Anything else that decides what a path sees: surfaces, materials, lights, and how paths are traced. While it is unchanged, a
    /// repeated path finds what it found, wherever the camera is: the temporal gradient is 0.
    pub scene: bool,
}

impl Changes {
    /// Everything may have changed: always true, and always right.
    pub const ANY: Self = Self { camera: true, scene: true };
    /// Nothing has.
    pub const NONE: Self = Self { camera: false, scene: false };
}

impl Default for Changes {
    fn default() -> Self {
        Self::ANY
    }
}
