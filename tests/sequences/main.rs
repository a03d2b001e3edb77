//! The offline tools of the examples: sequences of EXR files, their denoising and their scores.
#![cfg(all(feature = "path-tracer", feature = "image", feature = "metrics"))]
#![allow(dead_code, reason = "the examples' modules, of which each example uses its part")]

#[path = "../../examples/support/antialias.rs"]
mod antialias;
#[path = "../../examples/support/arguments.rs"]
mod arguments;
#[path = "../../examples/support/blend_in_time.rs"]
mod blend_in_time;
#[path = "../../examples/support/camera.rs"]
mod camera;
#[path = "../../examples/support/clean_albedo.rs"]
mod clean_albedo;
#[path = "../../examples/support/denoise_options.rs"]
mod denoise_options;
#[path = "../../examples/support/export.rs"]
mod export;
#[path = "../../examples/support/film.rs"]
mod film;
#[path = "../../examples/support/fixed_seed.rs"]
mod fixed_seed;
#[path = "../../examples/support/gpu.rs"]
mod gpu;
#[path = "../../examples/support/grid.rs"]
mod grid;
#[path = "../../examples/support/inverted_motion.rs"]
mod inverted_motion;
#[path = "../../examples/support/look_ahead.rs"]
mod look_ahead;
#[path = "../../examples/support/output.rs"]
mod output;
#[path = "../../examples/support/parallel.rs"]
mod parallel;
#[path = "../../examples/support/replay.rs"]
mod replay;
#[path = "../../examples/support/scoring.rs"]
mod scoring;
#[path = "../../examples/support/sequence/mod.rs"]
mod sequence;
#[path = "../../examples/support/summary.rs"]
mod summary;
#[path = "../../examples/support/times.rs"]
mod times;
#[path = "../../examples/support/tone.rs"]
mod tone;
#[path = "../../examples/support/tracing.rs"]
mod tracing;
#[path = "../../examples/support/upload.rs"]
mod upload;

use sequence::layers;

mod cameras;
mod command_line;
mod filtering;
mod folder;
mod forms;
mod names;
mod refusals;
mod time;
