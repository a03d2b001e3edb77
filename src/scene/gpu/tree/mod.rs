//! Trees over triangles and over instances: obvhs builds them ([`build`]), [`layout`] lays them out for the shaders, and [`refit`] fits
//! them to triangles that move.

mod build;
mod halve;
mod layout;
mod node;
mod quantization;
mod refit;

pub(crate) use build::{DEEPEST, over_instances, over_triangles};
pub(crate) use layout::Tree;
pub(crate) use node::{LARGEST_FIRST, Node};
pub(crate) use quantization::Quantization;
pub(crate) use refit::Fitted;
