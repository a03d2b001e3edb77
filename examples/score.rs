//! Scores a denoised sequence against its references: `cargo run --release --example score -- OUT_DIR IN [REFERENCES]`.

#[allow(dead_code, reason = "shared with `denoise`")]
#[path = "support/camera.rs"]
mod camera;
#[path = "support/scoring.rs"]
mod scoring;
#[allow(dead_code, reason = "shared with `denoise`")]
#[path = "support/sequence/mod.rs"]
mod sequence;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const HELP: &str = "\
Scores a denoised sequence against its references.

Usage: cargo run --release --example score -- OUT_DIR IN [REFERENCES]

OUT_DIR holds denoised_0000.exr, …, as `denoise` or another denoiser wrote them; IN the
frames, as `denoise` takes them; REFERENCES, or else the folder of the frames, the converged
image of each, reference_0000.exr, …. Results and references may also be called as the frames are.

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
        [out, input] => score(out, input, &folder(input)),
        [out, input, references] => score(out, input, references),
        _ => {
            eprintln!("error: two folders are needed, OUT_DIR and IN\n(--help says more)");
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

fn score(out: &Path, input: &Path, references: &Path) -> Result<(), Box<dyn std::error::Error>> {
    scoring::score(out, input, references).map(|scores| say(&format!("{scores}\n")))
}

/// Where frames are that may be named by one of them.
fn folder(input: &Path) -> PathBuf {
    if input.is_dir() { input.to_owned() } else { input.parent().unwrap_or(Path::new("")).to_owned() }
}

/// Prints; whoever reads may have seen enough, as `head` does.
fn say(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}
