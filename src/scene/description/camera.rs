//! Cameras that a scene holds.

/// A perspective projection. Its place and direction come from the node that holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perspective {
    /// Vertical field of view in radians, 0 < fov < π.
    pub fov_y: f32,
}

impl Perspective {
    /// A symmetric perspective, as wide as the picture asks for.
    pub fn new(fov_y: f32) -> Self {
        Self { fov_y }
    }
}
