//! Output files.

use asvgf::image_io::read_png;
use asvgf_programs::report::methods::{DEFAULT, Group, ONE_PATH};
use asvgf_programs::report::record::{Row, Run, Settling};
use asvgf_programs::report::summary::Summary;
use asvgf_programs::report::words::{Chapter, Context, report};
use asvgf_programs::report::{crops, plots, tables};
use std::path::PathBuf;

/// A folder that is removed at the end of its test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("asvgf-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn row(frame: u32, error: f64) -> Row {
    let (sequence, method) = ("box".into(), "say \"a\"".into());
    let known = Some(error);
    Row { sequence, method, frame, rel_mse: known, lambda: Some(0.0), history: Some(1.0), ..Row::default() }
}

fn summaries() -> Vec<Summary> {
    let lag = vec![Settling { band: 0.1, median: Some(3), ninth_decile: None, arrived: 0.75 }];
    let method = |name: &str, group, ms: f64, error: f64, lag: &[Settling]| {
        let rows = (28..33).map(|frame| row(frame, error)).collect();
        let run =
            Run { key: String::new(), rows, lag: lag.to_vec(), repeats: 1, times: vec![vec![("trace".into(), ms)]] };
        Summary::of(&run, name, group)
    };
    vec![
        method(DEFAULT, Group::Adaptive, 2.0, 0.01, &lag),
        method(ONE_PATH, Group::Tracing(1), 1.0, 0.4, &[]),
        method("4 spp", Group::Tracing(4), 4.0, 0.1, &[]),
    ]
}

#[test]
fn rows_become_tables() {
    let rows = [row(7, 0.25)];
    let csv = tables::csv(&rows);
    let expected = "sequence,method,frame,rel_mse,rmse,psnr,ssim,flip,bias,flicker,ghost,lambda,history,ms\n\
                    \"box\",\"say \"\"a\"\"\",7,0.25,,,,,,,,0,1,\n";
    assert_eq!(csv, expected);
    let json: serde_json::Value = serde_json::from_str(&tables::json(&rows).unwrap()).unwrap();
    assert_eq!(json[0]["method"], "say \"a\"");
    assert_eq!(json[0]["rel_mse"], 0.25);
    assert!(json[0]["ssim"].is_null());
}

#[test]
fn words_come_from_the_numbers() {
    let chapter = |summaries| Chapter { sequence: "box".into(), summaries, plots: vec!["p".into()], picture: None };
    let context = Context { facts: vec!["Suite quick".into()], dropped: vec!["box, 64 spp".into()] };
    let text = report(&context, &[chapter(summaries())]);
    for part in [
        "- Suite quick\n",
        "to keep within the budget (with no repeat, times are of frames that warmed up):\n\n- box, 64 spp\n",
        "| a-svgf | 2.00 (2.00…2.00) | 0.01000 | – |",
        "| a-svgf | 10 % | 3 | – | 75.0 % |",
        "- Equal time: no method that takes as long as a-svgf or less has a smaller error.",
        "- Equal error: path tracing alone would need 40 paths per pixel (extrapolated) and 40.0 ms a frame for the error of a-svgf: 20.0 \
         times as long.",
        "- Pareto front (no method beats these in both time and error): 1 spp, a-svgf.",
        "![p](p.svg)",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    let complete = Context { facts: Vec::new(), dropped: Vec::new() };
    assert!(!report(&complete, &[chapter(summaries())]).contains("budget"));
}

#[test]
fn plots_are_drawn_and_labelled() {
    let folder = Folder::new("plots");
    let names = plots::draw(&folder.0, "box", &summaries()).unwrap();
    assert_eq!(names.len(), 6);
    for name in names {
        let svg = std::fs::read_to_string(folder.0.join(format!("{name}.svg"))).unwrap();
        assert!(svg.contains(DEFAULT) && svg.trim_end().ends_with("</svg>"), "{name}");
        let (width, height, pixels) = read_png(folder.0.join(format!("{name}.png"))).unwrap();
        assert_eq!((width, height), (960, 600));
        assert!(pixels.iter().filter(|pixel| pixel[0] < 128).count() > 1000, "{name} is empty");
    }
    // Without measurements, nothing is drawn, and nothing fails.
    plots::draw(&folder.0, "none", &[]).unwrap();
}

#[test]
fn pictures_stand_side_by_side() {
    let folder = Folder::new("crops");
    let path = folder.0.join("comparison.png");
    let tile = |name: &str, level| (name.to_owned(), vec![[level; 3]; 12 * 8]);
    crops::write(&path, [12, 8], &[tile("one", 0.9), tile("reference", 0.2)]).unwrap();
    let (width, height, pixels) = read_png(&path).unwrap();
    // The pictures are magnified 24 times, with 4 pixels between and 12 above.
    let rows = if cfg!(feature = "flip") { 2 } else { 1 };
    assert_eq!((width, height), (2 * 288 + 4, rows * (12 + 192) + 4 * (rows - 1)));
    let at = |x: u32, y: u32| pixels[(y * width + x) as usize];
    assert!(at(100, 100)[0] > at(400, 100)[0]);
    if rows == 2 {
        // The map of a large error is bright, and the reference has none.
        assert!(at(100, 300)[0] > 128);
        assert_eq!(at(400, 300), [24, 24, 24, 255]);
    }
}
