//! Measurements of a few small frames.

use crate::gpu::Gpu;
use crate::measure::{self, Output};
use crate::methods::{CONTROL, DEFAULT, all};
use crate::record::COLUMNS;
use crate::suite::{Suite, TURN};
use crate::summary::Summary;
use crate::truth::Truth;

/// The lamp goes out half way.
fn suite() -> Suite {
    let mut suite = Suite { size: [32, 18], frames: 6, paths: 64, repeats: 1, ..Suite::quick() };
    suite.sequences.retain(|sequence| sequence.name == "cornell-blink");
    suite
}

fn run(gpu: &Gpu, truth: &mut Truth, name: &str) -> Output {
    let method = all().into_iter().find(|method| method.name == name).unwrap();
    measure::run(gpu, &suite(), truth, ("cornell-blink", &method), String::new(), None).unwrap()
}

#[test]
fn a_sequence_is_measured() {
    let gpu = Gpu::new().unwrap();
    let suite = suite();
    let find = || Truth::find(&gpu, &suite, &suite.sequences[0], None, |_| {}).unwrap();
    let mut truth = find();

    // Still but for the light: what is relit has no steady origin, and all else is its own.
    let turn = &truth.moments[3];
    assert_eq!(turn.index, TURN);
    let relit = turn.ages.iter().filter(|&&age| age == 0).count();
    assert!(2 * relit > turn.ages.len(), "{relit} pixels are relit");
    for (pixel, (&age, &origin)) in turn.ages.iter().zip(&turn.steady).enumerate() {
        assert_eq!(origin, (age > 0).then_some(pixel));
    }
    assert!(truth.moments[5].ages.iter().all(|&age| age == 2 || age == u32::MAX));

    // The same numbers again, from references that were kept and a denoiser of its own.
    let first = run(&gpu, &mut truth, DEFAULT);
    let again = run(&gpu, &mut find(), DEFAULT);
    assert_eq!(first.images, again.images);
    for (a, b) in first.run.rows.iter().zip(&again.run.rows) {
        for (name, number) in COLUMNS.iter().filter(|(name, _)| *name != "ms") {
            assert_eq!(number(a), number(b), "{name}");
        }
    }
    let [before, after] = [2, 3].map(|i| first.run.rows[i].lambda.unwrap());
    assert!(before == 0.0 && after > 0.2, "λ is {before} before the turn and {after} after");
    assert_eq!(first.run.lag.len(), 2);
    assert_eq!(first.run.repeats, 1);
    // Three of six frames warm up.
    assert_eq!(first.run.times.len(), 3);

    // What is made worse on purpose is shown worse, and a constant α ghosts.
    let summary = |output: &Output, name: &str| {
        let method = all().into_iter().find(|method| method.name == name).unwrap();
        Summary::of(&output.run, name, method.group)
    };
    let error = |name: &str, truth: &mut Truth| summary(&run(&gpu, truth, name), name);
    let adaptive = summary(&first, DEFAULT);
    let (control, slow) = (error(CONTROL, &mut truth), error("svgf 0.05", &mut truth));
    assert!(control.error() > adaptive.error().map(|error| 3.0 * error));
    assert!(slow.mean(|row| row.ghost) > adaptive.mean(|row| row.ghost).map(|ghost| 10.0 * ghost));
}
