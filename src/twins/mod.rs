//! Tests of the shaders that need access to the crate's private parts: each pass alone against its f64 twin on the CPU, the layout
//! of uploaded structs, every permutation, and the traversal.
//!
//! Twins follow the documented equations in f64 and share no code with the shaders. Their inputs are the numbers that the
//! textures hold, so that only the arithmetic between loading and storing differs.

mod bench;
mod browser;
mod codec;
mod compute;
#[allow(dead_code, reason = "shared with the integration tests, which use the rest")]
#[path = "../../tests/gpu/common/gpu.rs"]
pub(crate) mod gpu;
pub(crate) mod layout;
mod omissions;
mod permutations;
#[allow(dead_code, reason = "shared with the integration tests, which use the rest")]
#[path = "../../tests/gpu/common/plane.rs"]
mod plane;
mod random;
mod traversal;

mod agreement;
mod atrous;
mod clamp;
mod gradient;
mod gradient_means;
mod gradient_sample;
mod guards;
mod history;
mod ingest_pairs;
mod ingest_radiance;
mod ingest_surface;
mod last_frame;
mod mirrors;
mod outliers;
mod packing;
mod properties;
mod reflection;
mod reshade;
mod resolve;
mod sky;
mod steady;
mod strata;
mod temporal;
mod variance;
