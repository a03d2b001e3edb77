//! Flicker in an image that should rest.

use crate::common::stage::Stage;
use crate::common::statistics::{Rgb, mean, relative_mse};
use asvgf::{FilterSettings, Mode, Settings, View};

const SIZE: [u32; 2] = [64, 48];

fn with(steadiness: f32) -> Settings {
    Settings { filter: FilterSettings { steadiness, ..Default::default() }, ..Settings::adaptive() }
}

/// Mean difference of two successive images over their mean, and the last image.
fn followed(scene: &str, settings: Settings, frames: u32) -> (f64, Vec<Rgb>) {
    let mut stage = Stage::built_in(scene, "static", SIZE, settings).leaving_nothing_out();
    let mut last = stage.frame().image();
    let mut flicker = 0.0;
    for _ in 1..frames {
        let now = stage.frame().image();
        let moved = now.iter().flatten().zip(last.iter().flatten()).map(|(a, b)| f64::from((a - b).abs())).sum::<f64>();
        flicker += moved / (3 * now.len()) as f64 / mean(&now) / f64::from(frames - 1);
        last = now;
    }
    (flicker, last)
}

#[test]
fn a_still_image_shimmers_half_as_much_and_is_as_near_to_the_truth() {
    let mut reference = Stage::built_in("cornell", "static", SIZE, Settings { mode: Mode::Reference, ..with(0.0) });
    let reference = reference.frames(1500).image();
    let [(bare, unsteadied), (steady, steadied)] =
        [0.0, 0.9].map(|steadiness| followed("cornell", with(steadiness), 16));
    assert!(steady < 0.6 * bare, "flicker {steady}, without {bare}");
    let [before, after] = [unsteadied, steadied].map(|image| relative_mse(&image, &reference));
    assert!(after < 1.1 * before, "relMSE {after}, without {before}");
}

/// The last output enters the history in one way only: as a level that outliers are measured against.
#[test]
fn nothing_of_the_output_enters_the_history() {
    let histories = [0.0, 0.9].map(|steadiness| {
        let mut stage = {
            let mut settings = with(steadiness);
            settings.filter.outlier_limit = 0.0;
            Stage::built_in("pillars", "move-camera", SIZE, settings)
        };
        stage.frames(6);
        [View::HistoryLength, View::Variance, View::Lambda].map(|view| stage.view(view))
    });
    assert_eq!(histories[0], histories[1]);
}
