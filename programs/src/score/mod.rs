//! The program `score`: scores a denoised sequence against its references.

pub mod scoring;

use crate::arguments::Usage;
use crate::program::say;
use std::error::Error;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

const HELP: &str = "\
Scores a denoised sequence against its references.

Usage: cargo run --release --example score -- OUT_DIR IN [REFERENCES]

OUT_DIR holds denoised_0000.exr, …, as `denoise` or another denoiser wrote them; IN the
frames, as `denoise` takes them; REFERENCES, or else the folder of the frames, the converged
image of each, reference_0000.exr, …. Results and references may also have their frames' names.

Over the pixels that are neither emitters nor misses, and then over the frames:
  relMSE    mean (a − b)² / (b² + 0.01)
  bias      mean (a − b) / mean b
  flicker   mean |(a − a′) − (b − b′)| / mean b, ′ for the last frame, along the motion
";

/// Runs the program with the arguments after its name.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> Result<(), Box<dyn Error>> {
    let arguments: Vec<PathBuf> = arguments.into_iter().map(PathBuf::from).collect();
    let scores = match arguments.as_slice() {
        [only] if [Path::new("-h"), Path::new("--help")].contains(&only.as_path()) => {
            say(HELP);
            return Ok(());
        }
        [out, input] => scoring::score(out, input, &folder(input))?,
        [out, input, references] => scoring::score(out, input, references)?,
        _ => return Err(Usage("two folders are needed, OUT_DIR and IN".into()).into()),
    };
    say(&format!("{scores}\n"));
    Ok(())
}

/// Returns the folder of frames, given the folder or one of them.
fn folder(input: &Path) -> PathBuf {
    if input.is_dir() { input.to_owned() } else { input.parent().unwrap_or(Path::new("")).to_owned() }
}
