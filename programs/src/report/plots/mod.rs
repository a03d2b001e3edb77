//! The plots, each as SVG and as PNG.

mod ablation;
mod curves;
mod error_time;
mod growth;
mod passes;

use crate::report::canvas::{Canvas, Ink};
use crate::report::growth::{Cost, Growth};
use crate::report::methods::Group;
use crate::report::summary::Summary;
use ablation::Ablation;
use curves::Curves;
use error_time::ErrorTime;
use growth::Growing;
use passes::Passes;
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::ranged1d::Ranged;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use std::error::Error;
use std::path::Path;

const SIZE: (u32, u32) = (960, 600);
const FONT: (&str, i32) = ("sans-serif", 15);
const TITLE: (&str, i32) = ("sans-serif", 20);
/// Larger letters than drawn, because plotters reserves a legend's room for narrower ones.
const LEGEND: (&str, i32) = ("sans-serif", 18);
/// Pixels for the labels of the axes.
const LABELS: u32 = 64;

/// Distinguishable colours, dark enough for lines on white.
const PALETTE: [RGBColor; 12] = [
    RGBColor(78, 121, 167),
    RGBColor(242, 142, 43),
    RGBColor(89, 161, 79),
    RGBColor(225, 87, 89),
    RGBColor(118, 183, 178),
    RGBColor(176, 122, 161),
    RGBColor(156, 117, 95),
    RGBColor(237, 201, 72),
    RGBColor(255, 157, 167),
    RGBColor(140, 140, 140),
    RGBColor(60, 90, 60),
    RGBColor(60, 60, 120),
];

type Drawn = Result<(), Box<dyn Error>>;

/// A drawing that works on any backend.
trait Plot {
    fn draw<B: DrawingBackend<ErrorType: 'static>>(&self, root: &DrawingArea<B, Shift>) -> Drawn;

    fn save(&self, path: &Path) -> Drawn {
        let svg = path.with_extension("svg");
        let root = SVGBackend::new(&svg, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        self.draw(&root)?;
        root.present()?;
        let mut canvas = Canvas::new([SIZE.0, SIZE.1], [255; 4]);
        self.draw(&Ink(&mut canvas).into_drawing_area())?;
        Ok(canvas.save(&path.with_extension("png"))?)
    }
}

/// Draws all plots of a sequence; returns the names of the files, without their ending.
pub fn draw(folder: &Path, sequence: &str, summaries: &[Summary]) -> Result<Vec<String>, Box<dyn Error>> {
    let curve = |title, column, logarithmic| Curves { sequence, summaries, title, column, logarithmic };
    let name = |what: &str| format!("{sequence}-{what}");
    let names = ["error-time", "ablation", "error-frames", "lambda", "history", "passes"].map(name);
    ErrorTime { sequence, summaries }.save(&folder.join(&names[0]))?;
    Ablation { sequence, summaries }.save(&folder.join(&names[1]))?;
    curve("relative MSE", |row| row.rel_mse, true).save(&folder.join(&names[2]))?;
    curve("mean λ", |row| row.lambda, false).save(&folder.join(&names[3]))?;
    curve("mean history length", |row| row.history, false).save(&folder.join(&names[4]))?;
    Passes { sequence, summaries }.save(&folder.join(&names[5]))?;
    Ok(names.to_vec())
}

/// Draws the growth of costs; returns the names of the files, without their ending.
pub fn draw_growth(folder: &Path, growth: &Growth) -> Result<Vec<String>, Box<dyn Error>> {
    let pixels = |cost: &Cost| f64::from(cost.size[0] * cost.size[1]);
    let sizes = |number: fn(&Cost) -> f64| growth.sizes.iter().map(|cost| (pixels(cost), number(cost))).collect();
    let trees = growth.with_trees().map(|cost| (cost.triangles as f64, cost.tracing)).collect();
    let plots = [
        (
            "growth-time",
            "Time against pixels",
            ["pixels", "milliseconds per frame"],
            vec![("filter", sizes(|cost| cost.filter)), ("tracing", sizes(|cost| cost.tracing))],
        ),
        (
            "growth-memory",
            "Memory against pixels",
            ["pixels", "bytes of the denoiser's images"],
            vec![("images", sizes(|cost| cost.images as f64))],
        ),
        (
            "growth-triangles",
            "Time against triangles",
            ["triangles", "milliseconds of tracing per frame"],
            vec![("tracing", trees)],
        ),
    ];
    for (name, caption, axes, curves) in plots.iter().cloned() {
        Growing { caption, axes, curves }.save(&folder.join(name))?;
    }
    Ok(plots.iter().map(|(name, ..)| name.to_string()).collect())
}

type Chart<'a, B, Y> = ChartContext<'a, B, Cartesian2d<RangedCoordf64, Y>>;

/// Makes a chart with one bar for each name, from above.
fn bars<'a, B: DrawingBackend<ErrorType: 'static>>(
    root: &'a DrawingArea<B, Shift>,
    caption: &str,
    axis: &str,
    end: f64,
    names: &[&str],
) -> Result<Chart<'a, B, RangedCoordf64>, Box<dyn Error>> {
    let mut chart = ChartBuilder::on(root)
        .caption(caption, TITLE)
        .margin(12)
        .x_label_area_size(LABELS)
        .y_label_area_size(2 * LABELS + 100)
        .build_cartesian_2d(0.0..end, 0.0..names.len() as f64)?;
    let mesh = &mut chart.configure_mesh();
    mesh.disable_y_mesh().disable_y_axis().x_desc(axis).label_style(FONT).max_light_lines(1).draw()?;
    for (row, name) in names.iter().enumerate() {
        let [low, high] = span(row, names.len());
        let (_, y) = chart.backend_coord(&(0.0, 0.5 * (low + high)));
        root.draw(&Text::new(*name, (12, y - 4), FONT))?;
    }
    Ok(chart)
}

