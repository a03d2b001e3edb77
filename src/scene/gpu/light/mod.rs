//! Everything that emits, and the tables by which a path chooses one light.

mod alias;
pub(crate) mod analytic;
mod emitter;
mod pieces;
mod punctual;
pub(crate) mod radiance;
pub(crate) mod record;
pub(crate) mod sky;
pub(crate) mod table;
