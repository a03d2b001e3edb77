//! Sequences of EXR files: reading, denoising by `denoise`, and scoring by `score`.

mod cameras;
mod command_line;
mod filtering;
mod folder;
mod forms;
mod names;
mod refusals;
#[path = "../../../tests/common/shared.rs"]
mod shared;
mod time;
