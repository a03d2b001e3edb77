//! Triangles on the GPU: the meshes as they are drawn, groups that share a tree, their rows and attributes, the instances
//! that place them, and meshes that change their shape.

pub(crate) mod attributes;
pub(crate) mod centre;
pub(crate) mod deforming;
pub(crate) mod drawn;
pub(crate) mod facets;
pub(crate) mod groups;
pub(crate) mod instances;
pub(crate) mod rows;
pub(crate) mod sections;
mod tangents;
