//! Sequences of EXR files: how they are read, denoised by `denoise` and scored by `score`.

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
