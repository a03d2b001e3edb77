//! Measures error against run time: `cargo run --release --example report -- --help`.

mod baseline;
mod budget;
mod canvas;
mod command;
mod crops;
mod fit;
mod growth;
mod hash;
mod keep;
mod measure;
mod methods;
mod pace;
mod plots;
mod record;
mod score;
mod script;
mod suite;
mod summary;
mod tables;
mod tessellation;
mod truth;
mod verdict;
mod words;
mod words_growth;
mod work;

#[allow(dead_code, reason = "shared with the other examples")]
#[path = "../support/arguments.rs"]
mod arguments;
#[allow(dead_code, reason = "shared with `denoise`, which reads sequences")]
#[path = "../support/camera.rs"]
mod camera;
#[path = "../support/export.rs"]
mod export;
#[allow(dead_code, reason = "shared with the other examples")]
#[path = "../support/film.rs"]
mod film;
#[path = "../support/framing.rs"]
mod framing;
#[path = "../support/gpu.rs"]
mod gpu;
#[allow(dead_code, reason = "shared with `denoise`, which reads sequences")]
#[path = "../support/sequence/layers.rs"]
mod layers;
#[allow(dead_code, reason = "of `render`'s options only what says which scene is shown")]
#[path = "../support/options.rs"]
mod options;
#[path = "../support/sky.rs"]
mod sky;
#[path = "../support/stage.rs"]
mod stage;
#[allow(dead_code, reason = "shared with the other examples")]
#[path = "../support/times.rs"]
mod times;
#[path = "../support/tone.rs"]
mod tone;
#[path = "../support/tracing.rs"]
mod tracing;

use arguments::Usage;
use command::{Command, Request};
use gpu::Gpu;
use std::error::Error;
use std::fs;
use std::io::Write as _;
use std::process::ExitCode;
use std::time::Instant;
use words::Context;
use work::Work;

fn main() -> ExitCode {
    let result = match command::parse(std::env::args_os().skip(1)) {
        Ok(Request::Help) => {
            say(command::HELP);
            Ok(())
        }
        Ok(Request::Report(command)) => report(command),
        Err(usage) => Err(usage.into()),
    };
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

fn report(mut command: Command) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    fs::create_dir_all(command.out.join("runs")).map_err(|e| format!("--out {}: {e}", command.out.display()))?;
    let gpu = Gpu::new()?;
    let dropped = budget::fit(&mut command, &gpu)?.into_iter().collect();
    let (command, suite) = (&command, &command.suite);
    let mut work = Work::new(command, &gpu, start, dropped);
    let chapters = suite.sequences.iter().filter_map(|sequence| work.chapter(sequence).transpose());
    let chapters = chapters.collect::<Result<Vec<_>, _>>()?;
    let growth = command.growth.then(|| work.growth()).transpose()?;
    let dropped = work.finish();
    let rows: Vec<_> = chapters.iter().flat_map(|chapter| &chapter.summaries).flat_map(|s| s.rows.clone()).collect();
    write(command, "report.csv", &tables::csv(&rows))?;
    write(command, "report.json", &tables::json(&rows)?)?;
    let context = Context { facts: tables::facts(command, &gpu), dropped };
    let text = words::report(&context, &chapters) + &growth.unwrap_or_default();
    write(command, "report.md", &text)?;
    say(&format!("{}\n", command.out.join("report.md").display()));
    Ok(())
}

fn write(command: &Command, name: &str, text: &str) -> Result<(), String> {
    let path = command.out.join(name);
    fs::write(&path, text).map_err(|e| format!("{}: cannot be written: {e}", path.display()))
}

/// Prints; whoever reads may have seen enough, as `head` does.
fn say(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}
