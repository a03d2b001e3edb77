//! report.md: the numbers, and the conclusions in words.

use crate::report::methods::{DEFAULT, Group};
use crate::report::summary::{Spread, Summary};
use crate::report::verdict;
use std::fmt::Write as _;

/// Facts about a report as a whole.
pub struct Context {
    /// Command, machine and the like, one line each.
    pub facts: Vec<String>,
    /// Parts that did not fit into the budget.
    pub dropped: Vec<String>,
}

/// A sequence, its methods, and its plots and pictures.
pub struct Chapter {
    pub sequence: String,
    pub summaries: Vec<Summary>,
    pub plots: Vec<String>,
    pub picture: Option<String>,
}

/// Writes the whole report.
pub fn report(context: &Context, chapters: &[Chapter]) -> String {
    let mut out = String::from("# Error against run time\n\n");
    for fact in &context.facts {
        let _ = writeln!(out, "- {fact}");
    }
    if !context.dropped.is_empty() {
        let _ = writeln!(
            out,
            "\nLeft out to keep within the budget (with no repeat, times are of frames that warmed up):\n"
        );
        for what in &context.dropped {
            let _ = writeln!(out, "- {what}");
        }
    }
    out += "\nrelMSE is mean (a − b)² / (b² + 0.01), bias is mean (a − b) / mean b, flicker is the change of the error from frame to \
            frame along the motion where nothing changed, and ghost is the relMSE where light or surfaces changed in the last eight \
            frames: means over the frames, over pixels that are neither emitters nor misses. The references' own noise, \
            measured from the two halves of each, is subtracted from relMSE. PSNR, SSIM and FLIP compare images as \
            displays show them. Times are medians, with the quartiles.\n";
    out += &across(chapters);
    for chapter in chapters {
        let _ = write!(out, "\n## {}\n\n", chapter.sequence);
        out += &table(&chapter.summaries);
        out += &passes(&chapter.summaries);
        out += &lags(&chapter.summaries);
        out += &verdicts(chapter);
        for plot in &chapter.plots {
            let _ = write!(out, "\n![{plot}]({plot}.svg)\n");
        }
        if let Some(picture) = &chapter.picture {
            let _ = write!(out, "\n![comparison]({picture})\n");
        }
    }
    out
}

/// Tabulates relMSE of each method in each sequence.
fn across(chapters: &[Chapter]) -> String {
    let mut out = String::from("\n## All sequences: relMSE\n\n| method |");
    let error = |chapter: &Chapter, name: &str| verdict::find(&chapter.summaries, name).and_then(Summary::error);
    for chapter in chapters {
        let _ = write!(out, " {} |", chapter.sequence);
    }
    let _ = writeln!(out, " in parts of {DEFAULT} (geometric mean) |\n|---|{}", "--:|".repeat(chapters.len() + 1));
    let mut names: Vec<&str> = Vec::new();
    for summary in chapters.iter().flat_map(|chapter| &chapter.summaries) {
        if !names.contains(&summary.method.as_str()) {
            names.push(&summary.method);
        }
    }
    for name in names {
        let _ = write!(out, "| {name} |");
        for chapter in chapters {
            let _ = write!(out, " {} |", number(error(chapter, name), 5));
        }
        // The mean covers all sequences or none, because they are not equally hard.
        let logarithms = chapters.iter().map(|c| Some((error(c, name)? / error(c, DEFAULT)?).ln()));
        let sum: Option<f64> = logarithms.sum();
        let _ = writeln!(out, " {} |", number(sum.map(|sum| (sum / chapters.len() as f64).exp()), 3));
    }
    out
}

fn table(summaries: &[Summary]) -> String {
    let mut out = String::from(
        "| method | ms | relMSE | bias % | flicker | ghost | PSNR dB | SSIM | FLIP |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    for summary in summaries {
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            summary.method,
            time(summary.ms),
            number(summary.error(), 5),
            number(summary.mean(|row| row.bias).map(|bias| 100.0 * bias), 2),
            number(summary.mean(|row| row.flicker), 4),
            number(summary.mean(|row| row.ghost), 4),
            number(summary.mean(|row| row.psnr), 2),
            number(summary.mean(|row| row.ssim), 4),
            number(summary.mean(|row| row.flip), 4),
        );
    }
    out
}

