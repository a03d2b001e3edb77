//! Renders a scene, denoises it, and writes pictures: `cargo run --release --example render -- --help`.

use asvgf_programs::{program, render};
use std::process::ExitCode;

fn main() -> ExitCode {
    program::exit(render::run(std::env::args_os().skip(1)))
}
