//! Buffers and textures, and the capacity of a device.

pub(crate) mod buffers;
pub(crate) mod capacity;
pub(crate) mod folded;
pub(crate) mod pieces;