/// Tabulates milliseconds of each pass.
fn passes(summaries: &[Summary]) -> String {
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in summaries.iter().filter(|s| s.group != Group::Baseline).flat_map(|s| &s.passes) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    if names.is_empty() {
        return String::new();
    }
    let mut out = format!("\n| ms of | {} |\n|---|{}\n", names.join(" | "), "--:|".repeat(names.len()));
    for summary in summaries.iter().filter(|summary| summary.group != Group::Baseline) {
        let of = |name: &&str| summary.passes.iter().find(|(other, _)| other == name).map(|(_, ms)| *ms);
        let cells: Vec<String> = names.iter().map(|name| number(of(name), 3)).collect();
        let _ = writeln!(out, "| {} | {} |", summary.method, cells.join(" | "));
    }
    out
}

/// Tabulates the frames until the light's step arrived, if there was one.
fn lags(summaries: &[Summary]) -> String {
    if summaries.iter().all(|summary| summary.lag.is_empty()) {
        return String::new();
    }
    let mut out = String::from(
        "\nFrames after the step until a pixel stays within a band around its new level, in parts of the step; “–” if too few pixels did.\n\n",
    );
    out += "| method | band | half of the pixels | nine of ten | arrived at all |\n|---|--:|--:|--:|--:|\n";
    for summary in summaries {
        for lag in &summary.lag {
            let frames = |frames: Option<u32>| frames.map_or("–".into(), |frames| frames.to_string());
            let (half, nine) = (frames(lag.median), frames(lag.ninth_decile));
            let _ = writeln!(
                out,
                "| {} | {} % | {half} | {nine} | {:.1} % |",
                summary.method,
                100.0 * lag.band,
                100.0 * lag.arrived
            );
        }
    }
    out
}

/// Words the conclusions from the numbers of a sequence.
fn verdicts(chapter: &Chapter) -> String {
    let summaries = &chapter.summaries;
    let mut out = String::from("\n");
    if let (Some(best), Some(default)) = (verdict::equal_time(summaries), verdict::find(summaries, DEFAULT)) {
        let least = best.error().zip(default.error());
        let by = least.map_or(0.0, |(least, error)| 100.0 * (1.0 - least / error));
        let _ = match best.method.as_str() {
            DEFAULT => {
                writeln!(out, "- Equal time: no method that takes as long as {DEFAULT} or less has a smaller error.")
            }
            name => writeln!(
                out,
                "- Equal time: {name} has the least error of those that take as long as {DEFAULT} or less, by {by:.1} %."
            ),
        };
    }
    if let Some(speed_up) = verdict::equal_error(summaries) {
        let how = if speed_up.extrapolated { "extrapolated" } else { "interpolated" };
        let _ = writeln!(
            out,
            "- Equal error: path tracing alone would need {:.0} paths per pixel ({how}) and {:.1} ms a frame for the error of {DEFAULT}: \
             {:.1} times as long.",
            speed_up.paths, speed_up.ms, speed_up.factor,
        );
    }
    let front: Vec<&str> = verdict::pareto(summaries).into_iter().map(|summary| summary.method.as_str()).collect();
    if !front.is_empty() {
        let _ = writeln!(out, "- Pareto front (no method beats these in both time and error): {}.", front.join(", "));
    }
    out += &ablation(summaries);
    for claim in verdict::claims(&chapter.sequence, summaries) {
        let _ = writeln!(out, "- {}: {}.", if claim.holds { "Holds" } else { "**Does not hold**" }, claim.text);
    }
    out
}

/// Words the gain from each idea of the default: the growth of the error without it.
fn ablation(summaries: &[Summary]) -> String {
    let Some(default) = verdict::find(summaries, DEFAULT).and_then(Summary::error) else { return String::new() };
    let undone = summaries.iter().filter(|summary| summary.group == Group::Ablation);
    let parts = undone.filter_map(|s| Some(format!("{} {:+.1} %", s.method, 100.0 * (s.error()? / default - 1.0))));
    let parts: Vec<String> = parts.collect();
    if parts.is_empty() { String::new() } else { format!("- Error against {DEFAULT}: {}.\n", parts.join(", ")) }
}

fn time(ms: Option<Spread>) -> String {
    ms.map_or("–".into(), |ms| format!("{:.2} ({:.2}…{:.2})", ms.median, ms.low, ms.high))
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or("–".into(), |value| format!("{value:.digits$}"))
}
