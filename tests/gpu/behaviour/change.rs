//! A lamp that goes out and on again.

use crate::common::stage::Stage;
use crate::common::statistics::mean;
use asvgf::scene::builtin;
use asvgf::{Mode, Settings};

const SIZE: [u32; 2] = [64, 36];

/// Frames of the built-in animation at which the lamp goes out and on.
const OUT: u32 = 30;
const ON: u32 = 60;

/// Mean brightness of the truth with the lamp out and on.
fn levels(scene: &str) -> [f64; 2] {
    [OUT, ON].map(|frame| {
        let settings = Settings { mode: Mode::Reference, ..Settings::adaptive() };
        let mut stage = Stage::built_in(scene, "blink", SIZE, settings);
        let pose = stage.pose_at(frame);
        for _ in 0..64 {
            stage.frame_in(&pose);
        }
        mean(&stage.image())
    })
}

/// The speed at which an image follows the lamp, out and on.
#[derive(Debug)]
struct Followed {
    /// Frames until the image's mean is within 10 % of the truth. `None` if the lamp changes before that.
    frames: [Option<u32>; 2],
    /// The part of the step that is left after three frames, 0…1.
    left: [f64; 2],
}

fn follow(scene: &str, settings: Settings, levels: [f64; 2]) -> Followed {
    let mut stage = Stage::built_in(scene, "blink", SIZE, settings);
    stage.frames(OUT);
    let mut followed = Followed { frames: [None; 2], left: [0.0; 2] };
    for (i, level) in levels.into_iter().enumerate() {
        for count in 1..=30 {
            let away = (mean(&stage.frame().image()) - level).abs();
            if away <= 0.1 * level {
                followed.frames[i] = followed.frames[i].or(Some(count));
            }
            if count == 3 {
                followed.left[i] = away / (levels[1] - levels[0]);
            }
        }
    }
    followed
}

#[test]
fn a_blinking_lamp_is_followed_within_three_frames() {
    assert_eq!(builtin::PERIOD, 4.0, "the frames above belong to this period");
    for scene in ["cornell", "pillars"] {
        let levels = levels(scene);
        let adaptive = follow(scene, Settings::adaptive(), levels);
        let classic = follow(scene, Settings::classic(), levels);
        let constant = follow(scene, Settings::adaptive().constant(0.1), levels);
        println!("{scene}, lamp [out, on], levels {levels:.4?}:");
        println!("  adaptive {adaptive:.3?}\n  classic {classic:.3?}\n  constant α 0.1 {constant:.3?}");
        for followed in adaptive.frames {
            assert!(followed.is_some_and(|n| n <= 3), "{scene}: {adaptive:?}");
        }
        assert!(adaptive.left.iter().all(|&left| left <= 0.03), "{scene}: {adaptive:?}");
        // The purpose of the gradient: a constant α leaves several times as much.
        let slower = |i: usize| constant.left[i] >= 5.0 * adaptive.left[i];
        assert!(slower(0) && slower(1), "{scene}: {adaptive:?}, constant {constant:?}");
    }
}
