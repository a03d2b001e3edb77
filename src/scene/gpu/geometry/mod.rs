//! Triangles on the GPU: groups that share a tree, their rows and attributes, and the instances that place them.

pub(crate) mod attributes;
pub(crate) mod centre;
pub(crate) mod facets;
pub(crate) mod groups;
pub(crate) mod instances;
pub(crate) mod rows;
pub(crate) mod sections;
mod tangents;
