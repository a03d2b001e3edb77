//! Plot of the growth of costs.

use super::error_time::sparse;
use super::{Drawn, FONT, LABELS, PALETTE, Plot, TITLE, bounds, legend};
use crate::report::fit::Power;
use plotters::coord::Shift;
use plotters::prelude::*;

/// Costs against pixels or triangles, each with its best power law.
pub struct Growing<'a> {
    pub caption: &'a str,
    pub axes: [&'a str; 2],
    pub curves: Vec<(&'a str, Vec<(f64, f64)>)>,
}

impl Plot for Growing<'_> {
    fn draw<B: DrawingBackend<ErrorType: 'static>>(&self, root: &DrawingArea<B, Shift>) -> Drawn {
        let all = self.curves.iter().flat_map(|(_, points)| points.iter().copied());
        let Some([counts, costs]) = bounds(all) else { return Ok(()) };
        // The free space above the curves holds the legend.
        let [width, height] = [(counts[0] / 1.5..counts[1] * 1.5), (costs[0] / 1.5..costs[1] * 4.0)];
        let mut chart = ChartBuilder::on(root)
            .caption(self.caption, TITLE)
            .margin(12)
            .x_label_area_size(LABELS)
            .y_label_area_size(LABELS + 24)
            .build_cartesian_2d(width.log_scale(), height.log_scale())?;
        let mesh = &mut chart.configure_mesh();
        mesh.x_label_formatter(&sparse).y_label_formatter(&sparse);
        mesh.x_desc(self.axes[0]).y_desc(self.axes[1]).label_style(FONT).max_light_lines(1).draw()?;
        for (i, (name, points)) in self.curves.iter().enumerate() {
            let color = PALETTE[i];
            chart.draw_series(points.iter().map(|&point| Circle::new(point, 5, color.filled())))?;
            let Some(power) = Power::through(points) else { continue };
            let line = LineSeries::new(counts.map(|x| (x, power.at(x))), color.stroke_width(2));
            let sample = move |(x, y)| PathElement::new([(x, y), (x + 16, y)], color.stroke_width(2));
            chart.draw_series(line)?.label(format!("{name}: exponent {:.2}", power.exponent)).legend(sample);
        }
        legend(&mut chart)
    }
}
