//! Parts that are dropped to keep within a budget.

use asvgf_programs::report::budget::{shortfall, size};
use asvgf_programs::report::pace::{Load, Pace};

const FULL: [u32; 2] = [640, 360];
const PACE: Pace = Pace { run: 2.0, filtered: 0.5, path: 0.25, scored: 0.125 };

/// A load of 50 + 25 + 25 seconds at full size, and of 20 at any.
const LOAD: Load = Load { runs: 10, filtered: 100, paths: 100, scored: 200 };

#[test]
fn a_load_takes_what_its_parts_take() {
    assert_eq!(PACE.seconds(&LOAD, 1.0), 120.0);
    assert_eq!(PACE.seconds(&LOAD, 0.25), 45.0);
    assert_eq!(PACE.seconds(&Load::default(), 1.0), 0.0);
}

/// The margin is a quarter: 150 seconds for 120, 56.25 for 45.
#[test]
fn the_size_is_halved_until_all_of_it_fits() {
    let fitting = |seconds| size(FULL, seconds, &PACE, |_| LOAD);
    assert_eq!(fitting(151.0), FULL);
    assert_eq!(fitting(149.0), [320, 180]);
    assert_eq!(fitting(57.0), [320, 180]);
    assert_eq!(fitting(56.0), [160, 90]);
    // A smaller image would show nothing, so methods have to go instead.
    assert_eq!(fitting(0.0), [80, 45]);
    assert_eq!(size([32, 18], 0.0, &PACE, |_| LOAD), [32, 18]);
}

/// References of another size are other files, which may have to be traced.
#[test]
fn what_is_kept_takes_no_time() {
    let load = |size| if size == FULL { Load { paths: 0, ..LOAD } } else { LOAD };
    assert_eq!(size(FULL, 119.0, &PACE, load), FULL);
    assert_eq!(size(FULL, 118.0, &PACE, load), [320, 180]);
    assert_eq!(size(FULL, 0.0, &PACE, |_| Load::default()), FULL);
}

#[test]
fn what_is_dropped_is_said() {
    let said = |runs: &[(&str, Option<u32>)]| shortfall("box", runs, 3);
    assert_eq!(said(&[("a", Some(3)), ("b", Some(3))]), None);
    assert_eq!(said(&[("a", Some(0)), ("b", Some(0))]).unwrap(), "box: 3 of 3 repeats of all methods");
    let mixed = [("a", Some(3)), ("b", Some(1)), ("c", None), ("d", Some(1)), ("e", Some(2))];
    assert_eq!(said(&mixed).unwrap(), "box: c as a whole; 2 of 3 repeats of b, d; 1 of 3 repeats of e");
}
