//! Plot of the gain from each idea of the default.

use super::{Drawn, FONT, Plot, bars, color, is_variant, span};
use crate::report::methods::DEFAULT;
use crate::report::summary::Summary;
use crate::report::verdict;
use plotters::coord::Shift;
use plotters::prelude::*;

/// Longest bar of errors: its error over the default's.
const MOST: f64 = 3.0;

/// Error of each variant of the default, over the default's.
pub struct Ablation<'a> {
    pub sequence: &'a str,
    pub summaries: &'a [Summary],
}

impl Plot for Ablation<'_> {
    fn draw<B: DrawingBackend<ErrorType: 'static>>(&self, root: &DrawingArea<B, Shift>) -> Drawn {
        let Some(default) = verdict::find(self.summaries, DEFAULT).and_then(Summary::error) else { return Ok(()) };
        let variants = self.summaries.iter().filter(|summary| is_variant(summary) || summary.method == DEFAULT);
        let parts: Vec<_> = variants.filter_map(|s| Some((s.method.as_str(), s.error()? / default, s.group))).collect();
        let names: Vec<_> = parts.iter().map(|(name, ..)| *name).collect();
        // Bars of much worse variants leave the picture.
        let end = parts.iter().map(|(_, part, _)| part.min(MOST)).fold(1.1, f64::max);
        let caption = format!("{}: relative MSE, in parts of that of {DEFAULT}", self.sequence);
        let mut chart = bars(root, &caption, "error / error of the default", 1.1 * end, &names)?;
        for (row, (_, part, group)) in parts.into_iter().enumerate() {
            let [low, high] = span(row, names.len());
            let bar = Rectangle::new([(0.0, low), (part.min(MOST), high)], color(group).filled());
            chart.draw_series([bar])?;
            let (x, y) = chart.backend_coord(&(part.min(MOST), 0.5 * (low + high)));
            root.draw(&Text::new(format!("{part:.3}"), (x + 4, y - 4), FONT))?;
        }
        Ok(chart.draw_series(LineSeries::new([(1.0, 0.0), (1.0, names.len() as f64)], BLACK.mix(0.6))).map(drop)?)
    }
}
