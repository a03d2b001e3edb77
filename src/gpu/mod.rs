//! The machinery that carries a plan out: composed shaders, textures, uniforms, timing, readback.

pub(crate) mod compose;
pub(crate) mod counts;
pub(crate) mod filled;
pub(crate) mod frame;
pub(crate) mod kernel;
pub(crate) mod pipelines;
pub(crate) mod readback;
pub(crate) mod resource;
pub(crate) mod textures;
pub(crate) mod timing;
