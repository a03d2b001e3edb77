//! Helpers that the GPU tests share.

pub mod gpu;
pub mod images;
pub mod plane;
pub mod scenes;
pub mod stage;
pub mod statistics;
pub mod walker;
