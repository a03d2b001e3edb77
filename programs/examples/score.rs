//! Scores a denoised sequence against its references: `cargo run --release --example score -- --help`.

use asvgf_programs::{program, score};
use std::process::ExitCode;

fn main() -> ExitCode {
    program::exit(score::run(std::env::args_os().skip(1)))
}
