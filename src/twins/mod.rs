//! Tests of the shaders that need the crate's inside: each pass alone against its f64 twin on the CPU, the layout of what
//! is uploaded, every permutation, and the traversal.

#[path = "../../tests/common/gpu.rs"]
mod gpu;
pub(crate) mod layout;
mod permutations;
mod random;
mod traversal;
