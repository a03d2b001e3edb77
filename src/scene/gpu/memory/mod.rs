//! Buffers and textures, and what a device can hold.

pub(crate) mod buffers;
pub(crate) mod capacity;
pub(crate) mod folded;
pub(crate) mod pieces;
