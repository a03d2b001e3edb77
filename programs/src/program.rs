//! Output and exit status of the programs, and the place of the repository.

use crate::arguments::Usage;
use std::error::Error;
use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;

/// Returns the exit status of a program: 0 if it is done, 1 if it failed, 2 after wrong usage. Prints the error.
pub fn exit(result: Result<(), Box<dyn Error>>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if error.is::<Usage>() => {
            eprintln!("error: {error}\n(--help lists all options)");
            ExitCode::from(2)
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Prints to standard output. A reader such as `head`, which closes the pipe after enough lines, causes no error.
pub fn say(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}

/// Returns the repository: the folder of the build or, on another machine, the current folder.
pub fn repository() -> &'static Path {
    let built = Path::new(env!("CARGO_MANIFEST_DIR")).parent().filter(|path| path.is_dir());
    built.unwrap_or(Path::new("."))
}
