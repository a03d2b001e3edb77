//! Scores a denoised sequence against its references: `cargo run --release --example score -- OUT_DIR IN_DIR`.

#[allow(dead_code, reason = "shared with `denoise`")]
#[path = "support/camera.rs"]
mod camera;
#[path = "support/camera_fit.rs"]
mod camera_fit;
#[path = "support/layers.rs"]
mod layers;
#[path = "support/scoring.rs"]
mod scoring;
#[path = "support/sequence.rs"]
mod sequence;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const HELP: &str = "\
Scores a denoised sequence against its references.

Usage: cargo run --release --example score -- OUT_DIR IN_DIR

OUT_DIR holds denoised_0000.exr, …, as `denoise` or another denoiser wrote them; IN_DIR the
frames, and beside each its converged image, reference_0000.exr, …

Over the pixels that are neither emitters nor misses, and then over the frames:
  relMSE    mean (a − b)² / (b² + 0.01)
  bias      mean (a − b) / mean b
  flicker   mean |(a − a′) − (b − b′)| / mean b, ′ for the last frame, along the motion
";

fn main() -> ExitCode {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let result = match arguments.as_slice() {
        [only] if [Path::new("-h"), Path::new("--help")].contains(&only.as_path()) => {
            say(HELP);
            Ok(())
        }
        [out, input] => scoring::score(out, input).map(|scores| say(&format!("{scores}\n"))),
        _ => {
            eprintln!("error: two folders are needed, OUT_DIR and IN_DIR\n(--help says more)");
            return ExitCode::from(2);
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Prints; whoever reads may have seen enough, as `head` does.
fn say(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}
