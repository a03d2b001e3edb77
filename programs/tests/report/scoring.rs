//! Errors are measured from the truth, not from a noisy reference.

use asvgf::Camera;
use asvgf::scene::builtin;
use asvgf_programs::report::record::Row;
use asvgf_programs::report::score;
use asvgf_programs::report::truth::{Moment, Rgb};

const SIZE: [u32; 2] = [96, 96];

/// Returns a uniform number in −½…½, with a variance of 1/12 (xorshift32, Marsaglia 2003).
fn noise(state: &mut u32) -> f32 {
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    (f64::from(*state) / 4294967296.0 - 0.5) as f32
}

/// The truth is 1 everywhere, the image is 1.1, and each half of the reference has noise of a variance of 0.0075.
#[test]
fn the_noise_of_references_is_not_counted() {
    let mut state = 1;
    let mut half =
        || -> Vec<Rgb> { (0..SIZE[0] * SIZE[1]).map(|_| [0; 3].map(|_| 1.0 + 0.3 * noise(&mut state))).collect() };
    let [first, second] = [half(), half()];
    let mean = first.iter().zip(&second).map(|(a, b)| [0, 1, 2].map(|c| 0.5 * (a[c] + b[c]))).collect();
    let moment = Moment {
        index: 0,
        pose: builtin::scene("cornell", "static").unwrap().pose(None, 0.0),
        camera: Camera::default(),
        reference: mean,
        half: first,
        counted: vec![true; 96 * 96],
        steady: vec![None; 96 * 96],
        ages: vec![u32::MAX; 96 * 96],
    };
    let mut rows = [Row::default()];
    score::fill(&mut rows, &[vec![[1.1; 3]; 96 * 96]], &[moment], SIZE).unwrap();
    // Three standard errors of 27 648 samples are 0.0002: of the noise's 0.004, and of its product with the difference.
    let rmse = rows[0].rmse.unwrap();
    assert!((rmse * rmse - 0.01).abs() < 0.0003, "{rmse}");
    // With a noise v in the divisor too, (0.1 − n)²/(1 + n)² adds 0.43·v to second order.
    let relative = rows[0].rel_mse.unwrap();
    assert!((relative - 0.01 / 1.01).abs() < 0.0021, "{relative}");
}
