//! Arguments that do not fit each other are refused by name.

use crate::grey;
use asvgf::metrics::{MetricError, Pair, ages, flicker, ghost_energy, lag, origins, ssim};

fn length(what: &'static str, found: usize, expected: usize) -> MetricError {
    MetricError::Length { what, found, expected }
}

#[test]
fn lengths_that_differ() {
    let (two, three) = (grey(&[0.0; 2]), grey(&[0.0; 3]));
    assert_eq!(Pair::new(&two, &three).unwrap_err(), length("reference", 3, 2));
    let pair = Pair::new(&two, &two).unwrap();
    assert_eq!(pair.counting(&[true]).unwrap_err(), length("mask", 1, 2));
    assert_eq!(flicker(&pair, &pair, &[None]).unwrap_err(), length("origins", 1, 2));
    assert_eq!(ages(&two, &two, &[None; 2], 0.1, Some(&[0])).unwrap_err(), length("ages", 1, 2));
    assert_eq!(ghost_energy(&pair, &[0], 8).unwrap_err(), length("ages", 1, 2));
    assert_eq!(lag(&three, &two, &[&two], 0.1, 0.1).unwrap_err(), length("old", 3, 2));
    assert_eq!(lag(&two, &two, &[&two, &three], 0.1, 0.1).unwrap_err(), length("frames", 3, 2));
}

#[test]
fn sizes_that_are_not_the_images() {
    let image = grey(&[0.0; 6]);
    let pair = Pair::new(&image, &image).unwrap();
    let wrong = MetricError::Size { width: 4, height: 2, found: 6 };
    assert_eq!(ssim(&pair, [4, 2]).unwrap_err(), wrong);
    assert_eq!(origins([4, 2], &[[0.0; 2]; 6], |_, _| true).unwrap_err(), wrong);
    assert_eq!(ssim(&pair, [3, 2]).unwrap_err(), MetricError::TooSmall { width: 3, height: 2, least: 11 });
}

#[test]
fn origins_that_do_not_exist() {
    let image = grey(&[0.0; 2]);
    let pair = Pair::new(&image, &image).unwrap();
    let wrong = MetricError::Origin { pixel: 1, origin: 2, count: 2 };
    assert_eq!(flicker(&pair, &pair, &[None, Some(2)]).unwrap_err(), wrong);
    assert_eq!(ages(&image, &image, &[Some(1), Some(2)], 0.1, None).unwrap_err(), wrong);
    assert_eq!(wrong.to_string(), "pixel 1 comes from pixel 2 of the last frame, which has 2");
}
