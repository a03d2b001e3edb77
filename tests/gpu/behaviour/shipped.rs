//! A picture of a file of this repository, against one by another renderer.
#![cfg(feature = "gltf")]

use crate::common::stage::Stage;
use asvgf::{Settings, scene};
use std::path::Path;

/// Mean of each channel by Mitsuba 3.9.1 in frame 7: 48×27 pixels of 1024 paths, see benches/peers/mitsuba_still_life.py. Passes of 256 paths
/// are up to 1.2 % off.
const MEAN: [f64; 3] = [0.2342, 0.1884, 0.1251];

#[test]
fn the_still_life_is_as_bright_as_by_another_renderer() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/still_life/still_life.glb");
    let loaded = scene::load(file).unwrap();
    let mut stage = Stage::new(loaded.scene, [48, 27], Settings::adaptive());
    let image = stage.frames(8).image();
    assert!(image.iter().flatten().all(|x| x.is_finite() && *x >= 0.0));
    for (channel, expected) in MEAN.into_iter().enumerate() {
        let mean = image.iter().map(|c| f64::from(c[channel])).sum::<f64>() / image.len() as f64;
        // Eight paths per pixel are noisy, and three reflections are all that the settings have.
        assert!((mean / expected - 1.0).abs() < 0.1, "channel {channel}: {mean}, not {expected}");
    }
}
