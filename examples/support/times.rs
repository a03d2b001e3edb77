//! Times of passes: how they are taken, and the table of them.

use crate::gpu::Gpu;
use asvgf::wgpu::{DeviceType, Features};
use std::fmt::Write as _;

/// Frames that are not counted: shaders are compiled and caches filled during the first ones.
const WARM_UP: usize = 3;

/// One frame's passes and their milliseconds, in order.
pub type PassTimes = Vec<(&'static str, f64)>;

/// How the times of passes were taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clock {
    /// By the GPU, at the passes' boundaries.
    Timestamps,
    /// By the CPU, each pass submitted and waited for by itself: software adapters run all passes when they are waited for,
    /// and so stamp them wrongly.
    Waiting,
}

impl Clock {
    /// The honest clock for an adapter.
    pub fn of(gpu: &Gpu) -> Self {
        let stamps = gpu.device.features().contains(Features::TIMESTAMP_QUERY);
        if stamps && gpu.adapter.device_type != DeviceType::Cpu { Self::Timestamps } else { Self::Waiting }
    }
}

/// Milliseconds per pass, medians over the frames; and the speed that goes with the `rays` of one frame, where some were traced.
pub fn table(frames: &[PassTimes], rays: Option<f64>, [width, height]: [u32; 2], gpu: &Gpu) -> String {
    let skipped = WARM_UP.min(frames.len().saturating_sub(1));
    let counted = &frames[skipped..];
    let Some(first) = counted.first() else { return String::new() };
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in first {
        if !names.contains(name) {
            names.push(name);
        }
    }
    let sum = |frame: &PassTimes, wanted: &[&str]| {
        frame.iter().filter(|(name, _)| wanted.contains(name)).map(|(_, ms)| ms).sum::<f64>()
    };
    let typical = |wanted: &[&str]| median(counted.iter().map(|frame| sum(frame, wanted)).collect());
    let total = typical(&names);
    let mut out = format!("\n{:<24}{:>10}{:>9}\n", "pass", "ms", "share");
    for name in &names {
        let dispatches = first.iter().filter(|(other, _)| other == name).count();
        let label = if dispatches > 1 { format!("{name} × {dispatches}") } else { (*name).to_owned() };
        let ms = typical(&[name]);
        let _ = writeln!(out, "{label:<24}{ms:>10.3}{:>7.1} %", 100.0 * ms / total.max(1e-9));
    }
    let _ = writeln!(out, "{:<24}{total:>10.3}", "all");
    let clock = match Clock::of(gpu) {
        Clock::Timestamps => "GPU timestamps at the passes' boundaries",
        Clock::Waiting => "each pass submitted and waited for by itself, as this adapter has no honest timestamps",
    };
    let _ = writeln!(out, "Medians of {} frames of {width}×{height} after {skipped} to warm up.", counted.len());
    let _ = writeln!(out, "Measured by {clock}.");
    let traced = typical(&["visibility", "trace"]) * 1e-3;
    if let Some(rays) = rays.filter(|_| traced > 0.0) {
        let (million, speed) = (rays * 1e-6, rays * 1e-6 / traced);
        let _ = writeln!(
            out,
            "{speed:.2} million rays/s in visibility and trace: the last frame's {million:.2} million were counted, shadow rays \
             included."
        );
    }
    let adapter = &gpu.adapter;
    let _ = writeln!(out, "{} ({:?}), {} {}", adapter.name, adapter.backend, adapter.driver, adapter.driver_info);
    out
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => 0.0,
        n if n % 2 == 1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    }
}
