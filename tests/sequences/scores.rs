//! The three scores on images whose scores follow by hand.

use crate::metrics::{Pair, bias, flicker, mean, rel_mse};

const ALL: [bool; 2] = [true; 2];

fn pair<'a>(image: &'a [[f32; 3]], reference: &'a [[f32; 3]], counted: &'a [bool]) -> Pair<'a> {
    Pair { image, reference, counted }
}

#[track_caller]
fn assert_near(value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-6, "{value} is not {expected}");
}

#[test]
fn errors_and_bias_count_only_what_counts() {
    let image = [[1.5; 3], [9.0; 3]];
    let reference = [[1.0; 3], [2.0; 3]];
    let some = pair(&image, &reference, &[true, false]);
    assert_near(rel_mse(&some), 0.25 / 1.01);
    assert_near(bias(&some), 0.5);
    let all = pair(&image, &reference, &ALL);
    assert_near(rel_mse(&all), 0.5 * (0.25 / 1.01 + 49.0 / 4.01));
    assert_near(bias(&all), 3.75 / 1.5);
    assert_near(rel_mse(&pair(&reference, &reference, &ALL)), 0.0);
}

#[test]
fn flicker_is_change_beyond_that_of_the_truth() {
    let (before, before_true) = ([[1.0; 3], [1.5; 3]], [[1.0; 3], [1.0; 3]]);
    let (now, now_true) = ([[2.0; 3], [2.0; 3]], [[2.0; 3], [2.0; 3]]);
    let (now, before) = (pair(&now, &now_true, &ALL), pair(&before, &before_true, &ALL));
    // Pixel 0 comes from pixel 0: image and truth both grow by 1. Pixel 1 comes from 1: ½ instead of 1.
    assert_near(flicker(&now, &before, &[Some(0), None]), 0.0);
    assert_near(flicker(&now, &before, &[Some(0), Some(1)]), 0.25 / 2.0);
    // Both from 1.
    assert_near(flicker(&now, &before, &[Some(1), Some(1)]), 0.5 / 2.0);
    assert_near(flicker(&now, &before, &[None, None]), 0.0);
}

#[test]
fn the_mean_of_nothing_is_zero() {
    assert_near(mean(std::iter::empty()), 0.0);
    assert_near(mean([1.0, 2.0].into_iter()), 1.5);
}
