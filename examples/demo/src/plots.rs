//! Curves of the last frames: errors, means, and times of passes.

use crate::means::{Mean, Quantity};
use eframe::egui::{TextStyle, Ui};
use egui_plot::{Bar, BarChart, Legend, Line, Plot, PlotPoints};
use std::collections::VecDeque;

/// Number of frames that are kept.
const KEPT: usize = 240;

/// Number of frames whose passes are drawn, each as a stack of bars.
const STACKS: usize = 60;

/// The passes of one frame in order, with their milliseconds.
pub type PassTimes = Vec<(&'static str, f64)>;

/// Measurements of the last frames.
#[derive(Default)]
pub struct Curves {
    means: VecDeque<Mean>,
    times: VecDeque<PassTimes>,
}

impl Curves {
    /// Adds a mean. It replaces an older mean of the same frame, which had a worse reference.
    pub fn add(&mut self, mean: Mean) {
        self.means.retain(|m| (m.quantity, m.frame) != (mean.quantity, mean.frame));
        self.means.push_back(mean);
        if self.means.len() > 4 * KEPT {
            self.means.pop_front();
        }
    }

    /// Adds the times of a frame.
    pub fn add_times(&mut self, times: PassTimes) {
        self.times.push_back(times);
        if self.times.len() > STACKS {
            self.times.pop_front();
        }
    }

    /// Forgets everything, as for another scene.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// The last mean of a kind.
    pub fn last(&self, quantity: Quantity) -> Option<Mean> {
        self.means.iter().rev().find(|m| m.quantity == quantity).copied()
    }

    fn points(&self, quantity: Quantity, value: impl Fn(f64) -> f64) -> PlotPoints<'static> {
        let of = self.means.iter().filter(|m| m.quantity == quantity);
        of.map(|m| [f64::from(m.frame), value(m.value)]).collect()
    }

    /// The passes in their order, each with its milliseconds in every frame.
    fn stacks(&self) -> Vec<(&'static str, Vec<f64>)> {
        let mut passes: Vec<(&'static str, Vec<f64>)> = Vec::new();
        for name in self.times.iter().flatten().map(|(name, _)| *name) {
            if !passes.iter().any(|(known, _)| *known == name) {
                let sum = |frame: &PassTimes| frame.iter().filter(|(n, _)| *n == name).map(|(_, ms)| ms).sum();
                passes.push((name, self.times.iter().map(sum).collect()));
            }
        }
        passes
    }

    /// Shows the plots side by side.
    pub fn show(&self, ui: &mut Ui) {
        let height = ui.available_height();
        let legend = Legend::default().text_style(TextStyle::Small);
        let plain = |name| Plot::new(name).height(height - 24.0).allow_scroll(false);
        let plot = |name| plain(name).legend(legend.clone());
        // The measured squared error is right on average, but chance may take it below zero where the error is small.
        let root = |x: f64| x.max(0.0).sqrt();
        ui.columns(4, |columns| {
            columns[0].label("error (RMSE) by frame");
            plot("error").include_y(0.0).show(&mut columns[0], |ui| {
                ui.line(Line::new("adaptive α", self.points(Quantity::AdaptiveError, root)));
                ui.line(Line::new("constant α", self.points(Quantity::ConstantError, root)));
            });
            columns[1].label("mean λ");
            plain("lambda").include_y(0.0).show(&mut columns[1], |ui| {
                ui.line(Line::new("λ", self.points(Quantity::Lambda, |x| x)));
            });
            columns[2].label("mean history length, frames");
            plain("length").include_y(0.0).show(&mut columns[2], |ui| {
                ui.line(Line::new("history", self.points(Quantity::HistoryLength, |x| x)));
            });
            columns[3].label("milliseconds by pass");
            plot("times").include_y(0.0).show(&mut columns[3], |ui| {
                let mut below: Vec<BarChart> = Vec::new();
                for (name, times) in self.stacks() {
                    let bars = times.iter().enumerate().map(|(i, &ms)| Bar::new(i as f64, ms).width(1.0)).collect();
                    let chart = BarChart::new(name, bars).stack_on(&below.iter().collect::<Vec<_>>());
                    below.push(chart);
                }
                below.into_iter().for_each(|chart| ui.bar_chart(chart));
            });
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_better_measure_of_a_frame_replaces_the_old_one() {
        let mut curves = Curves::default();
        for value in [3.0, 2.0] {
            curves.add(Mean { quantity: Quantity::AdaptiveError, frame: 7, value });
        }
        curves.add(Mean { quantity: Quantity::Lambda, frame: 7, value: 0.5 });
        assert_eq!(curves.means.len(), 2);
        assert_eq!(curves.last(Quantity::AdaptiveError).unwrap().value, 2.0);
    }

    #[test]
    fn iterations_of_a_pass_are_one_band_of_the_stack() {
        let mut curves = Curves::default();
        curves.add_times(vec![("trace", 5.0), ("atrous", 1.0), ("atrous", 2.0)]);
        curves.add_times(vec![("trace", 4.0), ("atrous", 3.0)]);
        assert_eq!(curves.stacks(), [("trace", vec![5.0, 4.0]), ("atrous", vec![3.0, 3.0])]);
    }
}
