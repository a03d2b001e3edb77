//! Measures how far the filter is from its bounds: `cargo run --release --example stability -- --help`.

use asvgf_programs::{program, stability};
use std::process::ExitCode;

fn main() -> ExitCode {
    program::exit(stability::run(std::env::args_os().skip(1)))
}
