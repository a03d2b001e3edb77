//! Conclusions from the numbers: the best method for the time, and the speed-up.

use crate::report::fit::{Power, line};
use crate::report::methods::{CONTROL, DEFAULT, Group};
use crate::report::summary::Summary;

/// Ratio of times up to which they count as equal.
const EQUAL_TIME: f64 = 1.05;

/// A claim about a sequence, and its test against the numbers.
pub struct Claim {
    pub text: String,
    pub holds: bool,
}

/// Returns the method with a name.
pub fn find<'a>(summaries: &'a [Summary], name: &str) -> Option<&'a Summary> {
    summaries.iter().find(|summary| summary.method == name)
}

/// Returns the methods that no other beats in both time and error, the fastest first.
pub fn pareto(summaries: &[Summary]) -> Vec<&Summary> {
    let mut ranked: Vec<_> = summaries.iter().filter_map(|summary| Some((summary.point()?, summary))).collect();
    ranked.sort_by(|(a, _), (b, _)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut least = f64::INFINITY;
    ranked.retain(|&((_, error), _)| {
        let better = error < least;
        least = least.min(error);
        better
    });
    ranked.into_iter().map(|(_, summary)| summary).collect()
}

/// Returns the method of least error among those that take no longer than the default.
pub fn equal_time(summaries: &[Summary]) -> Option<&Summary> {
    let (limit, _) = find(summaries, DEFAULT)?.point()?;
    let affordable = summaries.iter().filter_map(|summary| Some((summary.point()?, summary)));
    let affordable = affordable.filter(|((ms, _), _)| *ms <= EQUAL_TIME * limit);
    Some(affordable.min_by(|(a, _), (b, _)| a.1.total_cmp(&b.1))?.1)
}

/// Cost of path tracing alone at the default's error.
pub struct SpeedUp {
    /// Paths per pixel.
    pub paths: f64,
    pub ms: f64,
    /// Ratio to the default's milliseconds.
    pub factor: f64,
    /// True if no measurement had so many paths.
    pub extrapolated: bool,
}

/// Fits a·pathsᵇ to path tracing's error, and c + d·paths to its milliseconds, both by least squares, and evaluates
/// both at the default's error.
pub fn equal_error(summaries: &[Summary]) -> Option<SpeedUp> {
    let (time, error) = find(summaries, DEFAULT)?.point()?;
    let traced = summaries.iter().filter_map(|summary| match summary.group {
        Group::Tracing(paths) => Some((f64::from(paths), summary.point()?)),
        _ => None,
    });
    let traced: Vec<_> = traced.collect();
    let errors: Vec<_> = traced.iter().map(|&(paths, (_, error))| (paths, error)).collect();
    let times: Vec<_> = traced.iter().map(|&(paths, (ms, _))| (paths, ms)).collect();
    let power = Power::through(&errors)?;
    let (each, fixed) = line(&times)?;
    if error <= 0.0 || power.exponent >= 0.0 {
        return None;
    }
    let paths = (error / power.factor).powf(1.0 / power.exponent);
    let ms = fixed + each * paths;
    let most = traced.iter().map(|&(paths, _)| paths).fold(0.0, f64::max);
    Some(SpeedUp { paths, ms, factor: ms / time, extrapolated: paths > most })
}

/// Tests the promises of the adaptive α against the numbers of a sequence.
pub fn claims(sequence: &str, summaries: &[Summary]) -> Vec<Claim> {
    let error = |name: &str| find(summaries, name).and_then(Summary::error);
    let ghost = |name: &str| find(summaries, name).and_then(|summary| summary.mean(|row| row.ghost));
    let flicker = |name: &str| find(summaries, name).and_then(|summary| summary.mean(|row| row.flicker));
    let mut claims = Vec::new();
    let mut claim = |text: String, holds: bool| claims.push(Claim { text, holds });
    let constant = summaries.iter().filter(|summary| summary.group == Group::Constant);
    let best = constant.filter_map(|s| Some((s.error()?, &s.method))).min_by(|a, b| a.0.total_cmp(&b.0));
    if let (Some(adaptive), Some((best, name))) = (error(DEFAULT), best) {
        let allowed = if sequence.ends_with("blink") { 0.5 } else { 1.05 };
        let part = adaptive / best;
        claim(
            format!("the error of {DEFAULT} is at most {allowed} × that of {name}, the best constant α: {part:.3} ×"),
            part <= allowed,
        );
    }
    if let (Some(slow), Some(fast)) = (ghost("svgf 0.05"), ghost("svgf 0.2")) {
        claim(
            format!(
                "α = 0.05 ghosts more than α = 0.2: relative error {slow:.4} and {fast:.4} where light or surfaces changed"
            ),
            slow > fast,
        );
    }
    if let (true, Some(slow), Some(fast)) = (sequence.ends_with("static"), flicker("svgf 0.05"), flicker("svgf 0.2")) {
        claim(
            format!("α = 0.2 is noisier than α = 0.05 where nothing changes: it flickers by {fast:.4}, not {slow:.4}"),
            fast > slow,
        );
    }
    if let (Some(worse), Some(adaptive)) = (error(CONTROL), error(DEFAULT)) {
        claim(
            format!("the method that is worse on purpose has {:.1} × the error of {DEFAULT}", worse / adaptive),
            worse > adaptive,
        );
    }
    claims
}