/// Returns the lower and the upper end of a bar.
fn span(row: usize, rows: usize) -> [f64; 2] {
    let top = (rows - row) as f64;
    [top - 0.85, top - 0.15]
}

/// Draws the legend of the colours.
fn legend<'a, B: DrawingBackend<ErrorType: 'static> + 'a, X: Ranged<ValueType = f64>, Y: Ranged<ValueType = f64>>(
    chart: &mut ChartContext<'a, B, Cartesian2d<X, Y>>,
) -> Drawn {
    let labels = &mut chart.configure_series_labels();
    labels.position(SeriesLabelPosition::UpperRight).label_font(LEGEND);
    Ok(labels.background_style(WHITE.mix(0.8)).border_style(BLACK.mix(0.3)).draw()?)
}

/// True if a method is the default with a change.
fn is_variant(summary: &Summary) -> bool {
    matches!(summary.group, Group::Iterations | Group::Ablation)
}

/// Returns the least and the largest x, and the least and the largest y.
fn bounds(points: impl Iterator<Item = (f64, f64)>) -> Option<[[f64; 2]; 2]> {
    let of = |[low, high]: [f64; 2], value: f64| [low.min(value), high.max(value)];
    points.fold(None, |bounds, (x, y)| {
        let [xs, ys] = bounds.unwrap_or([[x, x], [y, y]]);
        Some([of(xs, x), of(ys, y)])
    })
}

fn color(group: Group) -> RGBColor {
    match group {
        Group::Tracing(_) => RGBColor(120, 120, 120),
        Group::Average => RGBColor(190, 150, 60),
        Group::Constant => RGBColor(200, 90, 60),
        Group::Adaptive => RGBColor(30, 110, 200),
        Group::Iterations => RGBColor(60, 160, 180),
        Group::Ablation => RGBColor(140, 100, 190),
        Group::Control => RGBColor(200, 0, 0),
        Group::Baseline => RGBColor(40, 150, 60),
    }
}
