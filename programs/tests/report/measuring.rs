//! Measurements of a few small frames.

use asvgf::Settings;
use asvgf::scene::{GpuScene, builtin};
use asvgf_programs::gpu::Gpu;
use asvgf_programs::report::measure::{self, Output};
use asvgf_programs::report::methods::{CONTROL, DEFAULT, all};
use asvgf_programs::report::record::COLUMNS;
use asvgf_programs::report::suite::{Suite, TURN};
use asvgf_programs::report::summary::Summary;
use asvgf_programs::report::truth::{Truth, move_to};
use asvgf_programs::tracing::Reference;

/// Returns a suite in which the lamp goes out half way.
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

    // Everything is still but the light: relit pixels have no steady origin, and all other pixels are their own origin.
    let turn = &truth.moments[3];
    assert_eq!(turn.index, TURN);
    let relit = turn.ages.iter().filter(|&&age| age == 0).count();
    assert!(2 * relit > turn.ages.len(), "{relit} pixels are relit");
    for (pixel, (&age, &origin)) in turn.ages.iter().zip(&turn.steady).enumerate() {
        assert_eq!(origin, (age > 0).then_some(pixel));
    }
    assert!(truth.moments[5].ages.iter().all(|&age| age == 2 || age == u32::MAX));

    // A second run yields the same numbers, from kept references and another denoiser.
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

    // The control must be worse, and a constant α must ghost.
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

/// Returns the sum of the squared differences of two references with this many paths: their variance times twice the
/// number of their values. The scene has just moved, or has stood still.
fn noise(gpu: &Gpu, paths: u32, moves: bool) -> f64 {
    let scene = builtin::scene("cornell", "all").unwrap();
    let mut uploaded = GpuScene::new(&gpu.device, &gpu.queue, &scene).unwrap();
    let pose = scene.pose(Some(0), 0.7);
    if moves {
        move_to(gpu, &mut uploaded, &scene.pose(Some(0), 0.6)).unwrap();
    }
    move_to(gpu, &mut uploaded, &pose).unwrap();
    if !moves {
        move_to(gpu, &mut uploaded, &pose).unwrap();
    }
    let camera = scene.camera_view(&pose, scene.camera_node().unwrap()).unwrap();
    let mut reference = Reference::new(gpu, [32, 18], &Settings::adaptive()).unwrap();
    let mut image = || reference.converge(&uploaded, camera, paths, |_| {}).unwrap();
    let (a, b) = (image(), image());
    a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| f64::from(a - b).powi(2)).sum()
}

#[test]
fn a_reference_of_a_moving_scene_has_the_noise_of_all_its_paths() {
    let gpu = Gpu::new().unwrap();
    let [few, many, rested] = [(16, true), (256, true), (256, false)].map(|(paths, moves)| noise(&gpu, paths, moves));
    println!("squared differences: {few:.3} of 16 paths, {many:.3} of 256, {rested:.3} of 256 at rest");
    assert!((8.0..32.0).contains(&(few / many)), "16 times as many paths, {} times less variance", few / many);
    assert_eq!(many, rested, "it does not matter whether the scene has just moved");
}
