//! Denoises a sequence of EXR files: `cargo run --release --example denoise -- --help`.

use asvgf_programs::{denoise, program};
use std::process::ExitCode;

fn main() -> ExitCode {
    program::exit(denoise::run(std::env::args_os().skip(1)))
}
