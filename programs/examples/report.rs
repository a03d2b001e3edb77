//! Measures error against run time: `cargo run --release --example report -- --help`.

use asvgf_programs::{program, report};
use std::process::ExitCode;

fn main() -> ExitCode {
    program::exit(report::run(std::env::args_os().skip(1)))
}
