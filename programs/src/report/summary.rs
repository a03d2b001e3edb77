//! Summary of a run: means over its frames, and times.

use crate::report::methods::Group;
use crate::report::record::{Column, Row, Run, Settling};

/// A median, and the quartiles around it.
#[derive(Clone, Copy, Debug)]
pub struct Spread {
    pub low: f64,
    pub median: f64,
    pub high: f64,
}

#[derive(Clone, Debug)]
pub struct Summary {
    pub method: String,
    pub group: Group,
    pub rows: Vec<Row>,
    /// Milliseconds per frame.
    pub ms: Option<Spread>,
    /// Median milliseconds of each pass, in order.
    pub passes: Vec<(String, f64)>,
    pub lag: Vec<Settling>,
}

impl Summary {
    pub fn of(run: &Run, method: &str, group: Group) -> Self {
        let totals = run.times.iter().map(|frame| frame.iter().map(|(_, ms)| ms).sum()).collect();
        Self {
            method: method.into(),
            group,
            rows: run.rows.clone(),
            ms: spread(totals),
            passes: passes(&run.times),
            lag: run.lag.clone(),
        }
    }

    /// Returns the mean of a column over the frames that have it.
    pub fn mean(&self, column: Column) -> Option<f64> {
        let values: Vec<f64> = self.rows.iter().filter_map(column).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    }

    /// Returns the error by which methods are ranked: relative MSE.
    pub fn error(&self) -> Option<f64> {
        self.mean(|row| row.rel_mse)
    }

    /// Returns milliseconds and error, if both are known and logarithmic axes can show them.
    pub fn point(&self) -> Option<(f64, f64)> {
        Some((self.ms?.median, self.error()?)).filter(|&(ms, error)| ms > 0.0 && error > 0.0)
    }
}

/// Returns the median; `None` for no values.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => None,
        n if n % 2 == 1 => Some(values[middle]),
        _ => Some(0.5 * (values[middle - 1] + values[middle])),
    }
}

/// Returns the median and the quartiles by rank.
pub fn spread(mut values: Vec<f64>) -> Option<Spread> {
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values[((values.len() - 1) as f64 * share).round() as usize];
    Some(Spread { median: median(values.clone())?, low: at(0.25), high: at(0.75) })
}

/// Returns the median milliseconds of each pass; dispatches of one pass in a frame are added up.
fn passes(frames: &[Vec<(String, f64)>]) -> Vec<(String, f64)> {
    let mut names: Vec<&String> = Vec::new();
    for (name, _) in frames.iter().flatten() {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let sum = |frame: &Vec<(String, f64)>, name: &String| {
        frame.iter().filter(|(other, _)| other == name).map(|(_, ms)| ms).sum::<f64>()
    };
    let typical = |name: &String| median(frames.iter().map(|frame| sum(frame, name)).collect()).unwrap_or(0.0);
    names.into_iter().map(|name| (name.clone(), typical(name))).collect()
}
