//! Records of measurements, as the files keep them.

use crate::report::keep;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A frame of a sequence with its results for one method. A missing number is `None`.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Row {
    pub sequence: String,
    pub method: String,
    pub frame: u32,
    pub rel_mse: Option<f64>,
    pub rmse: Option<f64>,
    pub psnr: Option<f64>,
    pub ssim: Option<f64>,
    pub flip: Option<f64>,
    pub bias: Option<f64>,
    pub flicker: Option<f64>,
    pub ghost: Option<f64>,
    /// Mean λ over the image.
    pub lambda: Option<f64>,
    /// Mean history length over the image.
    pub history: Option<f64>,
    /// Milliseconds of all passes: the median of the repeats.
    pub ms: Option<f64>,
}

/// Accessor of a number of a row.
pub type Column = fn(&Row) -> Option<f64>;

/// Numbers of a row, by name.
pub const COLUMNS: [(&str, Column); 11] = [
    ("rel_mse", |row| row.rel_mse),
    ("rmse", |row| row.rmse),
    ("psnr", |row| row.psnr),
    ("ssim", |row| row.ssim),
    ("flip", |row| row.flip),
    ("bias", |row| row.bias),
    ("flicker", |row| row.flicker),
    ("ghost", |row| row.ghost),
    ("lambda", |row| row.lambda),
    ("history", |row| row.history),
    ("ms", |row| row.ms),
];

/// Frames until a step of the light has arrived, for sequences with one.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Settling {
    /// Part of the step that may remain.
    pub band: f64,
    /// Frames until half of the pixels have arrived, and until nine of ten have.
    pub median: Option<u32>,
    pub ninth_decile: Option<u32>,
    /// Share of the pixels that arrive at all.
    pub arrived: f64,
}

/// A sequence with its results for one method.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Run {
    /// Hash of everything that decides the run.
    pub key: String,
    pub rows: Vec<Row>,
    pub lag: Vec<Settling>,
    /// Number of repeats for the times.
    pub repeats: u32,
    /// Milliseconds of each pass, in order, in each counted frame of each repeat.
    pub times: Vec<Vec<(String, f64)>>,
}

impl Run {
    /// Loads a kept run, if everything that decides it is the same.
    pub fn load(path: &Path, key: &str) -> Option<Self> {
        keep::load(path).filter(|run: &Self| run.key == key)
    }

    pub fn save(&self, path: &Path) -> Result<(), Box<dyn std::error::Error>> {
        keep::save(self, path)
    }
}

/// Returns the number if it is finite.
pub fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
