//! The plots, each as SVG and as PNG.

use crate::canvas::{Canvas, Ink};
use crate::methods::{CONTROL, DEFAULT, Group, ONE_PATH};
use crate::record::Column;
use crate::suite::TURN;
use crate::summary::Summary;
use crate::verdict;
use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::prelude::*;
use std::error::Error;
use std::path::Path;

const SIZE: (u32, u32) = (960, 600);
const FONT: (&str, i32) = ("sans-serif", 15);
const TITLE: (&str, i32) = ("sans-serif", 20);
/// Pixels for the labels of the axes.
const LABELS: u32 = 64;

/// Methods whose frames are drawn one by one.
const FOLLOWED: [&str; 6] = [ONE_PATH, "average 0.2", "svgf 0.2", "svgf 0.05", "classic", DEFAULT];

/// Colours that are told apart, dark enough for lines on white.
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

/// Something that can be drawn on anything.
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

/// Draws all there is to draw of a sequence; returns the names of the files, without their ending.
pub fn draw(folder: &Path, sequence: &str, summaries: &[Summary]) -> Result<Vec<String>, Box<dyn Error>> {
    let curve = |title, column, logarithmic| Curves { sequence, summaries, title, column, logarithmic };
    let name = |what: &str| format!("{sequence}-{what}");
    let names = ["error-time", "error-frames", "lambda", "history", "passes"].map(name);
    ErrorTime { sequence, summaries }.save(&folder.join(&names[0]))?;
    curve("relative MSE", |row| row.rel_mse, true).save(&folder.join(&names[1]))?;
    curve("mean λ", |row| row.lambda, false).save(&folder.join(&names[2]))?;
    curve("mean history length", |row| row.history, false).save(&folder.join(&names[3]))?;
    Passes { sequence, summaries }.save(&folder.join(&names[4]))?;
    Ok(names.to_vec())
}

/// Error against milliseconds, and the front of those that nothing beats in both.
struct ErrorTime<'a> {
    sequence: &'a str,
    summaries: &'a [Summary],
}

impl Plot for ErrorTime<'_> {
    fn draw<B: DrawingBackend<ErrorType: 'static>>(&self, root: &DrawingArea<B, Shift>) -> Drawn {
        let points: Vec<_> = self.summaries.iter().filter_map(|s| Some((s.point()?, s))).collect();
        let Some([times, errors]) = bounds(points.iter().map(|(point, _)| *point)) else { return Ok(()) };
        let room = |[low, high]: [f64; 2]| (low / 1.5..high * 2.5).log_scale();
        let mut chart = ChartBuilder::on(root)
            .caption(format!("{}: error against time", self.sequence), TITLE)
            .margin(12)
            .x_label_area_size(LABELS)
            .y_label_area_size(LABELS + 24)
            .build_cartesian_2d(room(times), room(errors))?;
        let mesh = &mut chart.configure_mesh();
        mesh.x_desc("milliseconds per frame").y_desc("relative MSE").label_style(FONT).max_light_lines(1).draw()?;
        let front = verdict::pareto(self.summaries).into_iter().filter_map(Summary::point);
        chart.draw_series(LineSeries::new(front, BLACK.mix(0.5).stroke_width(2)))?;
        chart.draw_series(points.iter().map(|&(point, s)| Circle::new(point, 5, color(s.group).filled())))?;
        let mut labels: Vec<[i32; 2]> = Vec::new();
        for (point, summary) in points {
            let (x, y) = chart.backend_coord(&point);
            let place = free([x + 9, y - 4], &labels);
            labels.push(place);
            root.draw(&Text::new(summary.method.as_str(), (place[0], place[1]), FONT))?;
        }
        Ok(())
    }
}

/// The nearest place above or below one where a label covers no other.
fn free([x, y]: [i32; 2], labels: &[[i32; 2]]) -> [i32; 2] {
    let [wide, high] = [110, 12];
    let covers = |place: [i32; 2]| labels.iter().any(|l| (l[0] - x).abs() < wide && (l[1] - place[1]).abs() < high);
    let near = (0..40).flat_map(|step| [[x, y + high * step], [x, y - high * step]]);
    near.into_iter().find(|&place| !covers(place)).unwrap_or([x, y])
}

/// A number of each frame around the turn, for some methods.
struct Curves<'a> {
    sequence: &'a str,
    summaries: &'a [Summary],
    title: &'a str,
    column: Column,
    logarithmic: bool,
}

impl Plot for Curves<'_> {
    fn draw<B: DrawingBackend<ErrorType: 'static>>(&self, root: &DrawingArea<B, Shift>) -> Drawn {
        let followed = FOLLOWED.iter().filter_map(|name| verdict::find(self.summaries, name));
        let points = |summary: &Summary| -> Vec<(f64, f64)> {
            summary.rows.iter().filter_map(|row| Some((row.frame.into(), (self.column)(row)?))).collect()
        };
        let curves: Vec<_> = followed.map(|summary| (summary, points(summary))).collect();
        let all = curves.iter().flat_map(|(_, points)| points.iter().copied());
        let Some([frames, [low, high]]) = bounds(all) else { return Ok(()) };
        if self.logarithmic {
            self.draw_on(root, curves, frames, [low / 1.5, high * 1.5], |[low, high]| (low..high).log_scale())
        } else {
            let room = 0.05 * (high - low).max(0.01);
            self.draw_on(root, curves, frames, [low - room, high + room], |[low, high]| low..high)
        }
    }
}

