//! Files of other programs, in the folder `shared` next to the repository if it is at hand. The repository does not hold them.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, Once};

/// Number of tests that were skipped, in whole or in part, because a folder is missing; for each folder.
static SKIPPED: Mutex<BTreeMap<String, u32>> = Mutex::new(BTreeMap::new());

/// A folder of `shared`. If it is not there, the last line of the output counts this test as skipped.
pub fn shared(name: &str) -> Option<PathBuf> {
    // The package is the repository itself, or a folder of it.
    let around = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().skip(1).take(2);
    let found = around.map(|parent| parent.join("shared").join(name)).find(|folder| folder.is_dir());
    if found.is_none() {
        skip(name);
    }
    found
}

fn skip(name: &str) {
    static ONCE: Once = Once::new();
    // The test harness swallows the prints of tests that pass. It ends before `atexit` and has printed its summary by then.
    ONCE.call_once(|| _ = atexit(say_what_was_skipped));
    if let Ok(mut skipped) = SKIPPED.lock() {
        *skipped.entry(name.to_owned()).or_default() += 1;
    }
}

extern "C" fn say_what_was_skipped() {
    let Ok(skipped) = SKIPPED.lock() else { return };
    for (name, tests) in skipped.iter() {
        let tests = if *tests == 1 { "1 test".into() } else { format!("{tests} tests") };
        _ = writeln!(std::io::stdout(), "skipped in whole or in part: {tests}, because ../shared/{name} is not there");
    }
}

unsafe extern "C" {
    /// Calls a function when the process ends (C11 7.22.4.2).
    safe fn atexit(function: extern "C" fn()) -> i32;
}
