//! Plot of error against time.

use super::{Drawn, FONT, LABELS, Plot, TITLE, bounds, color, is_variant};
use crate::report::summary::Summary;
use crate::report::verdict;
use plotters::coord::Shift;
use plotters::prelude::*;

/// Error against milliseconds, and the front of the methods that no other beats in both. Variants of the default have
/// their own plot.
pub struct ErrorTime<'a> {
    pub sequence: &'a str,
    pub summaries: &'a [Summary],
}

impl Plot for ErrorTime<'_> {
    fn draw<B: DrawingBackend<ErrorType: 'static>>(&self, root: &DrawingArea<B, Shift>) -> Drawn {
        let shown: Vec<_> = self.summaries.iter().filter(|summary| !is_variant(summary)).cloned().collect();
        let points: Vec<_> = shown.iter().filter_map(|s| Some((s.point()?, s))).collect();
        let Some([times, errors]) = bounds(points.iter().map(|(point, _)| *point)) else { return Ok(()) };
        let room = |[low, high]: [f64; 2]| (low / 1.5..high * 2.5).log_scale();
        let mut chart = ChartBuilder::on(root)
            .caption(format!("{}: error against time", self.sequence), TITLE)
            .margin(12)
            .x_label_area_size(LABELS)
            .y_label_area_size(LABELS + 24)
            .build_cartesian_2d(room(times), room(errors))?;
        let mesh = &mut chart.configure_mesh();
        mesh.x_label_formatter(&sparse).y_label_formatter(&sparse);
        mesh.x_desc("milliseconds per frame").y_desc("relative MSE").label_style(FONT).max_light_lines(1).draw()?;
        let front = verdict::pareto(&shown).into_iter().filter_map(Summary::point);
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

/// Returns the nearest place above or below a place for a label that covers no other.
fn free([x, y]: [i32; 2], labels: &[[i32; 2]]) -> [i32; 2] {
    let [wide, high] = [110, 12];
    let covers = |place: [i32; 2]| labels.iter().any(|l| (l[0] - x).abs() < wide && (l[1] - place[1]).abs() < high);
    let near = (0..40).flat_map(|step| [[x, y + high * step], [x, y - high * step]]);
    near.into_iter().find(|&place| !covers(place)).unwrap_or([x, y])
}

/// Formats a number that begins with 1, 2 or 5. Other numbers become an empty label, because they would stand too close.
pub fn sparse(value: &f64) -> String {
    let digit = value / 10_f64.powf((value.log10() + 1e-9).floor());
    let round = [1.0, 2.0, 5.0].iter().any(|first| (digit - first).abs() < 1e-6);
    if round { format!("{}", (value * 1e9).round() / 1e9) } else { String::new() }
}
