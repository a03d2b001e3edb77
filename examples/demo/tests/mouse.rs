//! The program on a virtual display, driven by a mouse through xdotool; prints the time that each answer takes:
//! `cargo test --release -p asvgf-demo --test mouse -- --nocapture`. Needs Xvfb and xdotool; says so if they are missing.

mod desktop;

use desktop::{Desktop, Frame};
use std::ops::Range;
use std::time::Duration;

/// The window fills the screen.
const SIZE: [u32; 2] = [1280, 800];
/// Columns and rows of the picture that the panels and their margins leave, and that no pointer covers.
const LEFT: Range<u32> = 340..760;
const RIGHT: Range<u32> = 860..1270;
const ROWS: Range<u32> = 60..780;

/// Normals do not change while the camera stands still, although frame after frame is rendered: a change is the answer.
const NORMALS: &str = r#"{"view": "normal", "motion": {"blink": false}}"#;

/// Number of answers for a median.
const COUNT: usize = 9;

fn tell(what: &str, answers: &[Duration]) {
    let mut sorted: Vec<u128> = answers.iter().map(Duration::as_millis).collect();
    sorted.sort();
    println!("{what}: median {} ms of {sorted:?}", sorted[sorted.len() / 2]);
}

#[test]
fn the_picture_follows_the_mouse() {
    let Some(desktop) = Desktop::open(SIZE, NORMALS) else { return };
    let picture = |frame: &Frame| frame.pixels(LEFT, ROWS);
    desktop.settle(picture);
    desktop.point([1000, 400]);
    // The drag goes there and back, so that it never reaches an end.
    let drag = ["mousemove_relative -- 25 9", "mousemove_relative -- -25 -9"];
    for (name, moves) in [("wheel", ["click 4", "click 5"]), ("drag", drag)] {
        let mut answers = Vec::new();
        for i in 0..COUNT {
            if name == "drag" {
                desktop.act("mousedown 1");
            }
            desktop.settle(picture);
            answers.push(desktop.answer(moves[i % 2], picture));
            desktop.act("mouseup 1");
            desktop.point([1000, 400]);
        }
        tell(name, &answers);
    }
}

#[test]
fn the_divider_follows_the_mouse() {
    // In two halves of normals, the divider is the only white part, except where the pointer is drawn over it.
    let Some(desktop) = Desktop::open(SIZE, &NORMALS.replacen('{', r#"{"split": true, "#, 1)) else { return };
    let white = |frame: &Frame, columns: Range<u32>| {
        columns.filter(|&x| frame.pixels(x..x + 1, 500..700).iter().all(|pixel| *pixel == [255; 3])).collect::<Vec<_>>()
    };
    let all = |frame: &Frame| white(frame, LEFT.start..RIGHT.end);
    let mut at = desktop.settle(all);
    assert!(!at.is_empty(), "there is a divider");
    let mut answers = Vec::new();
    for to in [900, 700, 500, 650, 1100, 810, 600] {
        desktop.point([at[0] + 1, 400]);
        desktop.act("mousedown 1");
        // The demo looks for a pressed widget at the pointer's place when the next frame begins.
        desktop.settle(all);
        answers.push(desktop.answer(&format!("mousemove {to} 400"), all));
        at = desktop.settle(all);
        desktop.act("mouseup 1");
        assert!(at.iter().any(|x| x.abs_diff(to) <= 2), "dragged to {to}, found at {at:?}");
    }
    tell("divider", &answers);
}
