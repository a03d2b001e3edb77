//! The command-line programs of the repository, and the parts that they share.
//!
//! | program | what it does | its modules |
//! |---|---|---|
//! | `render` | renders a scene, denoises it and writes pictures | [`render`], [`stage`] |
//! | `denoise` | denoises a sequence of EXR files | [`denoise`], [`sequence`] |
//! | `score` | scores a denoised sequence against its references | [`score`] |
//! | `report` | measures error against run time | [`report`] |
//! | `stability` | measures how far the filter is from its bounds | [`stability`] |
//!
//! Each has a thin `main` in `examples/`, because the command of all of them is `cargo run --release --example NAME`. [`arguments`] and
//! [`program`] are about the command line; [`gpu`], [`film`], [`tracing`], [`times`] and [`tone`] are about frames.

pub mod arguments;
pub mod denoise;
pub mod film;
pub mod gpu;
pub mod program;
pub mod render;
pub mod report;
pub mod score;
pub mod sequence;
pub mod stability;
pub mod stage;
pub mod times;
pub mod tone;
pub mod tracing;
