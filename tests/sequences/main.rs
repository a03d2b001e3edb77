//! The offline tools of the examples: sequences of EXR files, their denoising and their scores.
#![cfg(all(feature = "path-tracer", feature = "image", feature = "metrics"))]
#![allow(dead_code, reason = "the examples' modules, of which each example uses its part")]

#[path = "../../examples/support/arguments.rs"]
mod arguments;
#[path = "../../examples/support/camera.rs"]
mod camera;
#[path = "../../examples/support/camera_fit.rs"]
mod camera_fit;
#[path = "../../examples/support/denoise_options.rs"]
mod denoise_options;
#[path = "../../examples/support/export.rs"]
mod export;
#[path = "../../examples/support/film.rs"]
mod film;
#[path = "../../examples/support/gpu.rs"]
mod gpu;
#[path = "../../examples/support/layers.rs"]
mod layers;
#[path = "../../examples/support/replay.rs"]
mod replay;
#[path = "../../examples/support/scoring.rs"]
mod scoring;
#[path = "../../examples/support/sequence.rs"]
mod sequence;
#[path = "../../examples/support/times.rs"]
mod times;
#[path = "../../examples/support/tracing.rs"]
mod tracing;

mod cameras;
mod command_line;
mod filtering;
mod folder;
mod names;
mod refusals;
