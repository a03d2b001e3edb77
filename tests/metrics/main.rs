//! Metrics against known answers: an image against itself, constant offsets, known noise, and results of other programs.
#![cfg(all(feature = "metrics", feature = "image"))]

#[cfg(feature = "flip")]
mod flip;
mod frames;
mod perception;
mod refusals;
mod sequences;

/// Asserts that two numbers differ by no more than `allowed`.
#[track_caller]
fn assert_near(found: f64, expected: f64, allowed: f64) {
    assert!((found - expected).abs() <= allowed, "{found}, not {expected} ± {allowed}");
}

/// A grey image.
fn grey(levels: &[f32]) -> Vec<[f32; 3]> {
    levels.iter().map(|&level| [level; 3]).collect()
}
