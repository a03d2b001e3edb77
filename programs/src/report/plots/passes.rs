//! Plot of the passes' shares of the time.

use super::{Drawn, PALETTE, Plot, bars, legend, span};
use crate::report::methods::{CONTROL, Group, ONE_PATH};
use crate::report::summary::Summary;
use plotters::coord::Shift;
use plotters::prelude::*;

/// Milliseconds of each pass, one bar for each method.
pub struct Passes<'a> {
    pub sequence: &'a str,
    pub summaries: &'a [Summary],
}

impl Plot for Passes<'_> {
    fn draw<B: DrawingBackend<ErrorType: 'static>>(&self, root: &DrawingArea<B, Shift>) -> Drawn {
        // Methods with many paths are excluded, because their bars would hide all others.
        let shown =
            |s: &&Summary| (!matches!(s.group, Group::Tracing(_)) || s.method == ONE_PATH) && !s.passes.is_empty();
        let methods: Vec<_> = self.summaries.iter().filter(shown).filter(|s| s.method != CONTROL).collect();
        let total = |s: &Summary| s.passes.iter().map(|(_, ms)| ms).sum::<f64>();
        let longest = methods.iter().map(|s| total(s)).fold(0.0, f64::max);
        if longest <= 0.0 {
            return Ok(());
        }
        let mut passes: Vec<&str> = Vec::new();
        for (pass, _) in methods.iter().flat_map(|method| &method.passes) {
            if !passes.contains(&pass.as_str()) {
                passes.push(pass);
            }
        }
        let caption = format!("{}: milliseconds per frame, pass by pass", self.sequence);
        let names: Vec<_> = methods.iter().map(|summary| summary.method.as_str()).collect();
        let mut chart = bars(root, &caption, "milliseconds per frame", 1.4 * longest, &names)?;
        for (i, pass) in passes.into_iter().enumerate() {
            let color = PALETTE[i % PALETTE.len()].filled();
            let sample = move |(x, y)| Rectangle::new([(x, y - 5), (x + 10, y + 5)], color);
            let parts = methods.iter().enumerate().filter_map(|(row, method)| {
                let at = method.passes.iter().position(|(other, _)| other == pass)?;
                let left = method.passes[..at].iter().map(|(_, ms)| ms).sum::<f64>();
                let [low, high] = span(row, names.len());
                Some(Rectangle::new([(left, low), (left + method.passes[at].1, high)], color))
            });
            chart.draw_series(parts)?.label(pass).legend(sample);
        }
        legend(&mut chart)
    }
}
