//! Plot of the frames around the turn.

use super::{Drawn, FONT, LABELS, PALETTE, Plot, TITLE, bounds, legend};
use crate::report::methods::{DEFAULT, ONE_PATH};
use crate::report::record::Column;
use crate::report::suite::TURN;
use crate::report::summary::Summary;
use crate::report::verdict;
use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::prelude::*;

/// Methods with a curve.
const FOLLOWED: [&str; 6] = [ONE_PATH, "average 0.2", "svgf 0.2", "svgf 0.05", "classic", DEFAULT];

/// A number of each frame around the turn, for some methods.
pub struct Curves<'a> {
    pub sequence: &'a str,
    pub summaries: &'a [Summary],
    pub title: &'a str,
    pub column: Column,
    pub logarithmic: bool,
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
    /// Draws the curves on a linear or a logarithmic axis.
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
            // The free space on the right holds the legend.
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
        legend(&mut chart)
    }
}
