//! The scene as plain data. An importer produces it, a host may fill it in by hand, and
//! [`GpuScene`](crate::scene::GpuScene) uploads it.
//!
//! The conventions are those of glTF 2.0: right-handed, +Y up, metres, counter-clockwise front faces, matrices as four
//! columns, quaternions as `[x, y, z, w]`, linear Rec. 709 colour unless a field says otherwise.

mod animation;
pub mod builtin;
mod camera;
mod deformation;
mod light;
mod material;
mod measure;
mod mesh;
mod node;
mod pose;
mod problem;
mod scene;
mod skinning;
mod srgb;
mod texture;
mod validate;
mod view;

pub use animation::{Animation, Channel, Interpolation, Target};
pub use camera::Perspective;
pub use deformation::{Influence, MorphTarget, Skin};
pub use light::{Environment, Light, LightKind};
pub use material::{Alpha, Clearcoat, Interior, Material};
pub use mesh::Mesh;
pub use node::{IDENTITY, Matrix, Node, Transform, WorldMatrix};
pub use pose::Pose;
pub use problem::{SceneError, Warning};
pub use scene::Scene;
pub use skinning::Shape;
pub(crate) use skinning::{shape, turned_tangent};
pub(crate) use srgb::linear_from_srgb;
pub use texture::{Image, Texture, Wrap};
