//! Metrics that follow surfaces from frame to frame.

use crate::{assert_near, grey};
use asvgf::metrics::{Lag, Pair, ages, flicker, ghost_energy, lag, origins};

#[test]
fn motion_leads_to_where_a_surface_was() {
    // Motion one step from the left, from outside, from nowhere, and at rest.
    let motion = [[0.0, 0.0], [-1.0, 0.0], [5.0, 0.0], [f32::NAN, 0.0], [0.0, -1.0], [0.0, 0.0]];
    let found = origins([3, 2], &motion, |pixel, _| pixel != 5).unwrap();
    assert_eq!(found, [Some(0), Some(0), None, None, Some(1), None]);
}

#[test]
fn an_error_that_moves_along_does_not_flicker() {
    let reference = grey(&[1.0, 1.0, 2.0, 1.0]);
    let shifted = grey(&[1.0, 1.0, 1.0, 2.0]);
    let before: Vec<_> = reference.iter().map(|color| color.map(|x| x + 0.5)).collect();
    let now: Vec<_> = shifted.iter().map(|color| color.map(|x| x + 0.5)).collect();
    let origins = [None, Some(0), Some(1), Some(2)];
    let (now, before) = (Pair::new(&now, &shifted).unwrap(), Pair::new(&before, &reference).unwrap());
    assert_eq!(flicker(&now, &before, &origins).unwrap(), 0.0);
}

#[test]
fn flicker_is_relative_to_the_level() {
    let reference = grey(&[2.0; 4]);
    let image = grey(&[2.5, 1.5, 2.0, 9.0]);
    let mask = [true, true, true, false];
    let now = Pair::new(&image, &reference).unwrap().counting(&mask).unwrap();
    let before = Pair::new(&reference, &reference).unwrap();
    let still: Vec<_> = (0..4).map(Some).collect();
    assert_near(flicker(&now, &before, &still).unwrap(), (0.5 + 0.5) / 3.0 / 2.0, 1e-12);
    assert!(flicker(&now, &before, &[None; 4]).unwrap().is_nan());
}

#[test]
fn ages_count_from_the_last_change() {
    let still: Vec<_> = (0..3).map(Some).collect();
    let (dark, light) = (grey(&[1.0, 1.0, 1.0]), grey(&[1.0, 1.05, 2.0]));
    let first = ages(&light, &dark, &still, 0.1, None).unwrap();
    assert_eq!(first, [u32::MAX, u32::MAX, 0]);
    let second = ages(&light, &light, &[None, Some(1), Some(2)], 0.1, Some(&first)).unwrap();
    assert_eq!(second, [0, u32::MAX, 1]);
}

#[test]
fn a_ghost_is_looked_for_where_something_changed() {
    let (image, reference) = (grey(&[1.5, 8.0, 1.0]), grey(&[1.0; 3]));
    let pair = Pair::new(&image, &reference).unwrap();
    let expected = (0.25 + 0.0) / 2.0 / 1.01;
    assert_near(ghost_energy(&pair, &[0, u32::MAX, 7], 8).unwrap(), expected, 1e-12);
    assert!(ghost_energy(&pair, &[8, 9, 10], 8).unwrap().is_nan());
}

/// A moving average (1 − α)ᵏ⁺¹ is within a tenth of its step after ⌈ln 0.1 / ln(1 − α)⌉ − 1 frames.
#[test]
fn a_moving_average_lags_as_it_must() {
    let (old, new) = (grey(&[1.0, 0.0, 3.0]), grey(&[0.0, 2.0, 3.0]));
    for (alpha, tenth, fiftieth) in [(0.2_f32, 10, 17), (0.05, 44, 76), (1.0, 0, 0)] {
        let frame = |k: i32| -> Vec<[f32; 3]> {
            let left = (1.0 - alpha).powi(k + 1);
            old.iter().zip(&new).map(|(o, n)| [0, 1, 2].map(|c| left * o[c] + (1.0 - left) * n[c])).collect()
        };
        let frames: Vec<_> = (0..100).map(frame).collect();
        // The third pixel has no step to follow.
        let arrived = |frame| Lag { frames: vec![frame; 2], never: 0 };
        assert_eq!(lag(&old, &new, &frames, 0.1, 0.25).unwrap(), arrived(tenth));
        assert_eq!(lag(&old, &new, &frames, 0.02, 0.25).unwrap(), arrived(fiftieth));
        let short = lag(&old, &new, &frames[..tenth as usize], 0.1, 0.25).unwrap();
        assert_eq!(short.never, 2);
    }
}

#[test]
fn quantiles_of_lag() {
    let lag = Lag { frames: vec![0, 1, 1, 5], never: 4 };
    assert_eq!([0.0, 0.125, 0.25, 0.5, 0.51].map(|q| lag.quantile(q)), [Some(0), Some(0), Some(1), Some(5), None]);
    assert_eq!(lag.arrived(), 0.5);
    assert_eq!(Lag::default().quantile(0.5), None);
}

/// A pixel that leaves the band again has not settled.
#[test]
fn settled_means_for_good() {
    let frames = [1.0, 0.05, 0.5, 0.05, 0.0].map(|x| grey(&[x]));
    let found = lag(&grey(&[1.0]), &grey(&[0.0]), &frames, 0.1, 0.25).unwrap();
    assert_eq!(found, Lag { frames: vec![3], never: 0 });
}