impl Curves<'_> {
    /// Draws the curves on an axis of either kind.
    fn draw_on<B: DrawingBackend<ErrorType: 'static>, Y: AsRangedCoord<Value = f64>>(
        &self,
        root: &DrawingArea<B, Shift>,
        curves: Vec<(&Summary, Vec<(f64, f64)>)>,
        frames: [f64; 2],
        heights: [f64; 2],
        axis: fn([f64; 2]) -> Y,
    ) -> Drawn
    where
        Y::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        let mut chart = ChartBuilder::on(root)
            .caption(format!("{}: {} per frame", self.sequence, self.title), TITLE)
            .margin(12)
            .x_label_area_size(LABELS)
            .y_label_area_size(LABELS + 24)
            // The legend is beside the curves.
            .build_cartesian_2d(frames[0]..frames[1] + 0.25 * (frames[1] - frames[0]), axis(heights))?;
        let mesh = &mut chart.configure_mesh();
        mesh.x_desc("frame").y_desc(self.title).x_label_formatter(&|x| format!("{x:.0}"));
        mesh.label_style(FONT).max_light_lines(1).draw()?;
        let turn = heights.map(|height| (f64::from(TURN), height));
        chart.draw_series(LineSeries::new(turn, BLACK.mix(0.3)))?;
        for (i, (summary, points)) in curves.into_iter().enumerate().filter(|(_, (_, points))| !points.is_empty()) {
            let color = PALETTE[i % PALETTE.len()].stroke_width(2);
            let sample = move |(x, y)| PathElement::new([(x, y), (x + 16, y)], color);
            chart.draw_series(LineSeries::new(points, color))?.label(&summary.method).legend(sample);
        }
        let legend = &mut chart.configure_series_labels();
        legend.position(SeriesLabelPosition::UpperRight).label_font(FONT);
        Ok(legend.background_style(WHITE.mix(0.8)).border_style(BLACK.mix(0.3)).draw()?)
    }
}

/// Milliseconds of each pass, one bar for each method.
struct Passes<'a> {
    sequence: &'a str,
    summaries: &'a [Summary],
}

impl Plot for Passes<'_> {
    fn draw<B: DrawingBackend<ErrorType: 'static>>(&self, root: &DrawingArea<B, Shift>) -> Drawn {
        // Many paths take so long that nothing else would be seen.
        let shown =
            |s: &&Summary| (!matches!(s.group, Group::Tracing(_)) || s.method == ONE_PATH) && !s.passes.is_empty();
        let bars: Vec<_> = self.summaries.iter().filter(shown).filter(|s| s.method != CONTROL).collect();
        let total = |s: &Summary| s.passes.iter().map(|(_, ms)| ms).sum::<f64>();
        let longest = bars.iter().map(|s| total(s)).fold(0.0, f64::max);
        if longest <= 0.0 {
            return Ok(());
        }
        let mut names: Vec<&str> = Vec::new();
        for (name, _) in bars.iter().flat_map(|bar| &bar.passes) {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        let mut chart = ChartBuilder::on(root)
            .caption(format!("{}: milliseconds per frame, pass by pass", self.sequence), TITLE)
            .margin(12)
            .x_label_area_size(LABELS)
            .y_label_area_size(2 * LABELS + 32)
            .build_cartesian_2d(0.0..1.4 * longest, 0.0..bars.len() as f64)?;
        let mesh = &mut chart.configure_mesh();
        mesh.disable_y_mesh()
            .disable_y_axis()
            .x_desc("milliseconds per frame")
            .label_style(FONT)
            .max_light_lines(1)
            .draw()?;
        // The names of the passes' colours.
        for (i, name) in names.iter().enumerate() {
            let color = PALETTE[i % PALETTE.len()].filled();
            let sample = move |(x, y)| Rectangle::new([(x, y - 5), (x + 10, y + 5)], color);
            let boxes = bars.iter().enumerate().filter_map(|(row, bar)| {
                let at = bar.passes.iter().position(|(other, _)| other == name)?;
                let left = bar.passes[..at].iter().map(|(_, ms)| ms).sum::<f64>();
                let top = (bars.len() - row) as f64;
                Some(Rectangle::new([(left, top - 0.85), (left + bar.passes[at].1, top - 0.15)], color))
            });
            chart.draw_series(boxes)?.label(*name).legend(sample);
        }
        for (row, bar) in bars.iter().enumerate() {
            let at = chart.backend_coord(&(0.0, (bars.len() - row) as f64 - 0.4));
            let name = Text::new(bar.method.as_str(), (12, at.1), FONT);
            root.draw(&name)?;
        }
        let legend = &mut chart.configure_series_labels();
        legend.position(SeriesLabelPosition::UpperRight).label_font(FONT);
        Ok(legend.background_style(WHITE.mix(0.8)).border_style(BLACK.mix(0.3)).draw()?)
    }
}

/// Least and largest x, and least and largest y.
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
