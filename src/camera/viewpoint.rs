//! The one way from a host's camera to the uniform.

use super::placed::PlacedCamera;
use super::vector::add;
use super::{Camera, Matrices};
use crate::Error;

/// The camera of a frame. [`Camera`] and [`Matrices`] convert into it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Viewpoint {
    /// A camera given by its place and target.
    Camera(Camera),
    /// A camera given by its matrices.
    Matrices(Matrices),
    /// A camera given by its matrices in a space that moves along with it, as renderers of large worlds have it. The view matrix then
    /// often has no translation at all.
    Relative {
        /// The camera in that space.
        matrices: Matrices,
        /// Origin of that space in the world, in this frame.
        origin: [f64; 3],
    },
}

impl From<Camera> for Viewpoint {
    fn from(camera: Camera) -> Self {
        Self::Camera(camera)
    }
}

impl From<Matrices> for Viewpoint {
    fn from(matrices: Matrices) -> Self {
        Self::Matrices(matrices)
    }
}

impl Viewpoint {
    pub(crate) fn placed(&self, size: [u32; 2]) -> Result<PlacedCamera, Error> {
        match self {
            Self::Camera(camera) => camera.placed(size),
            Self::Matrices(matrices) => matrices.placed(size),
            Self::Relative { origin, .. } if !origin.iter().all(|x| x.is_finite()) => {
                Err(Error::Camera { element: "origin", reason: "is not finite" })
            }
            Self::Relative { matrices, origin } => {
                let placed = matrices.placed(size)?;
                Ok(PlacedCamera { eye: add(placed.eye, *origin), ..placed })
            }
        }
    }

    /// Origin of the host's coordinates in the world.
    pub(crate) fn origin(&self) -> [f64; 3] {
        match self {
            Self::Camera(_) | Self::Matrices(_) => [0.0; 3],
            Self::Relative { origin, .. } => *origin,
        }
    }
}
