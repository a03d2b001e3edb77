//! Conclusions from numbers.

use asvgf_programs::report::methods::{CONTROL, DEFAULT, Group, ONE_PATH};
use asvgf_programs::report::record::{Row, Run};
use asvgf_programs::report::summary::{Summary, spread};
use asvgf_programs::report::verdict::{claims, equal_error, equal_time, pareto};

/// Returns a method that takes `ms` for every frame and has the same error in all.
fn method(name: &str, group: Group, ms: f64, error: f64) -> Summary {
    let row = Row { rel_mse: Some(error), ghost: Some(error), flicker: Some(1.0 / error), ..Row::default() };
    let times =
        vec![vec![("trace".into(), 0.75 * ms), ("atrous".into(), 0.125 * ms), ("atrous".into(), 0.125 * ms)]; 5];
    let run = Run { key: String::new(), rows: vec![row; 4], lag: Vec::new(), repeats: 1, times };
    Summary::of(&run, name, group)
}

fn names(summaries: &[&Summary]) -> Vec<String> {
    summaries.iter().map(|summary| summary.method.clone()).collect()
}

fn measured() -> Vec<Summary> {
    vec![
        method(ONE_PATH, Group::Tracing(1), 1.0, 0.4),
        method("2 spp", Group::Tracing(2), 2.0, 0.2),
        method("4 spp", Group::Tracing(4), 4.0, 0.1),
        method(DEFAULT, Group::Adaptive, 2.0, 0.01),
        method("svgf 0.2", Group::Constant, 1.5, 0.025),
        method("svgf 0.05", Group::Constant, 1.5, 0.05),
        method(CONTROL, Group::Control, 2.0, 0.3),
    ]
}

#[test]
fn passes_are_added_up_by_name() {
    let summary = method("any", Group::Adaptive, 2.0, 0.1);
    assert_eq!(summary.passes, [("trace".to_owned(), 1.5), ("atrous".to_owned(), 0.5)]);
    assert_eq!(summary.ms.map(|ms| [ms.low, ms.median, ms.high]), Some([2.0; 3]));
    let wide = spread(vec![4.0, 0.0, 1.0, 3.0, 2.0]).unwrap();
    assert_eq!([wide.low, wide.median, wide.high], [1.0, 2.0, 3.0]);
    assert!(spread(Vec::new()).is_none());
}

#[test]
fn the_front_is_what_nothing_beats() {
    assert_eq!(names(&pareto(&measured())), [ONE_PATH, "svgf 0.2", DEFAULT]);
}

#[test]
fn the_winner_takes_no_longer() {
    let mut measured = measured();
    assert_eq!(equal_time(&measured).unwrap().method, DEFAULT);
    measured.push(method("slower", Group::Iterations, 2.2, 0.001));
    assert_eq!(equal_time(&measured).unwrap().method, DEFAULT);
    measured.push(method("better", Group::Iterations, 2.0, 0.005));
    assert_eq!(equal_time(&measured).unwrap().method, "better");
}

/// An error of 0.4 / paths at a millisecond a path is 0.01 after 40 ms: 20 times the default's 2 ms.
#[test]
fn the_speed_up_is_read_off_path_tracing() {
    let speed_up = equal_error(&measured()).unwrap();
    for (found, expected) in [(speed_up.paths, 40.0), (speed_up.ms, 40.0), (speed_up.factor, 20.0)] {
        assert!((found - expected).abs() < 1e-5, "{found}, not {expected}");
    }
    assert!(speed_up.extrapolated);
    assert!(equal_error(&measured()[3..]).is_none());
}

#[test]
fn claims_are_held_against_the_numbers() {
    let held = |sequence: &str, measured: &[Summary]| -> Vec<bool> {
        claims(sequence, measured).iter().map(|claim| claim.holds).collect()
    };
    assert_eq!(held("cornell-blink", &measured()), [true, true, true]);
    assert_eq!(held("cornell-static", &measured()), [true, true, true, true]);
    // 0.02 is within 1.05 × 0.025, but above half of it.
    let mut worse = measured();
    worse[3] = method(DEFAULT, Group::Adaptive, 2.0, 0.02);
    worse[6] = method(CONTROL, Group::Control, 2.0, 0.01);
    assert_eq!(held("cornell-all", &worse), [true, true, false]);
    assert_eq!(held("cornell-blink", &worse), [false, true, false]);
    assert!(claims("cornell-blink", &[]).is_empty());
}
