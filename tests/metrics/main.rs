//! Metrics against known answers: an image and itself, constant offsets, known noise, and what other programs say.
#![cfg(all(feature = "metrics", feature = "image"))]

#[cfg(feature = "flip")]
mod flip;
mod frames;
mod perception;
mod refusals;
mod sequences;

/// Asserts that two numbers differ by no more than is allowed.
#[track_caller]
fn assert_near(found: f64, expected: f64, allowed: f64) {
    assert!((found - expected).abs() <= allowed, "{found}, not {expected} ± {allowed}");
}

/// A grey image.
fn grey(levels: &[f32]) -> Vec<[f32; 3]> {
    levels.iter().map(|&level| [level; 3]).collect()
}
