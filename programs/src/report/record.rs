//! What was measured, as it is kept in files.

use crate::report::keep;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A frame of a sequence that went through a method. What does not exist is `None`.
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

/// A number of a row.
pub type Column = fn(&Row) -> Option<f64>;

/// The numbers of a row, by name.
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

/// Frames until a step of the light has arrived, where a sequence has one.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Settling {
    /// Part of the step that may be left.
    pub band: f64,
    /// Within so many frames half of the pixels arrived, and nine of ten.
    pub median: Option<u32>,
    pub ninth_decile: Option<u32>,
    /// Share of the pixels that arrived at all.
    pub arrived: f64,
}

/// A sequence that went through a method.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Run {
    /// Hash of everything that decides it.
    pub key: String,
    pub rows: Vec<Row>,
    pub lag: Vec<Settling>,
    /// How often times were taken.
    pub repeats: u32,
    /// Milliseconds of each pass, in order, in each counted frame of each repeat.
    pub times: Vec<Vec<(String, f64)>>,
}

impl Run {
    /// One that was kept, if everything that decides it is the same.
    pub fn load(path: &Path, key: &str) -> Option<Self> {
        keep::load(path).filter(|run: &Self| run.key == key)
    }

    pub fn save(&self, path: &Path) -> Result<(), Box<dyn std::error::Error>> {
        keep::save(self, path)
    }
}

/// A number that exists.
pub fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
