//! Materials, and the images that they use.

pub(crate) mod images;
pub(crate) mod materials;
pub(crate) mod places;
mod texture_use;
