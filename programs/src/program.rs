//! How programs speak and end, and where they find the repository.

use crate::arguments::Usage;
use std::error::Error;
use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;

/// The exit status of a program: 0 if it is done, 1 if it failed, 2 if it was used wrongly. Prints the error.
pub fn exit(result: Result<(), Box<dyn Error>>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if error.is::<Usage>() => {
            eprintln!("error: {error}\n(--help says what can be asked)");
            ExitCode::from(2)
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Prints to standard output. A reader that has seen enough and closes it, such as `head`, is no error.
pub fn say(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}

/// The repository: where the program was built or, if it was carried to another machine, the current folder.
pub fn repository() -> &'static Path {
    let built = Path::new(env!("CARGO_MANIFEST_DIR")).parent().filter(|path| path.is_dir());
    built.unwrap_or(Path::new("."))
}
